# SPDX-License-Identifier: GPL-2.0-or-later
"""One map, one module, found by itself: what it has to define is :class:`nscd_lmp.atlas.atlas.Map`."""
