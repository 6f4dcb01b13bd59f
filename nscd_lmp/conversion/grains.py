# SPDX-License-Identifier: GPL-2.0-or-later
"""What a script says of its grains: sizes, masses, gravity."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

from nscd_lmp._core import NscdError
from nscd_lmp.conversion.script import Command
from nscd_lmp.conversion.variables import Variables


@dataclass
class Grains:
    """The grains of a script, as far as they are known.

    Attributes
    ----------
    diameters, densities : list of float
        All that the script names; kg/m^3 of spheres.
    planar : bool
        Whether densities are those of discs (``density/disc``), kg/m^2.
    gravity : float, optional
        Its acceleration, m/s^2.
    speed : float, optional
        Of impacts, m/s, where the user gives one.
    elsewhere : bool
        Whether a data file, restart file or included file may say more.
    """

    diameters: list[float] = field(default_factory=list)
    densities: list[float] = field(default_factory=list)
    masses: list[float] = field(default_factory=list)
    planar: bool = False
    gravity: float | None = None
    speed: float | None = None
    elsewhere: bool = False
    unknown: list[str] = field(default_factory=list)

    def read(self, command: Command, variables: Variables) -> None:
        """Take in what a command says."""
        words = command.words
        if words[0] in ("read_data", "read_restart", "include", "jump"):
            self.elsewhere = True
        elif words[0] == "set":
            self._read_set(words[3:], variables)
        elif words[0] == "fix" and words[3:4] == ["pour"]:
            self._read_pour(words[4:], variables)
        elif words[0] == "fix" and words[3:4] == ["gravity"] and len(words) > 4:
            self.gravity = variables.number(words[4]) or self.gravity

    def _read_set(self, words: list[str], variables: Variables) -> None:
        places = {"diameter": self.diameters, "density": self.densities, "mass": self.masses}
        for name, text in pairwise(words):
            key = name.removesuffix("/disc")
            if key not in places:
                continue
            value = variables.number(text)
            if value is None:
                self.unknown.append(key)
            else:
                places[key].append(value)
                self.planar |= name == "density/disc"

    def _read_pour(self, words: list[str], variables: Variables) -> None:
        texts = {"diam": ["one", "1"], "dens": ["1", "1"]}
        for name in texts:
            if name in words:
                texts[name] = words[words.index(name) + 1 :]
        style, *sizes = texts["diam"]
        if style == "poly":
            count = int(variables.number(sizes[0]) or 0)
            sizes = sizes[1 : 1 + 2 * count : 2]
        else:
            sizes = sizes[: 2 if style == "range" else 1]
        for name, place, found in (
            ("diameter", self.diameters, sizes),
            ("density", self.densities, texts["dens"][:2]),
        ):
            values = [variables.number(text) for text in found]
            known = [value for value in values if value is not None]
            place += known
            if len(known) < len(values):
                self.unknown.append(name)

    @property
    def diameter(self) -> float:
        """The mean diameter; that of LAMMPS' default where the script makes grains and says nothing.

        Raises
        ------
        NscdError
            It is not in the script.
        """
        return self._mean(self.diameters, "diameter")

    @property
    def mass(self) -> float:
        """The mass of a grain of the mean diameter.

        Raises
        ------
        NscdError
            It is not in the script.
        """
        if self.masses:
            return sum(self.masses) / len(self.masses)
        diameter, density = self.diameter, self._mean(self.densities, "density")
        return density * (math.pi / 4 * diameter**2 if self.planar else math.pi / 6 * diameter**3)

    @property
    def impact_speed(self) -> float:
        """The speed of an impact for models whose restitution depends on it: of a fall by half a diameter.

        Raises
        ------
        NscdError
            Neither the speed nor gravity is known.
        """
        if self.speed:
            return self.speed
        if not self.gravity:
            raise NscdError(
                "restitution of this contact model depends on the speed of impacts, and the script has no `fix gravity`"
                " to estimate it from: give --speed V"
            )
        return math.sqrt(self.gravity * self.diameter)

    def _mean(self, values: list[float], name: str) -> float:
        if not values and not self.elsewhere and name not in self.unknown:
            return 1.0  # LAMMPS' default of both
        if not values:
            raise NscdError(
                f"restitution needs the mass of a grain, and the script does not say the {name}: give --diameter D"
                " and --density RHO of the mean grain, or --mass M, in the script's units"
            )
        return sum(values) / len(values)
