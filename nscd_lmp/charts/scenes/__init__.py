# SPDX-License-Identifier: GPL-2.0-or-later
"""The scenes of the charts, a module each.

A scene has ORDER (its place in lists), TITLE, ERRORS (result column -> label of its axis), NOTES (what the errors mean
and what is compared over which time), ``cases(size)`` and ``run(folder, **case)``; REFERENCES are published points,
FLOOR the error below which all is rounding. ``run`` returns the columns of ERRORS, ``solve_seconds`` and
``wall_seconds`` (processor and wall time of the timed ``run`` commands) and ``simulated`` (s). Nothing else knows of a
scene: add a file, and it is a chart.
"""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType


def names() -> list[str]:
    """Return the names of the scenes, by alphabet."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_"))


def find_scenes() -> dict[str, ModuleType]:
    """Return the scenes by name, in their order."""
    scenes = {name: importlib.import_module(f"{__name__}.{name}") for name in names()}
    return dict(sorted(scenes.items(), key=lambda item: item[1].ORDER))
