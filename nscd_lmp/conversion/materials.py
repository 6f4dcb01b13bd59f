# SPDX-License-Identifier: GPL-2.0-or-later
"""The words `friction MU restitution E` that stand for a contact model, and where the numbers are from."""

from __future__ import annotations

from dataclasses import dataclass, field

from nscd_lmp.conversion.contact_model import ContactModel
from nscd_lmp.conversion.conversion import Conversion
from nscd_lmp.conversion.grains import Grains
from nscd_lmp.conversion.restitution import restitution
from nscd_lmp.conversion.script import Command

SMALL = 0.2  # restitution that is likely meant to be none
STICK = 1e4  # the largest coefficient that LAMMPS takes
PLAIN_UNITS = ("lj", "si", "cgs", "micro", "nano")  # where force is mass times acceleration


@dataclass
class Materials:
    """Makes the words of materials.

    Attributes
    ----------
    found : list of float
        Restitutions of pairs and walls so far.
    friction : bool
        Whether a contact has any.
    """

    grains: Grains
    conversion: Conversion
    units: str = "lj"
    found: list[float] = field(default_factory=list)
    friction: bool = False

    def words(self, command: Command, model: ContactModel, wall: bool) -> list[str]:
        """Return the words for a model of a pair or a wall, and note what there is to say."""
        say = self.conversion
        for text in model.left_out:
            say.leave_out(command, text)
        for text in model.remarks:
            say.remark(command, text)
        sticks = (model.friction.number or 0) >= STICK
        words = ["friction", "stick" if sticks else model.friction.raw]
        if model.friction.number != 0:
            self.friction = True
            if model.sticks:
                say.remark(
                    None, "tangential springs turn some slip back in a bounce; e_t does that here, and is left out"
                )
        if model.spring is None:
            return words
        if self.units not in PLAIN_UNITS and model.spring.needs_mass:
            say.leave_out(command, f"restitution, which is not computed in units {self.units}: give it by hand")
            return words
        value = self._restitution(command, model, wall)
        return [*words, "restitution", f"{value:.3g}" if value >= 0.0005 else "0"]

    def _restitution(self, command: Command, model: ContactModel, wall: bool) -> float:
        spring, share = model.spring, 1.0 if wall else 0.5
        assert spring is not None
        if not spring.needs_mass:
            value = restitution(spring)
            text = f"restitution {value:.3g}: damping {spring.damping} {spring.number:g}"
        else:
            mass, radius = share * self.grains.mass, share * self.grains.diameter / 2
            speed = self.grains.impact_speed if spring.needs_speed else 1.0
            value = restitution(spring, mass, radius, speed)
            text = (
                f"restitution {value:.3g}: {spring.normal} with k {spring.stiffness:g}, damping {spring.damping}"
                f" {spring.number:g} and effective mass {mass:.3g}, {'at a wall' if wall else 'half of the mean grain'}"
            )
            if spring.needs_speed:
                slow, fast = (restitution(spring, mass, radius, times * speed) for times in (0.1, 10))
                text += (
                    f", impacts of {speed:.3g}: it depends on the speed, {slow:.3g} at a tenth of it, {fast:.3g} at ten"
                    " times (--speed)"
                )
            else:
                text += self._spread(model, share)
        if spring.limited:
            text += "; with limit_damping contacts end when their force does"
        if 0.0005 <= value <= SMALL:
            text += "; if no bounce was meant take 0: hard contacts have it, and are faster with it"
        self.conversion.remark(command, text)
        self.found.append(value)
        return value

    def _spread(self, model: ContactModel, share: float) -> str:
        """Return what the smallest and the largest grain have, if they differ."""
        sizes = self.grains.diameters
        assert model.spring is not None
        if not sizes or min(sizes) == max(sizes):
            return ""
        mass, mean = self.grains.mass, self.grains.diameter
        power = 2 if self.grains.planar else 3
        ends = [restitution(model.spring, share * mass * (size / mean) ** power) for size in (min(sizes), max(sizes))]
        return f" (two of the smallest {ends[0]:.3g}, of the largest {ends[1]:.3g})"
