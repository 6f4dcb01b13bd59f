# SPDX-License-Identifier: GPL-2.0-or-later
"""How much a chart runs."""

from enum import Enum


class Size(Enum):
    """QUICK: few small cases, seconds in all, to see that everything works. FULL: what is published."""

    QUICK = "quick"
    FULL = "full"
