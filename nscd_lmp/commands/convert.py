# SPDX-License-Identifier: GPL-2.0-or-later
"""Turn a script with LAMMPS' granular springs into one with hard contacts.

Lists the lines that change: pair_style gran/... or granular, fix nve/sphere,
fix wall/gran and the time step. Restitution follows from stiffness and damping.
What has no counterpart yet is listed with its line and the reason. The script
stays as it is; --write writes the new one.
"""

import argparse
import re
from pathlib import Path

from nscd_lmp.commands._script_run import ScriptError
from nscd_lmp.conversion.convert import Known, convert


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("script", metavar="SCRIPT", type=Path, help="LAMMPS input script")
    parser.add_argument("--write", "-o", type=Path, metavar="FILE", help="write the whole new script")
    parser.add_argument(
        "--variable",
        "-var",
        nargs=2,
        action="append",
        default=[],
        metavar=("NAME", "VALUE"),
        help="value of a variable that is not in the script, or another one; repeatable",
    )
    parser.add_argument("--diameter", type=float, metavar="D", help="of the mean grain, if the script does not say it")
    parser.add_argument("--density", type=float, metavar="RHO", help="of spheres, if the script does not say it")
    parser.add_argument("--mass", type=float, metavar="M", help="of the mean grain, in place of its density")
    parser.add_argument(
        "--speed",
        type=float,
        metavar="V",
        help="of impacts: bounds the time step, and restitution of hertz depends on it [of a fall by half a diameter]",
    )
    parser.add_argument("--timestep", type=float, metavar="DT", help="the new time step [a proposal]")


def main(arguments: argparse.Namespace) -> None:
    """Convert the script, and print what changes."""
    script, target = arguments.script, arguments.write
    if not script.is_file():
        raise ScriptError(f"there is no script '{script}' in {Path.cwd()}: give the path of an existing file")
    if target and target.resolve() == script.resolve():
        raise ScriptError(f"--write {target} would overwrite the script: give another name")
    for name in ("diameter", "density", "mass", "speed", "timestep"):
        value = getattr(arguments, name)
        if value is not None and not value > 0:
            raise ScriptError(f"--{name} {value:g} should be above 0")
    for name, _ in arguments.variable:
        if not re.fullmatch(r"\w+", name):
            raise ScriptError(f"--variable {name}: a name has letters, digits and underscores alone")
    known = Known(arguments.diameter, arguments.density, arguments.mass, arguments.speed, arguments.timestep)
    conversion = convert(script, dict(arguments.variable), known)
    print(conversion.listing)
    if target:
        target.write_text(conversion.text, encoding="utf-8")
        print(f"\n{target}: the new script")
