# SPDX-License-Identifier: GPL-2.0-or-later
"""Make the pictures of these pages anew, by the commands of gallery.md.

python docs/remake_gallery.py                 # all, hours
python docs/remake_gallery.py atlas_rho_mass  # some
python docs/remake_gallery.py --list

Works in FOLDER, where charts and maps that are finished are not made again, and copies pictures, and tables of the same
name, to docs/pictures. A command that fails is told at the end; the others are run.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BESIDE = ("inputs", "analysis", "benchmarks")  # folders that commands name
ROW = re.compile(
    r"^\| \[!\[.*?\]\(pictures/(?P<name>\w+)\.png\)\].*? \| `(?P<command>[^`]+)` \| `(?P<made>[^`]+)` \|$", re.M
)


@dataclass(frozen=True)
class Picture:
    """A row of the gallery: the command writes `made`, which becomes ``pictures/NAME.png``."""

    name: str
    command: str
    made: Path


def pictures() -> dict[str, Picture]:
    """Return the rows of gallery.md by name."""
    found = ROW.finditer((DOCS / "gallery.md").read_text(encoding="utf-8"))
    return {row["name"]: Picture(row["name"], row["command"], Path(row["made"])) for row in found}


def run(command: str, folder: Path) -> bool:
    """Run a command in the folder, with the programs of this Python's environment; return whether it succeeded."""
    paths = [sysconfig.get_path("scripts"), str(Path(sys.executable).parent), os.environ["PATH"]]
    environment = os.environ | {"PATH": os.pathsep.join(paths), "MPLBACKEND": "agg"}
    print(f"$ {command}", flush=True)
    return subprocess.run(["bash", "-c", command], cwd=folder, env=environment).returncode == 0


def publish(picture: Picture, folder: Path, published: Path) -> None:
    """Copy a picture, and the table where one is published beside it."""
    shutil.copyfile(folder / picture.made, published / f"{picture.name}.png")
    table = published / f"{picture.name}.csv"
    if table.exists():
        shutil.copyfile(folder / picture.made.with_suffix(".csv"), table)


def remake(names: Sequence[str], folder: Path, published: Path) -> list[str]:
    """Run the commands of the pictures, each once, and copy what they make; return the commands that failed."""
    folder.mkdir(parents=True, exist_ok=True)
    for beside in BESIDE:
        if not (folder / beside).exists():
            (folder / beside).symlink_to(DOCS.parent / beside)
    wanted = [pictures()[name] for name in names]
    for picture in wanted:
        (folder / picture.made).unlink(missing_ok=True)  # or an old one could pass for what the command has made
    failed = [command for command in dict.fromkeys(one.command for one in wanted) if not run(command, folder)]
    for picture in wanted:
        if (folder / picture.made).exists():
            publish(picture, folder, published)
        elif picture.command not in failed:
            failed.append(picture.command)
    return failed


def main(words: Sequence[str] | None = None) -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="pictures, without .png [all]")
    parser.add_argument("--list", action="store_true", help="show names and commands")
    parser.add_argument("--folder", type=Path, default=Path("output/gallery"), help="to work in [%(default)s]")
    parser.add_argument("--pictures", type=Path, default=DOCS / "pictures", help="to copy to [docs/pictures]")
    given = parser.parse_args(words)
    known = pictures()
    if given.list:
        print("\n".join(f"{one.name}: {one.command}" for one in known.values()))
        return 0
    unknown = [name for name in given.names if name not in known]
    if unknown:
        parser.error(f"no picture {', '.join(unknown)} in gallery.md: choose from {', '.join(known)}")
    failed = remake(given.names or list(known), given.folder, given.pictures)
    for command in failed:
        print(f"failed: {command}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
