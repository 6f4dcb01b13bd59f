# SPDX-License-Identifier: GPL-2.0-or-later
"""Every code block of README.md and docs/ runs: a page's blocks in their order, in one empty folder.

``python`` blocks run as scripts, ``bash`` blocks under ``bash -eu``, ``lammps`` blocks as input of ``lmp``; those in
``cpp`` are for test_recipes.py; others are text. An HTML comment on the line before a block can say otherwise:
``<!-- not run: reason -->``, or ``<!-- command: name -->``, which marks README's two command lines.

Of a block that has nothing but quick benchmarks, all of which test_benchmarks.py runs, the first line alone is run.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
from dataclasses import replace
from pathlib import Path

import pytest
from pages import PAGES, README, Block, blocks, prose, title
from test_benchmarks import FILES as BENCHMARKS

import nscd_lmp
from nscd_lmp._choices import KEYWORDS

ROOT = Path(__file__).parent.parent
BESIDE = ("inputs", "analysis", "benchmarks")  # folders that blocks may name, linked into theirs
COMMANDS = {
    "python": (sys.executable, "block.python"),
    "bash": ("bash", "-euo", "pipefail", "block.bash"),
    "lammps": ("lmp", "-in", "block.lammps"),
}


def run(block: Block, folder: Path, where: str) -> None:
    """Run a block in the folder; fail with what it printed."""
    (folder / f"block.{block.language}").write_text(block.text)
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])
    environment = os.environ | {"PATH": path, "MPLBACKEND": "agg"}
    done = subprocess.run(
        COMMANDS[block.language], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300,
    )  # fmt: skip
    if done.returncode != 0:
        pytest.fail(f"{where}: exit status {done.returncode}\n{block.text}\n{done.stdout[-3000:]}", pytrace=False)


def without_benchmarks(block: Block) -> Block:
    """Return the block, or its first line if all are benchmarks that test_benchmarks.py runs with ``--quick``."""
    quick = {f"python benchmarks/{name}.py --quick" for name in BENCHMARKS}
    lines = block.text.splitlines()
    return replace(block, text=lines[0] + "\n") if set(lines) <= quick else block


@pytest.mark.parametrize("page", PAGES, ids=title)
def test_blocks_run(page: Path, tmp_path: Path) -> None:
    for name in BESIDE:
        if (ROOT / name).is_dir():
            (tmp_path / name).symlink_to(ROOT / name)
    for block in blocks(page):
        if block.mark is None and block.language in COMMANDS:
            run(without_benchmarks(block), tmp_path, f"{title(page)}, block at line {block.line}")


@pytest.mark.parametrize("page", PAGES, ids=title)
def test_marks_of_blocks_are_known(page: Path) -> None:
    assert {block.mark for block in blocks(page)} <= {None, "not run", "not built", "command"}
    # A fence that is not closed, or indented, would hide its block from this file.
    assert page.read_text().count("```") == 2 * len(blocks(page))


def command(name: str) -> str:
    """Return one of README's command lines."""
    found = [block for block in blocks(README) if (block.mark, block.reason) == ("command", name)]
    assert len(found) == 1 and found[0].language == "bash" and found[0].text.count("\n") == 1
    return found[0].text.strip()


def test_readme_opens_with_the_two_commands() -> None:
    """They differ in what they install and in what they run at the end; .ci/run proves the second."""
    first, second = blocks(README)[:2]
    assert (first.text.strip(), second.text.strip()) == (command("demo"), command("test"))
    *install, _ = command("demo").split(" && ")
    *install_tests, pytest_line = command("test").split(" && ")
    assert [words.replace('".[test]"', ".") for words in install_tests] == install
    assert pytest_line == ".venv/bin/pytest"


def test_readme_demo_runs(tmp_path: Path) -> None:
    """What the first command line runs once everything is set up."""
    last = command("demo").split(" && ")[-1].replace(".venv/bin/", "")
    run(Block(0, None, None, "bash", last, ""), tmp_path, "README.md, command demo")
    assert list(tmp_path.rglob("*.png")), "no picture"
    (log,) = tmp_path.rglob("log.sedimentation")
    assert "WARNING" not in log.read_text()  # an example that a newcomer runs first is right by our own lights


def test_ci_runs_the_second_command(tmp_path: Path) -> None:
    """.ci/run takes its line from README.md and hands its exit status on."""
    (tmp_path / ".ci").mkdir()
    script = tmp_path / ".ci" / "run"
    script.write_bytes((ROOT / ".ci" / "run").read_bytes())
    page = "<!-- command: demo -->\n```bash\nexit 9\n```\n\n<!-- command: test -->\n```bash\n{}\n```\n"
    for status in (0, 3):
        (tmp_path / "README.md").write_text(page.format(f"echo last && exit {status}"))
        done = subprocess.run(["bash", str(script)], cwd="/", capture_output=True, text=True)
        assert done.returncode == status
        assert done.stdout.splitlines()[-1] == "last"
    (tmp_path / "README.md").write_text("no commands\n")
    assert subprocess.run(["bash", str(script)], capture_output=True).returncode != 0


def anchors(page: Path) -> set[str]:
    """Return the names by which links reach places of a page: of its headings, as GitHub makes them, and its own."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.M)
    own = re.findall(r'<a id="([^"]+)">', prose(page))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings} | set(own)


@pytest.mark.parametrize("page", [*PAGES, ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"], ids=title)
def test_links_lead_somewhere(page: Path) -> None:
    dead = []
    for link in re.findall(r"\]\(([^()\s]+)\)", prose(page)):
        place, _, heading = link.partition("#")
        target = page.parent / place if place else page
        if "://" not in link and not (target.exists() and (not heading or heading in anchors(target))):
            dead.append(link)
    assert dead == []


@pytest.mark.parametrize("page", PAGES, ids=title)
def test_what_is_called_the_default_is_it(page: Path) -> None:
    """Of solvers and contact laws: names before "(default)" in a line."""
    called = [
        name
        for line in prose(page).splitlines()
        if "(default)" in line
        for name in re.findall(r"`(?:solver |law )?(\w+)`", line.partition("(default)")[0])
        if name in nscd_lmp.SOLVERS or name in nscd_lmp.LAWS
    ]
    assert set(called) <= {KEYWORDS["solver"].value, KEYWORDS["law"].value}


def test_compilers_that_readme_promises_are_tested() -> None:
    """GCC is Debian's default, and clang is what .ci/run brings."""
    (promise,) = re.findall(r"Needed are [^.]*\.\d+[^.]*\.", README.read_text())
    assert all(name in promise for name in ("Linux", "GCC", "clang"))
    assert "clang" in re.findall(r"packages=\(.*\)", (ROOT / ".ci" / "run").read_text())[0]
    assert "Operating System :: POSIX :: Linux" in (ROOT / "pyproject.toml").read_text()
