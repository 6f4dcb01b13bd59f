# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact models as LAMMPS' granular styles write them: springs, friction, and what hard contacts do not have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from nscd_lmp._core import NscdError
from nscd_lmp.conversion.restitution import Spring
from nscd_lmp.conversion.variables import Word

CLASSIC = {
    "hooke": ("hooke", "mass_velocity"),
    "hooke/history": ("hooke", "mass_velocity"),
    "hertz/history": ("hertz", "viscoelastic"),
}
NORMAL = {"hooke": 2, "hertz": 2, "hertz/material": 3, "dmt": 4, "jkr": 4, "mdr": 6, "none": 0}  # numbers behind it
TANGENTIAL = {
    "none": 0, "linear_nohistory": 2, "linear_history": 3, "linear_history_classic": 3, "mindlin": 3,
    "mindlin_classic": 3, "mindlin/force": 3, "mindlin_rescale": 3, "mindlin_rescale/force": 3,
}  # fmt: skip
DAMPING = {
    "none": 0, "velocity": 0, "mass_velocity": 0, "viscoelastic": 0, "tsuji": 0, "coeff_restitution": 0, "mdr": 1
}  # fmt: skip
ROLLING = {"none": 0, "sds": 3}
TWISTING = {"none": 0, "marshall": 0, "sds": 3}
HEAT = {"none": 0, "radius": 1, "area": 1}
EXTRA = {"rolling": ROLLING, "twisting": TWISTING, "heat": HEAT}
EXTRA_NAMES = {
    "rolling": "rolling friction",
    "twisting": "twisting friction",
    "heat": "heat that flows through contacts",
}


@dataclass
class ContactModel:
    """A contact model.

    Attributes
    ----------
    spring : Spring, optional
        Its normal part; None where restitution has no meaning (``mdr``).
    friction : Word
        Coulomb's coefficient.
    sticks : bool
        Whether a tangential spring holds grains that do not slide.
    left_out : list of str
        What hard contacts do not have.
    remarks : list of str
        What else there is to know.
    used : int
        Words that it takes.
    """

    spring: Spring | None
    friction: Word
    sticks: bool
    left_out: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    used: int = 0


def classic_model(style: str, words: Sequence[Word]) -> ContactModel:
    """Return the model of ``gran/...`` and of ``wall/gran hooke`` and the like.

    Parameters
    ----------
    style : str
        ``hooke``, ``hooke/history`` or ``hertz/history``.
    words : sequence of Word
        Kn Kt gamma_n gamma_t xmu dampflag, and more.

    Raises
    ------
    NscdError
        Words are missing, or are no numbers.
    """
    if len(words) < 6:
        raise NscdError(f"{style} has Kn Kt gamma_n gamma_t xmu dampflag behind it, here are {len(words)} of six")
    stiffness, damping = _number(words[0], "Kn"), _number(words[2], "gamma_n")
    tangential = 0.5 * damping if words[3].value == "NULL" else _number(words[3], "gamma_t")
    if _number(words[5], "dampflag") == 0:
        tangential = 0.0
    limited = len(words) > 6 and words[6].value == "limit_damping"
    normal, damped_by = CLASSIC[style]
    spring = Spring(normal, stiffness, damped_by, damping, limited)
    _number(words[4], "xmu")
    model = ContactModel(spring, words[4], style != "hooke", used=7 if limited else 6)
    if style == "hooke":
        _without_history(model, tangential, "dampflag 0 or gamma_t 0")
    return model


def granular_model(words: Sequence[Word]) -> ContactModel:
    """Return the model of ``pair_coeff I J`` of ``pair_style granular`` and of ``wall/gran granular``.

    Raises
    ------
    NscdError
        A model is not known, or words are missing.
    """
    if not words or words[0].value not in NORMAL:
        known = ", ".join(NORMAL)
        raise NscdError(f"'{words[0].value if words else ''}' is no normal model of pair_style granular: {known}")
    normal, numbers = words[0].value, _after(words, 0, NORMAL)
    damped_by, limited, at = "viscoelastic", False, 1 + len(numbers)
    model = ContactModel(None, Word("0", "0"), False)
    while at < len(words):
        key = words[at].value
        if key == "limit_damping":
            limited, at = True, at + 1
        elif key == "damping":
            found = _after(words, at + 1, DAMPING)
            damped_by, at = words[at + 1].value, at + 2 + len(found)
        elif key == "tangential":
            found = _after(words, at + 1, TANGENTIAL)
            _read_tangential(model, words[at + 1].value, found)
            at += 2 + len(found)
        elif key in EXTRA:
            found = _after(words, at + 1, EXTRA[key])
            if words[at + 1].value != "none":
                text = " ".join(word.value for word in words[at : at + 2 + len(found)])
                model.left_out.append(f"{EXTRA_NAMES[key]} ({text})")
            at += 2 + len(found)
        elif key == "cutoff":
            at += 2
        else:
            break  # what stands behind the model of a wall
    model.used = at
    _read_normal(model, normal, numbers, damped_by, limited)
    return model


def _read_normal(model: ContactModel, normal: str, numbers: Sequence[Word], damped_by: str, limited: bool) -> None:
    if normal in ("mdr", "none"):
        reason = "plastic contacts (mdr)" if normal == "mdr" else "contacts without a normal force"
        model.left_out.append(f"{reason}: hard contacts have the restitution of fix nscd here")
        return
    stiffness, number = _number(numbers[0], "stiffness"), _number(numbers[1], "damping")
    if normal in ("hertz/material", "dmt", "jkr"):
        stiffness *= 2 / 3 / (1 - _number(numbers[2], "Poisson's ratio") ** 2)  # 4/3 E / (2 (1 - nu^2))
    if normal in ("dmt", "jkr") and numbers[3].number != 0:
        model.left_out.append(f"cohesion ({normal} {numbers[3].value}): grains do not hold together")
    model.spring = Spring("hooke" if normal == "hooke" else "hertz", stiffness, damped_by, number, limited)
    if damped_by == "tsuji":
        model.remarks.append(
            f"damping tsuji {numbers[1].value}: restitution is what LAMMPS of July 2025 makes of this number"
        )


def _read_tangential(model: ContactModel, name: str, numbers: Sequence[Word]) -> None:
    if name == "none":
        return
    model.friction, model.sticks = numbers[-1], name != "linear_nohistory"
    _number(numbers[-1], "the coefficient of friction")
    if not model.sticks:
        _without_history(model, _number(numbers[0], "the tangential damping"), "a tangential damping of 0")


def _without_history(model: ContactModel, damping: float, reason: str) -> None:
    """Friction without a spring is damping of the slip, which xmu limits: none without damping."""
    if model.friction.number == 0:
        return
    if damping == 0:
        model.remarks.append(f"no friction: {reason} leaves a model without history none, whatever its coefficient")
        model.friction = Word("0", "0")
    else:
        model.remarks.append("friction without history lets grains at rest creep; hard contacts hold them")


def _after(words: Sequence[Word], at: int, counts: dict[str, int]) -> Sequence[Word]:
    """Return the numbers behind the name of a model."""
    name = words[at].value if at < len(words) else ""
    if name not in counts:
        raise NscdError(f"'{name}' is no model that is known here: {', '.join(counts)}")
    found = words[at + 1 : at + 1 + counts[name]]
    if len(found) < counts[name]:
        raise NscdError(f"{name} has {counts[name]} numbers behind it, here are {len(found)}")
    return found


def _number(word: Word, what: str) -> float:
    if word.number is None:
        raise NscdError(f"{what} is '{word.value}', and should be a number")
    return word.number
