# SPDX-License-Identifier: GPL-2.0-or-later
"""The version of this package; pyproject.toml has the same."""

__version__ = "0.1.0"
