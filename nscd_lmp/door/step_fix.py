# SPDX-License-Identifier: GPL-2.0-or-later
"""The fix by which LAMMPS calls the compiled step: ``fix external`` or ``fix python/invoke``."""

import ctypes
import sys
from collections.abc import Callable
from typing import Any

from nscd_lmp._core import ExternalFix, NscdError

FIX_ID = "nscd_python"


def external(lmp: Any, command: Callable[[str], Any], group: str, step: ExternalFix) -> None:
    """Define a fix external and give it the address of the compiled callback."""
    command(f"fix {FIX_ID} {group} external pf/callback 1 1")
    register = ctypes.cast(
        lmp.lib.lammps_set_fix_external_callback,
        ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_void_p),
    )
    register(address(lmp.lmp), FIX_ID.encode(), step.callback_address, step.self_address)


def invoke(lmp: Any, command: Callable[[str], Any], group: str, step: ExternalFix) -> None:
    """Define a fix python/invoke of the step's compiled method.

    LAMMPS looks the function up in ``__main__``, once, when the fix is defined. It must be a compiled one: in
    Python code Ctrl-C could raise an exception, and LAMMPS ends the process when the function raises.
    """
    main = sys.modules["__main__"]
    setattr(main, FIX_ID, step.invoke)
    try:
        command(f"fix {FIX_ID} {group} python/invoke 1 post_force {FIX_ID}")
    finally:
        delattr(main, FIX_ID)


# `door` of attach -> what defines its fix, and the fix style that LAMMPS must have.
DOORS = {"external": (external, "external"), "invoke": (invoke, "python/invoke")}


def definition(lmp: Any, door: str) -> Callable[..., None]:
    """Return the function that defines the door's fix; raise if there is no such door in this build."""
    if door not in DOORS:
        raise NscdError(f"unknown door {door!r}: choose one of {', '.join(DOORS)}")
    define, style = DOORS[door]
    if not lmp.has_style("fix", style):
        raise NscdError(
            f'door "{door}" needs fix {style}, which this LAMMPS was built without (package PYTHON):'
            ' use door="external"'
        )
    return define


def address(pointer: Any) -> int:
    """Return the integer address of LAMMPS' handle, which some versions keep as int, some as c_void_p."""
    return int(pointer.value or 0) if isinstance(pointer, ctypes.c_void_p) else int(pointer)
