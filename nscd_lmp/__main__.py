# SPDX-License-Identifier: GPL-2.0-or-later
"""The program ``nscd-lmp`` by the name of the package: ``python -m nscd_lmp``."""

import sys

from nscd_lmp.cli import main

if __name__ == "__main__":
    sys.exit(main())
