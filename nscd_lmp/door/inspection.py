# SPDX-License-Identifier: GPL-2.0-or-later
"""What LAMMPS does not tell by its C interface but by its ``info`` command."""

import os
import re
import tempfile
from dataclasses import dataclass
from typing import Any

from nscd_lmp._core import NscdError
from nscd_lmp.door.ranks import Ranks

# Styles that advance positions, to be named before the run; whatever else does is found by the step, which looks at
# where grains are.
INTEGRATORS = re.compile(r"^(nve|nvt|nph|npt|nvk|rigid|move|brownian|bd|poems|nscd|npu|qbmsst|gjf|wall/move)")

# Styles that move grains without integrating them; those that change the box are found by that.
MOVERS = re.compile(r"^(recenter|wall/reflect|wall/diffusive|append/atoms|widom|gcmc|atom/swap|mol/swap)")
# Styles that set a force or a part of it: contacts that are forces are held and guided by them, impulses are not.
FORCE_HOLDERS = re.compile(r"^(setforce|lineforce|planeforce|aveforce)")
BONDING = re.compile(r"^bond/(create|react)")
SHAPES = ("body", "line", "tri", "ellipsoid")


@dataclass(frozen=True)
class ListedPairs:
    """Which neighbor list has the contact pairs, and how far it reaches; the arguments of ``set_listed_pairs``.

    `cutoff` is the largest pair cutoff plus skin (m), `shorter` by how much those of pairs of types are shorter, row by
    row, or empty. Pair style nscd tells all but its name by itself, as each run begins.
    """

    pair_style: str
    cutoff: float
    shorter: list[float]
    cutoffs_known: bool


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
        """Return what ``info`` prints on the topics; raise if LAMMPS could not write all of it."""
        text = self.written(f"info {' '.join(topics)} out overwrite {{}}")
        rule = "Info-Info-Info"
        if not text.strip().startswith(rule) or text.strip().count(f"\n{rule}") != 1:
            raise NscdError(
                f"LAMMPS could not write what it is asked for to the folder {tempfile.gettempdir()}: is it full? Make"
                " room, or set TMPDIR to another folder"
            )
        return text

    def written(self, command: str) -> str:
        """Return what LAMMPS writes by a command to the file whose name takes the place of ``{}``."""
        handle, path = tempfile.mkstemp(prefix="nscd_info")
        os.close(handle)
        try:
            self._command(command.format(path))
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

    def require_spheres(self) -> None:
        """Raise if atoms have a shape that is not a sphere's."""
        found = re.search(r"Atom style +=(.*)", self.info("system"))
        for shape in set(found[1].split() if found else ()) & set(SHAPES):
            raise NscdError(
                f"atom_style {shape} is not of spheres, and grains would be taken for some: use atom_style sphere"
            )

    def listed_pairs(self) -> ListedPairs:
        """Return which neighbor list gives the contact pairs, and how far it reaches."""
        style, sub_styles = self._pair_styles()
        if sub_styles.count("nscd") > 1:
            raise NscdError(
                "a hybrid pair style has nscd more than once, and contacts have one material: use it once, for all"
                " types"
            )
        if "nscd" in (style, *sub_styles):
            return ListedPairs("nscd", 0.0, [], True)
        # In hybrid styles `zero`, which has one cutoff for all, is there for the contacts.
        listed = style if not sub_styles else "zero" if "zero" in sub_styles else sub_styles[0]
        types = self._setting("ntypes")
        # Granular styles list pairs by the grains' own radii.
        known = types == 1 and not listed.startswith("gran")
        cutoff = self.neighbor_cutoff()
        shorter = self._shorter(types) if style == "zero" and types > 1 else []
        return ListedPairs(listed, cutoff, shorter, known or bool(shorter))

    def _shorter(self, types: int) -> list[float]:
        """Return by how much the cutoffs of ``pair_style zero`` are shorter than the largest, (types x types).

        Empty for a LAMMPS that does not tell.
        """
        rows = re.findall(r"pair_coeff (\d+) (\d+) (\S+)", self.written("write_coeff {}"))
        cutoffs = {(int(a), int(b)): float(cutoff) for a, b, cutoff in rows}
        if len(cutoffs) != types * (types + 1) // 2:
            return []
        largest = max(cutoffs.values())
        pairs = [(min(a, b) + 1, max(a, b) + 1) for a in range(types) for b in range(types)]
        # They are written with six digits.
        return [0.0 if cutoffs[pair] == largest else largest * (1 + 1e-5) - cutoffs[pair] for pair in pairs]

    def _pair_styles(self) -> tuple[str, list[str]]:
        """Return the pair style and, of a hybrid one, its sub-styles."""
        text = self.info("system")
        found = re.search(r"Atoms +=.*style = (\S+)", text)
        if not found or found[1] == "none":
            raise NscdError(
                "no pair style is defined, so there is no neighbor list: use pair_style nscd, in other builds of LAMMPS"
                " pair_style zero CUTOFF with a cutoff of the largest diameter plus what two grains can move in a step,"
                " and pair_coeff * *"
            )
        sub_styles = re.search(r"Hybrid sub-styles:(.*)", text)
        return found[1], sub_styles[1].split() if sub_styles else []

    def group_bit(self, group: str) -> int:
        """Return the group's bit in the atoms' mask."""
        listed = re.findall(r"Group\[ *(\d+)\]: *(\S+)", self.info("groups"))
        for index, name in listed:
            if name == group:
                return 1 << int(index)
        raise NscdError(f"unknown group {group!r}: choose one of {', '.join(name for _, name in listed)}")

    def is_dynamic(self, group: str) -> bool:
        """Return whether atoms may come into the group and leave it during a run."""
        return bool(re.search(rf"Group\[ *\d+\]: *{re.escape(group)} *\(dynamic\)", self.info("groups")))

    def neighbor_cutoff(self) -> float:
        """Return pair cutoff plus skin, the distance within which pairs are listed.

        LAMMPS knows it after an initialisation, which writing a restart brings about without touching atoms,
        and prints it only as a lower bound of the communication cutoff; that is set to 0 meanwhile.
        """
        self._command(f"write_restart {os.devnull}")
        shown = self._communication_cutoffs()
        multi = "" not in shown
        self._command("comm_modify cutoff/multi * 0.0" if multi else "comm_modify cutoff 0.0")
        cutoffs = self._communication_cutoffs()
        for collection, cutoff in shown.items():
            if cutoff > cutoffs[collection]:
                self._command(f"comm_modify cutoff{'/multi' * multi} {collection} {cutoff * (1 + 1e-7 * multi)!r}")
        # Those of collections are written with eight digits.
        return max(cutoffs.values()) * (1 - 1e-7 * multi)

    def communication_cutoff(self) -> float:
        """Return the distance from a rank's part of the box up to which it has images; 0 if grains differ in it."""
        return self._communication_cutoffs().get("", 0.0)

    def _communication_cutoffs(self) -> dict[str, float]:
        """Return the communication cutoff, or those of the collections of ``comm_modify mode multi`` by number."""
        found = re.findall(r"Communication cutoff(?: for collection (\d+))? = (\S+)", self.info("communication"))
        if not found:
            raise NscdError("LAMMPS did not tell its communication cutoff: use comm_modify mode single")
        return {collection: float(cutoff) for collection, cutoff in found}

    def share_atoms(self, first: str, second: str, held: int = 0) -> bool:
        """Return whether an atom is in both groups and in none of those of the bits `held`."""
        both = self.group_bit(first) | self.group_bit(second)
        masks = self._atoms("mask")[: self._setting("nlocal")]
        here = any(mask & both == both and not mask & held for mask in masks)
        return any(self._ranks.comm.allgather(here)) if self._ranks else here

    def held_groups(self, fixes: list[FixInfo]) -> int:
        """Return the bits of the groups that ``fix freeze`` holds."""
        bits = 0
        for fix in fixes:
            bits |= self.group_bit(fix.group) if fix.style == "freeze" else 0
        return bits

    def refuse_bonding(self, fixes: list[FixInfo]) -> None:
        """Raise if a fix makes bonds whose pairs LAMMPS would leave out of the neighbor list."""
        bonding = [fix for fix in fixes if BONDING.match(fix.style)]
        factors = re.search(r"Special bond factors lj = +(\S+)", self.info("system")) if bonding else None
        if factors and float(factors[1]) == 0:
            raise NscdError(
                f"fix {bonding[0].id} (style {bonding[0].style}) makes bonds, and special_bonds leaves bonded pairs out"
                " of the neighbor list, so that they would pass through each other: use `special_bonds lj 1 1 1`"
            )

    def refuse_integrators(self, fixes: list[FixInfo], own_id: str, group: str) -> None:
        """Raise if another fix moves atoms of the group."""
        for fix in fixes:
            moves = fix.id != own_id and INTEGRATORS.match(fix.style)
            if moves and self.share_atoms(fix.group, group):
                raise NscdError(
                    f"atoms of group {group} are moved by fix {fix.id} (style {fix.style}) too:"
                    " remove that fix or give the two disjoint groups"
                )

    def force_holders(self, fixes: list[FixInfo], group: str) -> list[FixInfo]:
        """Return the fixes that set forces of grains of the group that move."""
        found = [fix for fix in fixes if FORCE_HOLDERS.match(fix.style)]
        held = self.held_groups(fixes) if found else 0
        return [fix for fix in found if self.share_atoms(fix.group, group, held)]
