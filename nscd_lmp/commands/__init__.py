# SPDX-License-Identifier: GPL-2.0-or-later
"""The subcommands of ``nscd-lmp``.

A module ``x`` here is the subcommand ``nscd-lmp x``: its docstring is the help text,
``add_arguments(parser)`` declares its options and ``main(arguments)`` runs it. Nothing else knows of it.
"""
