# SPDX-License-Identifier: GPL-2.0-or-later
"""What :func:`nscd_lmp.sweep` is made of.

`cases` makes the cases of grids and lists, `script` and `function` say what a case runs, `pool` runs `worker` in a
process of its own for each, `record` keeps what came of it, `table` collects that.
"""
