# SPDX-License-Identifier: GPL-2.0-or-later
"""What the benchmarks share with the scripts of analysis/, which lie beside each other and are no package."""

import sys

from record import ROOT

sys.path.append(str(ROOT / "analysis"))

from chart import STYLE, new_figure, save_figure
from contact_pairs import find_grain_contacts
from overlap import compute_overlaps

__all__ = ["STYLE", "compute_overlaps", "find_grain_contacts", "new_figure", "save_figure"]
