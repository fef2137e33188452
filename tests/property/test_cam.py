# SPDX-License-Identifier: Apache-2.0
"""The compiled cam against rational arithmetic: every position, whatever the master does."""

from fractions import Fraction
from itertools import accumulate, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from levelwind.cam.table import Cam, Limits, Scale, Table, check
from levelwind.map_table import CamInterpolation
from rational_cam import NOTE_ROWS, STEPS_PER_EDGE_MAX, RationalCam, cams

LIMITS = Limits(top_edges_per_s=20_000, steps_per_s_max=80_000)
CYCLES = 1000
INTERPOLATIONS = pytest.mark.parametrize("interpolation", CamInterpolation, ids=lambda i: i.label)


def net_edges(runs: list[int]) -> list[int]:
    """Net edges before every edge of the runs, and after the last."""
    directions = (1 if run > 0 else -1 for run in runs for _ in range(abs(run)))
    return list(accumulate(directions, initial=0))


def check_follows(cam: RationalCam, start: int, runs: list[int]) -> None:
    """The compiled cam is at the rational position at every edge of the runs."""
    edges = net_edges(runs)
    expected = [cam.usteps(start + net) for net in edges]
    result, trace, _ = Cam(cam.table, cam.scale, start).run(runs, trace_points=len(edges))
    assert trace.tolist() == expected[:-1]
    assert result.pos == expected[-1]
    assert (result.min_pos, result.max_pos) == (min(expected), max(expected))
    pulses = [abs(b - a) for a, b in pairwise(expected)]
    assert result.pulses == sum(pulses)
    assert result.step_max == max(pulses, default=0) <= STEPS_PER_EDGE_MAX


@INTERPOLATIONS
def test_the_notes_table_for_a_thousand_cycles(interpolation: CamInterpolation):
    """Every master count of a thousand cycles forward, and of a thousand backward."""
    model = RationalCam(Table(NOTE_ROWS, interpolation))
    check(model.table, model.scale, LIMITS)
    expected = np.array([model.usteps(edge) for edge in range(model.cycle)])
    for master, slave in NOTE_ROWS[:-1]:
        assert expected[master] == slave
    cam = Cam(model.table, model.scale)
    for cycle in range(CYCLES):
        result, trace, _ = cam.run([model.cycle], trace_points=model.cycle)
        assert np.array_equal(trace, expected), f"cycle {cycle}"
    assert (result.pos, result.row, result.cycles) == (0, 0, CYCLES)
    backward = np.roll(expected[::-1], 1)
    for cycle in range(CYCLES):
        result, trace, _ = cam.run([-model.cycle], trace_points=model.cycle)
        assert np.array_equal(trace, backward), f"cycle {cycle} backward"
    assert (result.pos, result.row, result.cycles) == (0, 0, 0)


@settings(max_examples=100)
@given(
    cams(),
    st.integers(-3000, 3000),
    st.lists(st.integers(-300, 300), min_size=1, max_size=4),
)
def test_equals_rational_arithmetic_edge_by_edge(cam: RationalCam, start: int, runs: list[int]):
    check(cam.table, cam.scale, Limits(1, 10))
    check_follows(cam, start, runs)


@settings(max_examples=200)
@given(cams(), st.lists(st.integers(-5000, 5000), max_size=20), st.integers(-20_000, 20_000))
def test_the_state_depends_on_net_edges_only(cam: RationalCam, runs: list[int], net: int):
    """Two ways to the same place, and a start there, are one state: all that follows is equal."""
    direct = Cam(cam.table, cam.scale)
    direct.run([net])
    rocked = Cam(cam.table, cam.scale)
    rocked.run([*runs, net - sum(runs)])
    started = Cam(cam.table, cam.scale, net)
    assert direct.state() == rocked.state() == started.state()


def test_gearing_is_two_rows_that_advance():
    """(0, 0) and (M, S): round(S / M * edges) for ever."""
    cam = RationalCam(Table(((0, 0), (7, 3)), advance=3))
    check_follows(cam, 0, [1000, -2001])
    result, _, _ = Cam(cam.table, cam.scale).run([7 * 10**7])
    assert result.pos == 3 * 10**7


def test_scales_do_not_round_twice():
    """A third of a microstep per edge through both scales together, over many cycles."""
    scale = Scale(edges=9, master_units=7, usteps=3, slave_units=7)
    cam = RationalCam(Table(((0, 0), (10, 10)), advance=10), scale)
    assert cam.exact(3) == Fraction(3, 3) == 1
    check_follows(cam, 0, [1000, -2001])


def test_goes_on_with_another_table_at_the_boundary():
    first = Table(((0, 0), (100, 50), (200, 0)))
    second = Table(((0, 0), (60, -40), (150, 0)), CamInterpolation.TRAPEZOID)
    one, two = RationalCam(first), RationalCam(second)
    cam = Cam(first, Scale())
    _, trace, _ = cam.run([120, -60, 300], 480, next_table=second)
    expected = [one.usteps(n) for n in [*range(120), *range(120, 60, -1), *range(60, 200)]]
    expected += [two.usteps(n) for n in range(160)]
    assert trace.tolist() == expected
    cam = Cam(first, Scale())
    _, trace, _ = cam.run([20, -170], 190, next_table=second)
    expected = [one.usteps(n) for n in [*range(20), *range(20, -1, -1)]]
    expected += [two.usteps(-n) for n in range(1, 150)]
    assert trace.tolist() == expected
