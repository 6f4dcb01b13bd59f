# SPDX-License-Identifier: GPL-2.0-or-later
"""Every picture of the pages has a command, the commands are there, and the script that makes them anew works."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SCRIPT = ROOT / "docs" / "remake_gallery.py"
PICTURES = {path.stem for path in (ROOT / "docs" / "pictures").glob("*.png")}


def remake(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the script in a folder."""
    return subprocess.run(
        [sys.executable, str(SCRIPT), *words], cwd=folder, capture_output=True, text=True, timeout=120
    )


@pytest.fixture(scope="module")
def commands(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the commands by picture."""
    done = remake(tmp_path_factory.mktemp("gallery"), "--list")
    return dict(line.split(": ", 1) for line in done.stdout.splitlines())


def test_gallery_has_every_picture(commands):
    assert set(commands) == PICTURES


def test_every_picture_is_on_a_page():
    pages = "\n".join(page.read_text() for page in (ROOT / "docs").rglob("*.md") if page.name != "gallery.md")
    assert set(re.findall(r"pictures/(\w+)\.png", pages)) == PICTURES


def test_every_chart_and_map_is_in_the_gallery(commands):
    from nscd_lmp.atlas import find_maps
    from nscd_lmp.charts.scenes import find_scenes

    made = {command for command in commands.values() if command.startswith("nscd-lmp ") and "&&" not in command}
    charts = {f"nscd-lmp chart {name}" for name in find_scenes()}
    assert made == charts | {f"nscd-lmp atlas {name}" for name in find_maps()}


def test_scripts_that_commands_name_exist(commands):
    words = [word for command in commands.values() for word in shlex.split(command)]
    named = [word for word in words if word.startswith(("inputs/", "analysis/", "benchmarks/"))]
    assert named
    assert [name for name in named if not (ROOT / name).is_file()] == []


def test_script_makes_a_picture_and_copies_it(tmp_path):
    (tmp_path / "published").mkdir()
    words = ("scale_model", "--folder", "work", "--pictures", "published")
    done = remake(tmp_path, *words)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in (tmp_path / "published").iterdir()] == ["scale_model.png"]
    (tmp_path / "published" / "scale_model.csv").touch()
    assert remake(tmp_path, *words).returncode == 0
    assert "benchmark" in (tmp_path / "published" / "scale_model.csv").read_text()


def test_script_names_the_pictures_for_one_it_does_not_know(tmp_path):
    done = remake(tmp_path, "mona_lisa")
    assert done.returncode == 2
    assert "no picture mona_lisa in gallery.md: choose from repose" in done.stderr
    assert list(tmp_path.iterdir()) == []
