# SPDX-License-Identifier: GPL-2.0-or-later
"""Where each method fails: maps over the two parameters that break it."""

from nscd_lmp.atlas.atlas import find_maps, make
from nscd_lmp.atlas.map import Map

__all__ = ["Map", "find_maps", "make"]
