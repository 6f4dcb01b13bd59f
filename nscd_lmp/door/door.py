# SPDX-License-Identifier: GPL-2.0-or-later
"""The step on one LAMMPS instance: its fix, and the watch over the commands that run it."""

import contextlib
import ctypes
import re
import warnings
from collections.abc import Callable
from dataclasses import astuple
from typing import Any

from nscd_lmp import _core
from nscd_lmp.door import ghost_homes
from nscd_lmp.door.attached import Attached
from nscd_lmp.door.command_lines import split_commands
from nscd_lmp.door.inspection import MOVERS, FixInfo, Inspection
from nscd_lmp.door.ranks import Ranks
from nscd_lmp.door.step_fix import FIX_ID, address, definition

ADDRESSES = (
    "lammps_extract_atom",
    "lammps_extract_global",
    "lammps_extract_setting",
    "lammps_extract_box",
    "lammps_get_thermo",
    "lammps_get_natoms",
    "lammps_find_pair_neighlist",
    "lammps_neighlist_num_elements",
    "lammps_neighlist_element_neighbors",
    "lammps_force_timeout",
    "lammps_id_count",
    "lammps_id_name",
)
# Commands that run steps, the first directly, the others by what they contain; and those that change the list.
RUNNING = ("run", "include", "jump", "if", "next")
LIST_COMMANDS = ("pair_", "neigh", "comm_modify", "read_", "clear", "newton")
OPTIONAL_ADDRESSES = ("lammps_extract_pair",)  # that older builds lack
COMMAND_METHODS = ("command", "commands_list", "commands_string", "file")


class Door:
    """The step's fix on one LAMMPS instance, and the watch over the commands that run it."""

    def __init__(self, lmp: Any, group: str, keywords: list[str], solver: Any, door: str) -> None:
        self.define = definition(lmp, door)
        ranks = Ranks(lmp.get_mpi_comm()) if lmp.extract_setting("world_size") > 1 else None
        self.inspection = Inspection(lmp, ranks)
        self.lmp = lmp
        self.group = group
        self.remeasure = False
        self.holders_told_of: set[str] = set()
        if any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            raise _core.NscdError(
                "another attach() is at work on this LAMMPS object: detach() it first, and attach to the union of"
                " the groups"
            )
        self.inspection.require_spheres()
        listed = self.inspection.listed_pairs()
        there = [*ADDRESSES, *(name for name in OPTIONAL_ADDRESSES if hasattr(lmp.lib, name))]
        addresses = {name: ctypes.cast(getattr(lmp.lib, name), ctypes.c_void_p).value for name in there}
        addresses["handle"] = address(lmp.lmp)
        group_bit = self.inspection.group_bit(group)
        find_homes = ghost_homes.finder(lmp, ranks) if ranks else None
        self.fix = _core.ExternalFix(addresses, FIX_ID, group_bit, keywords, solver, ranks, find_homes)
        self.fix.set_listed_pairs(*astuple(listed))
        self.fix.set_image_cutoff(self.inspection.communication_cutoff())
        for doubt in [*filter(None, [self.fix.crowding]), *self.fix.doubts()]:
            warnings.warn(doubt, stacklevel=3)
        self.methods = {name: getattr(lmp, name) for name in COMMAND_METHODS}
        self.add_fix()
        for name in COMMAND_METHODS:
            setattr(lmp, name, self.watched(name))
        self.attached = Attached(self.fix, self.detach)
        lmp._nscd = self

    def add_fix(self) -> None:
        """Define the fix that calls the step."""
        # A dynamic group is refused by fix external; the step itself knows whom it moves.
        group = "all" if self.inspection.is_dynamic(self.group) else self.group
        self.define(self.lmp, self.methods["command"], group, self.fix)

    def watched(self, name: str) -> Callable[..., Any]:
        """Return the LAMMPS method, made to look before a run and to raise what stopped it."""
        one = self.watched_command
        watched: dict[str, Callable[[Any], Any]] = {
            "command": one,
            "commands_list": lambda commands: [one(command) for command in commands] and None,
            "commands_string": lambda text: [one(command) for command in split_commands(text)] and None,
            "file": self.watched_file,
        }
        return watched[name]

    def watched_command(self, command: str) -> Any:
        """Give LAMMPS one command."""
        word = (command.split() or [""])[0]
        self.refuse_rerun(command)
        if word in RUNNING:
            self.before_run(command)
        try:
            return self.methods["command"](command)
        finally:
            self.remeasure = self.remeasure or word.startswith(LIST_COMMANDS) or word in RUNNING[1:]
            self.after_run()

    def refuse_rerun(self, commands: str) -> None:
        """Raise for a ``rerun`` among the commands: every frame that it reads would be taken for a step, and moved."""
        named = re.search(r"^[^#]*\brerun\b", commands, re.MULTILINE)
        if named and any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            raise _core.NscdError("rerun reads frames and takes no steps, so there are no contacts: detach() before it")

    def watched_file(self, path: str) -> Any:
        """Give LAMMPS a script, whose commands cannot be looked at; the step refuses a fix that comes after it."""
        with contextlib.suppress(OSError), open(path, encoding="utf-8", errors="replace") as file:
            self.refuse_rerun(file.read())
        self.before_run("file")
        try:
            return self.methods["file"](path)
        finally:
            self.remeasure = True
            self.after_run()

    def before_run(self, command: str) -> None:
        """Keep our fix the last one, so that it sees all forces; refuse integrators; look at the list again."""
        fixes = self.inspection.fixes()
        if not any(fix.id == FIX_ID for fix in fixes):
            return
        self.inspection.refuse_integrators(fixes, FIX_ID, self.group)
        self.inspection.refuse_bonding(fixes)
        self.tell_of_force_holders(fixes)
        movers = any(MOVERS.match(fix.style) for fix in fixes)
        self.fix.set_fixes(self.inspection.held_groups(fixes), movers)
        if fixes[-1].id != FIX_ID:
            if re.search(r"\bpre\s+(no|off|false)\b", command):
                raise _core.NscdError(
                    f"fix {fixes[-1].id} was defined since the last run: `run` needs its setup, leave out `pre no`"
                )
            self.methods["command"](f"unfix {FIX_ID}")
            self.add_fix()
        if self.remeasure:
            self.fix.set_listed_pairs(*astuple(self.inspection.listed_pairs()))
            self.fix.set_image_cutoff(self.inspection.communication_cutoff())
            self.remeasure = False

    def tell_of_force_holders(self, fixes: list[FixInfo]) -> None:
        """Warn, once each, of fixes that hold grains against forces alone."""
        for fix in self.inspection.force_holders(fixes, self.group):
            if fix.id in self.holders_told_of:
                continue
            self.holders_told_of.add(fix.id)
            warnings.warn(
                f"fix {fix.id} (style {fix.style}) sets forces, and impulses of contacts, which are none, move its"
                " grains all the same: to hold grains, leave them out of the group of attach(), or use fix freeze; to"
                " keep them in a plane, use dimension 2",
                stacklevel=4,
            )

    def after_run(self) -> None:
        """Raise what stopped the run; warn of what its steps may be taken for and are not."""
        remarks = self.fix.take_remarks()
        if self.fix.failed:
            self.methods["command"]("timer timeout off")
            self.fix.raise_failure()
        for remark in remarks:
            warnings.warn(remark, stacklevel=4)

    def detach(self) -> None:
        """Undo what attaching did."""
        for name in COMMAND_METHODS:
            self.lmp.__dict__.pop(name, None)
        if any(fix.id == FIX_ID for fix in self.inspection.fixes()):
            self.lmp.command(f"unfix {FIX_ID}")
        self.lmp.__dict__.pop("_nscd", None)
