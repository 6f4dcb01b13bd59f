# SPDX-License-Identifier: GPL-2.0-or-later
"""Work-precision charts: seconds per simulated second against physical errors."""
