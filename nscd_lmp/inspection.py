"""What LAMMPS does not tell by its C interface but by its ``info`` command."""

import os
import re
import tempfile
from dataclasses import dataclass
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.ranks import Ranks

# Styles that advance positions; `nve/noforce` and the like included.
INTEGRATORS = re.compile(r"^(nve|nvt|nph|npt|nvk|rigid|move|brownian|bd|poems|nscd|npu|qbmsst|gjf|wall/move)")


@dataclass(frozen=True)
class FixInfo:
    """One fix: its ID, style and group."""

    id: str
    style: str
    group: str


class Inspection:
    """Questions to a live LAMMPS object, on several ranks asked by all of them together."""

    def __init__(self, lmp: Any, ranks: Ranks | None = None) -> None:
        self._ranks = ranks
        self._command = lmp.command
        self._setting = lmp.extract_setting
        self._atoms = lmp.extract_atom

    def info(self, *topics: str) -> str:
        """Return what ``info`` prints on the topics."""
        handle, path = tempfile.mkstemp(prefix="nscd_info")
        os.close(handle)
        try:
            self._command(f"info {' '.join(topics)} out overwrite {path}")
            with open(path, encoding="utf-8") as file:
                text = file.read()
            # Rank 0 alone writes.
            return self._ranks.comm.bcast(text) if self._ranks else text
        finally:
            os.unlink(path)

    def fixes(self) -> list[FixInfo]:
        """Return the fixes in the order LAMMPS calls them."""
        found = re.findall(r"Fix\[ *\d+\]: *(\S+), *style = (\S+), *group = (\S+)", self.info("fixes"))
        return [FixInfo(*row) for row in found]

    def pair_style(self) -> str:
        """Return the name of the pair style, whose neighbor list gives the contact pairs."""
        found = re.search(r"Atoms +=.*style = (\S+)", self.info("system"))
        if not found or found[1] == "none":
            raise NscdError(
                "no pair style is defined, so there is no neighbor list: use pair_style zero CUTOFF with a"
                " cutoff of the largest diameter plus what two grains can move in a step, and pair_coeff * *"
            )
        return found[1]

    def group_bit(self, group: str) -> int:
        """Return the group's bit in the atoms' mask."""
        listed = re.findall(r"Group\[ *(\d+)\]: *(\S+)", self.info("groups"))
        for index, name in listed:
            if name == group:
                return 1 << int(index)
        raise NscdError(f"unknown group {group!r}: choose one of {', '.join(name for _, name in listed)}")

    def neighbor_cutoff(self) -> float:
        """Return pair cutoff plus skin, the distance within which pairs are listed.

        LAMMPS knows it after an initialisation, which writing a restart brings about without touching atoms,
        and prints it only as a lower bound of the communication cutoff; that is set to 0 meanwhile.
        """
        self._command(f"write_restart {os.devnull}")
        shown = self.communication_cutoff()
        self._command("comm_modify cutoff 0.0")
        cutoff = self.communication_cutoff()
        if shown > cutoff:
            self._command(f"comm_modify cutoff {shown!r}")
        return cutoff

    def communication_cutoff(self) -> float:
        """Return the distance from a rank's part of the box up to which there are images."""
        found = re.search(r"Communication cutoff = (\S+)", self.info("communication"))
        if not found:
            raise NscdError("LAMMPS did not tell its communication cutoff")
        return float(found[1])

    def share_atoms(self, first: str, second: str) -> bool:
        """Return whether an atom is in both groups."""
        both = self.group_bit(first) | self.group_bit(second)
        here = any(mask & both == both for mask in self._atoms("mask")[: self._setting("nlocal")])
        return any(self._ranks.comm.allgather(here)) if self._ranks else here

    def refuse_integrators(self, fixes: list[FixInfo], own_id: str, group: str) -> None:
        """Raise if another fix moves atoms of the group."""
        for fix in fixes:
            moves = fix.id != own_id and INTEGRATORS.match(fix.style)
            if moves and self.share_atoms(fix.group, group):
                raise NscdError(
                    f"atoms of group {group} are moved by fix {fix.id} (style {fix.style}) too:"
                    " remove that fix or give the two disjoint groups"
                )
