# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step costs at 1e9 grains on 1e5 cores: a model with constants that scale.py, scale_ranks.py and
scale_sweeps.py have measured, and a network that is assumed.

A rank has a cube of n grains. An iteration is

    n c t  +  2 (latency + messages x overhead + bytes / bandwidth)  +  2 log2(P) latency

with c contacts a grain, t seconds a contact and iteration, and one reduction. Bytes are those of the grains that a rank
shares across its six faces. The iterations of a step are a power of the bed's height in layers.

    python benchmarks/scale_model.py
    python benchmarks/scale_model.py --cores-a-node 1
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from record import Record, print_table

SOLID = 0.6  # share of the volume
NEIGHBOURS = 26  # ranks around a cube


@dataclass(frozen=True)
class Measured:
    """Constants of a solver, and where they are from."""

    name: str
    contacts_per_grain: float  # scale.py
    sweep: float  # s a contact and iteration, 10,000 grains: scale.py
    outside: float  # s a grain and step outside the solver: scale.py
    shared_per_face: float  # grains for each square of a grain's diameter, scale_ranks.py
    numbers: int  # that are sent of a shared grain
    step_reductions: float  # beside those of iterations, scale_ranks.py
    step_exchanges: float
    iterations_at_8_layers: float  # to (42) < 1e-7 m/s, scale_sweeps.py
    power_of_height: float


MEASURED = (
    Measured("apgs", 2.81, 5.7e-9, 223e-9, 0.61, 3, 21, 12, 207, 0.42),
    # Iterations with friction depend on the scene: four times as many are assumed.
    Measured("apgs, friction 0.3", 2.76, 30.9e-9, 568e-9, 0.58, 6, 23, 13, 828, 0.42),
)


@dataclass(frozen=True)
class Network:
    """What is assumed of the machine."""

    latency: float = 1.5e-6  # s
    overhead: float = 0.3e-6  # s of the core for a message sent or received
    bandwidth: float = 10e9  # bytes/s of a node
    cores_a_node: int = 64


def iteration(m: Measured, net: Network, grains: float, ranks: float) -> dict[str, float]:
    """Return the parts of an iteration of a rank with so many grains, s."""
    edge = (grains * math.pi / 6 / SOLID) ** (1 / 3)  # in diameters
    size = 8 * m.numbers * m.shared_per_face * 6 * edge**2
    alone = ranks == 1
    round_ = net.latency + 2 * NEIGHBOURS * net.overhead + size * net.cores_a_node / net.bandwidth
    return {
        "sweep": grains * m.contacts_per_grain * m.sweep,
        "exchange": 0.0 if alone else 2 * round_,
        "reduction": reduction(net, ranks),
    }


def reduction(net: Network, ranks: float) -> float:
    """Return what a sum over all ranks takes, s."""
    return 2 * math.log2(ranks) * net.latency


def layers(grains: float) -> float:
    """Return the height of a bed that is as high as wide."""
    return (grains * math.pi / 6 / SOLID) ** (1 / 3)


def iterations(m: Measured, height: float) -> float:
    """Return the iterations of a step on a bed of so many layers."""
    return m.iterations_at_8_layers * (height / 8) ** m.power_of_height


def step_rows(net: Network, grains: float, ranks: float, record: Record) -> list[list[Any]]:
    """Return what a step takes, in a flat bed and in one as high as wide."""
    rows = []
    for m in MEASURED:
        of = iteration(m, net, grains / ranks, ranks)
        once = grains / ranks * m.outside + m.step_reductions * reduction(net, ranks)
        once += m.step_exchanges * of["exchange"] / 2
        for bed, height in (("8 layers", 8.0), ("a cube", layers(grains))):
            count = iterations(m, height)
            seconds = once + count * sum(of.values())
            us = {f"{name}_us": 1e6 * part for name, part in of.items()}
            row = {"bed": bed, "layers": height, **us, "iterations": count, "beside_ms": 1e3 * once, "step_s": seconds}
            record.add(part="step", solver=m.name, grains=grains, ranks=ranks, **row)
            rows.append([m.name, bed, *list(row.values())[2:]])
    return rows


def draw(net: Network, per_rank: float, path: Path) -> None:
    """Draw an iteration against the number of ranks, and the share of it that is sweeping against their size."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    ranks = np.logspace(0, 6, 61)
    sizes = np.logspace(2, 6, 81)
    for k, m in enumerate(MEASURED):
        parts = [iteration(m, net, per_rank, p) for p in ranks]
        left.loglog(ranks, [1e6 * sum(p.values()) for p in parts], f"C{k}", label=m.name)
        left.loglog(ranks[1:], [1e6 * p["exchange"] for p in parts[1:]], f"C{k}--", label="exchanges")
        shares = [iteration(m, net, n, 1e5) for n in sizes]
        right.semilogx(sizes, [of["sweep"] / sum(of.values()) for of in shares], f"C{k}", label=m.name)
    left.loglog(ranks[1:], [1e6 * reduction(net, p) for p in ranks[1:]], "k:", label="reduction")
    left.set(title=f"an iteration, {per_rank:g} grains a rank", xlabel="ranks", ylabel="us")
    right.set(title="share of an iteration that is sweeping, 1e5 ranks", xlabel="grains a rank", ylim=(0, 1))
    for axis in (left, right):
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


def main(words: Sequence[str] | None = None) -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=float, default=1e9, help="[%(default)g]")
    parser.add_argument("--ranks", type=float, default=1e5, help="[%(default)g]")
    parser.add_argument("--cores-a-node", type=int, default=64, help="that share 10 GB/s [%(default)s]")
    parser.add_argument("--output", type=Path, default=Path("output/benchmarks"), help="folder [%(default)s]")
    parser.add_argument("--quick", action="store_true", help="the same: it takes no time")
    given = parser.parse_args(words)
    record = Record("scale_model")
    record.print_origin()
    net = Network(cores_a_node=given.cores_a_node)
    rows = step_rows(net, given.grains, given.ranks, record)
    titles = ["solver", "bed", "an iteration, us:\nsweep", "exchanges", "reduction", "iterations\na step"]
    title = f"{given.grains:g} grains on {given.ranks:g} ranks"
    print_table(title, [*titles, "beside them,\nms a step", "a step, s"], rows)
    record.write(given.output / "scale_model.csv")
    draw(net, given.grains / given.ranks, given.output / "scale_model.png")


if __name__ == "__main__":
    main()
