# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS input text as the single commands that LAMMPS makes of it."""


def split_commands(text: str) -> list[str]:
    """Return the commands of a block of input: lines, with ``&`` and triple quotes joining several.

    Parameters
    ----------
    text : str
        As for ``lammps.commands_string``.

    Returns
    -------
    list of str
        In order, empty lines left out.
    """
    commands: list[str] = []
    pending = ""
    for line in text.splitlines():
        pending += line
        if pending.count('"""') % 2:
            pending += "\n"
        elif pending.rstrip().endswith("&"):
            pending = pending.rstrip()[:-1]
        else:
            commands.append(pending)
            pending = ""
    commands.append(pending)
    return [command for command in commands if command.strip()]
