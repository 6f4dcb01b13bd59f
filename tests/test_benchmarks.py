# SPDX-License-Identifier: GPL-2.0-or-later
"""Each benchmark runs and writes what it promises; what it measures is no test."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"
PROVENANCE = {"benchmark", "commit", "cpu", "date", "version"}
FILES = {
    "paper_tables": {
        "paper_tables.csv": {
            "part",
            "script",
            "solver",
            "steps",
            "ground",
            "iterations_per_step",
            "iterations_per_solved_step",
            "paper_iterations_per_step",
            "cpu_seconds_total",
            "paper_cpu_seconds_total",
            "cpu_seconds_solver",
            "paper_contact_cpu_seconds",
            "cpu_seconds_contacts",
            "iterations_ratio",
            "solver_ratio",
            "paper_contact_ratio",
            "worst_overlap_m",
            "worst_overlap_ratio",
            "unconverged_steps",
            "dissipated_energy_j",
        },
        "figure4.csv": {"step", "law", "solver", "contacts", "iterations", "criterion"},
        "figure4.png": None,
    },
    "sweep_cost": {
        "sweep_cost.csv": {
            "part",
            "model",
            "friction",
            "grains",
            "contacts",
            "law",
            "solver",
            "warmstart",
            "iterations_per_step",
            "sweep_ns_best",
            "sweep_ns_median",
            "sweep_ns_limit",
            "step_us_best",
            "step_us_median",
            "step_us_limit",
            "bytes_per_contact",
        }
    },
    "friction_laws": {
        "friction_laws.csv": {
            "scene",
            "start",
            "friction",
            "solver",
            "law",
            "steps",
            "grains",
            "dt",
            "tol",
            "maxiter",
            "contacts",
            "iterations_per_step",
            "seconds_per_step",
            "ns_per_contact_and_iteration",
            "unconverged_steps",
            "criterion",
            "relative_residual",
        },
        "friction_laws.png": None,
    },
    "flow_dissipation": {
        "flow_dissipation.csv": {
            "grains",
            "law",
            "accuracy",
            "dt",
            "velocity",
            "meets",
            "lasts",
            "sticks",
            "slides",
            "impulse",
        }
    },
    "rough_incline": {
        "rough_incline.csv": {
            "seed",
            "dt",
            "law",
            "accuracy",
            "nudge",
            "stiffness",
            "velocity",
            "scatter",
            "fraction",
            "fluctuation",
            "cpu_per_second",
        },
        "rough_incline.png": None,
    },
    "deposits": {
        "deposits.csv": {
            "friction",
            "dt",
            "seed",
            "grains",
            "fraction",
            "contacts",
            "rattlers",
            "speed",
            "overlap_ratio",
            "sweeps_per_step",
            "accepted_steps",
            "unconverged_steps",
            "cpu_seconds",
        }
    },
    "incline_stop": {
        "incline_stop.csv": {
            "angle",
            "dt",
            "seed",
            "velocity",
            "stopped_after",
            "seconds",
            "cpu_seconds",
        }
    },
    "mesh_drum": {
        "mesh_drum.csv": {
            "kind",
            "grains",
            "seed",
            "dt",
            "angle",
            "angle_error",
            "torque",
            "torque_error",
            "overlap",
            "cpu_seconds",
        }
    },
    "drum_angle": {
        "drum_angle.csv": {
            "kind",
            "friction",
            "seed",
            "dt",
            "angle",
            "deviation",
            "by_then",
            "given_up",
            "cpu_seconds",
        }
    },
    "long_rest": {
        "long_rest.csv": {
            "case",
            "seed",
            "step",
            "rise",
            "moved",
            "speed",
            "spin",
            "fastest",
            "momentum",
            "overlap_ratio",
            "contacts",
            "cpu_seconds",
        }
    },
    "hopper_rate": {
        "hopper_rate.csv": {
            "slot",
            "discs",
            "seed",
            "dt",
            "rate",
            "later",
            "discharged",
            "seconds",
            "given_up",
            "cpu_seconds",
        }
    },
    "friction_scenes": {
        "friction_scenes.csv": {
            "scene",
            "friction",
            "kind",
            "seed",
            "dt",
            "cpu_seconds",
            "overlap_ratio",
            "outcome",
            "given_up",
        }
    },
    "repelling_contacts": {
        "repelling_contacts.csv": {
            "friction",
            "step",
            "contacts",
            "sweeps",
            "residual",
            "repelled",
            "growth",
            "negative",
            "grown",
            "changed",
        }
    },
    "friction_accuracy": {
        "friction_accuracy.csv": {
            "part",
            "grains",
            "accuracy",
            "friction",
            "dt",
            "seed",
            "cpu_seconds",
            "frictionless_cpu_seconds",
            "sweeps_per_step",
            "accepted_steps",
            "given_up_steps",
            "overlap_ratio",
            "height",
            "floor_ratio",
            "walls_ratio",
            "pushing_contacts",
            "force_variation",
            "stress_ratio",
            "creep",
            "residual",
            "last_correction",
            "stiffness",
            "part_of_contact",
        }
    },
    "example_steps": {
        "example_steps.csv": {
            "scene",
            "seed",
            "kind",
            "factor",
            "grains",
            "steps",
            "cpu_seconds",
            "ratio",
            "overlap_ratio",
            "sweeps_per_step",
            "accepted_steps",
            "given_up_steps",
            "speed",
            "height",
            "kinetic_energy",
            "speed_off",
            "height_off",
        }
    },
    "lammps_examples": {
        "lammps_examples.csv": {
            "example",
            "grains",
            "simulated",
            "cpu_seconds",
            "cpu_per_time",
            "springs_cpu_per_time",
            "ratio",
            "overlap_ratio",
            "springs_overlap_ratio",
            "given_up_steps",
            "quantity",
            "result",
            "springs_result",
            "kinetic_energy",
            "springs_kinetic_energy",
        }
    },
    "solvers": {
        "solvers.csv": {
            "part",
            "case",
            "grains",
            "contacts",
            "solver",
            "tol",
            "iterations",
            "converged",
            "residual",
            "milliseconds",
            "error",
            "reference_residual",
            "dt",
            "steps",
            "unconverged",
            "solver_s",
            "all_s",
            "overlap",
        },
        "solvers.png": None,
    },
    "rest": {
        "rest.csv": {
            "grains",
            "friction",
            "dt",
            "step",
            "contacts",
            "without_impulse",
            "grains_at_rest",
            "islands_with_contacts",
            "largest_island",
            "contacts_that_could_sleep",
        }
    },
    "scale": {
        "scale.csv": {"part", "grains", "solver", "friction", "sweep_ns", "outside_ns", "peak_bytes_per_grain"},
        "scale.png": None,
    },
    "scale_ranks": {
        "scale_ranks.csv": {"part", "grains", "step_strong", "step_weak", "iteration_bytes", "iteration_messages"},
        "scale_ranks.png": None,
    },
    "scale_sweeps": {
        "scale_sweeps.csv": {"part", "size", "solver", "tol", "cold", "warm", "exponent_cold"},
        "scale_sweeps.png": None,
    },
    "scale_model": {
        "scale_model.csv": {"part", "grains", "ranks", "bed", "iterations", "step_s"},
        "scale_model.png": None,
    },
    "ingredients": {
        "ingredients.csv": {
            "ingredient",
            "needed",
            "grains",
            "sweep_ratio",
            "step_ratio",
            "sweep_ns_with",
            "step_us_with",
        }
    },
    "accuracy": {
        "accuracy.csv": {
            "part",
            "method",
            "law",
            "kn",
            "dt",
            "tol",
            "steps",
            "cpu_seconds",
            "wall_seconds",
            "worst_overlap_ratio",
            "variant",
            "error",
        },
        "accuracy.png": None,
    },
}


def rows(path: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("benchmark", FILES)
def test_benchmark_runs_quickly_and_writes_its_columns(benchmark: str, tmp_path: Path) -> None:
    script, folder = BENCHMARKS / f"{benchmark}.py", tmp_path / "out"
    words = [sys.executable, str(script), "--quick", "--output", str(folder)]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    for name, columns in FILES[benchmark].items():
        path = folder / name
        assert path.is_file() and f"wrote {path}" in done.stdout
        if columns is None:
            continue
        written = rows(path)
        assert written and PROVENANCE | columns <= set(written[0])
        assert all(row[column] for row in written for column in PROVENANCE)


def test_every_benchmark_is_tested() -> None:
    scripts = {path.stem for path in BENCHMARKS.glob("*.py") if "def main(" in path.read_text()}
    assert scripts == set(FILES)


def test_table_1_has_the_iterations_of_the_paper(tmp_path: Path) -> None:
    # Counts, not timings: PDAS solves one contact in one iteration, EBP and EAL in two.
    words = ["--parts", "table1", "--quick", "--output", str(tmp_path)]
    subprocess.run([sys.executable, str(BENCHMARKS / "paper_tables.py"), *words], check=True, timeout=120)
    iterations = {row["solver"]: float(row["iterations_per_step"]) for row in rows(tmp_path / "paper_tables.csv")}
    assert (iterations["pdas"], iterations["ebp"], iterations["eal"]) == (1, 2, 2)
    assert iterations["sbp"] > 10 and iterations["sal"] > 10
