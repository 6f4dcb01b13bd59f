# SPDX-License-Identifier: GPL-2.0-or-later
"""What happens to grains does not depend on grains that they are not connected to."""

from __future__ import annotations

import islands
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from islands import Island

import nscd_lmp

STEPS = 25
# m; law moreau needs grains that a step does not move by their radius
RADII = {"gap": [0.05, 5e-4, 5e-8], "moreau": [0.05, 0.5]}


def islands_of(law: str) -> st.SearchStrategy[Island]:
    """Return a strategy of islands that the law can do."""
    kinds, forces = st.sampled_from(islands.KINDS), st.integers(-6, 6).map(lambda k: 10.0**k)
    return st.builds(Island, kinds, st.sampled_from(RADII[law]), st.integers(1, 12), forces)


def assert_alone_as_together(parts, door="python", dt=1e-3, **options):
    """Assert that each island moves in company as it does alone, within its own tolerance."""
    together = islands.run(parts, list(range(len(parts))), door, dt, STEPS, unconverged="ignore", **options)
    for place, part in enumerate(parts):
        (alone,) = islands.run([part], [place], door, dt, STEPS, unconverged="ignore", **options)
        off = np.abs(together[place] - alone).max(axis=(0, 1))
        # the default tolerance is 1e-3 of what velocities are worth; a column adds up what its contacts leave
        chain = part.n if part.kind == "column" else 1
        allowed = 5e-3 * chain * part.worth(dt)
        assert off[3:].max() <= allowed, f"{part}: velocity off by {off[3:].max():.3g} m/s, allowed {allowed:.3g}"
        moved = 5e-4 + STEPS * dt * allowed / part.radius
        assert off[:3].max() <= moved, f"{part}: place off by {off[:3].max():.3g} r, allowed {moved:.3g}"


COLUMN = Island("column", n=10)
PRESSED = Island("pressed", force=1e4)


@pytest.mark.parametrize("door", ["python", "script"])
@pytest.mark.parametrize(
    ("law", "e", "parts"),
    [
        ("gap", 0.0, [COLUMN, PRESSED]),
        ("moreau", 0.0, [COLUMN, PRESSED]),
        ("gap", 0.9, [Island("collision"), PRESSED]),
        ("moreau", 0.9, [Island("collision"), PRESSED]),
        ("gap", 0.9, [Island("collision", radius=5e-8), Island("flying")]),
        ("gap", 0.0, [COLUMN, Island("flying")]),
        ("moreau", 0.0, [COLUMN, Island("flying")]),
        ("gap", 0.0, [Island("column", radius=5e-8), COLUMN]),
    ],
)
def test_islands_in_one_box_move_as_each_does_alone(door, law, e, parts):
    assert_alone_as_together(parts, door, law=law, restitution=e)


@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_rough_islands_in_one_box_move_as_each_does_alone(law):
    assert_alone_as_together([Island("spinning"), PRESSED, COLUMN], law=law, friction=0.3)


@pytest.mark.parametrize("law", nscd_lmp.LAWS)
def test_random_islands_in_one_box_move_as_each_does_alone(law):
    @settings(deadline=None, max_examples=25, derandomize=True, database=None)
    @given(
        st.lists(islands_of(law), min_size=2, max_size=3),
        st.sampled_from([0.0, 0.9]),
        st.sampled_from([0.0, 0.3]),
        st.sampled_from([1e-3, 1e-4]),
    )
    def check(parts, e, mu, dt):
        assert_alone_as_together(parts, law=law, restitution=e, friction=mu, dt=dt)

    check()
