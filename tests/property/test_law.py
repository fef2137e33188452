# SPDX-License-Identifier: Apache-2.0
"""P1 to P8 of doc/control-law.md on the compiled law, for any pattern and any drum motion."""

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from levelwind.core.ideal_screw import Screw, State
from levelwind.core.native import Replay, derive, replay
from levelwind.errors import RefusedError, ToolError
from levelwind.line.points import PARAMETERS
from reversing_screw import USTEP, Model, Pattern, motions, paper_diagram, patterns, sweep_states

PROTOTYPE = Pattern(23, 1187, 8000, -8000)
EXTREMES = [
    Pattern(65535, 1, 2, 0),  # the steepest slope, turned round in one edge, smallest window
    Pattern(65535, 1, 31_990, -31_990),
    Pattern(1, 1, 2, 0),  # the flattest
    Pattern(2, 32_767, 1, -1),  # the longest reversal that the range has room for
    Pattern(32_767, 2, 2, 0),
    Pattern(65535, 1, 2, 0, dwell_plus=3, dwell_minus=1),
    Pattern(65535, 1, 2, 0, breaker=1, cycles=2),
    Pattern(65535, 1, 2, 0, dwell_plus=1, breaker=199, cycles=199),
]


def compiled(
    pattern: Pattern, m: int, u: int, runs: list[int], trace: bool = False
) -> tuple[Replay, list[int]]:
    """The compiled law; with a trace, the position before every edge."""
    edges = sum(map(abs, runs))
    result, positions, _ = replay(pattern.setup(m, u), runs, edges if trace else 0)
    return result, positions


def check_equal(pattern: Pattern, m: int, u: int, runs: list[int]) -> Model:
    """The compiled law against the Python model: every position, every step, the last state."""
    model = Model(pattern, m, u).run(runs)
    result, positions = compiled(pattern, m, u, runs, trace=True)
    assert positions == model.positions
    assert (result.m, result.u, result.dwell_edges) == (model.m, model.u, model.rested)
    assert result.cycle_plus == model.cycle(at_plus=True)
    assert result.cycle_minus == model.cycle(at_plus=False)
    assert result.steps == sum(model.steps)
    assert result.pulses == sum(map(abs, model.steps))
    assert set(model.steps) <= {-1, 0, 1}  # P6
    return model


@settings(max_examples=200)
@given(st.data())
def test_equals_the_model_edge_by_edge(data: st.DataObject):
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    check_equal(pattern, m, u, data.draw(motions()))


@pytest.mark.parametrize("pattern", EXTREMES, ids=str)
def test_extreme_patterns(pattern: Pattern):
    for m in (pattern.begin, (pattern.begin + pattern.end) // 2, pattern.end - 1):
        for u in (pattern.ks, -pattern.ks):
            check_equal(pattern, m, u, [140_000, -1, 1, -150_001, 12_345])


@settings(max_examples=100)
@given(st.data())
def test_p1_equals_the_papers_block_diagram_when_hauling_in(data: st.DataObject):
    pattern = data.draw(patterns())
    m, u = data.draw(sweep_states(pattern))
    positions, slopes = paper_diagram(pattern, m, u, 4000)
    result, compiled_positions = compiled(pattern, m, u, [4000], trace=True)
    assert compiled_positions == positions
    assert result.u == slopes[-1]


@settings(max_examples=500)
@given(st.data())
def test_p2_an_edge_and_its_reverse_restore_every_state(data: st.DataObject):
    """Every state, also those that no motion reaches."""
    pattern = data.draw(patterns(dwell=True))
    reach = pattern.overshoot + USTEP
    m = data.draw(st.integers(pattern.begin - reach, pattern.end + reach))
    u = pattern.ka * data.draw(st.integers(-pattern.nr, pattern.nr))
    for runs in ([1, -1], [-1, 1]):
        try:
            result, _ = compiled(pattern, m, u, runs)
        except ToolError:
            assume(False)  # off the orbit a slope can exceed one step per edge
        assert (result.m, result.u, result.steps) == (m, u, 0)


@settings(max_examples=200)
@given(st.data())
def test_p2_forward_n_then_backward_n_restores_all(data: st.DataObject):
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    runs = data.draw(motions(edges_max=20_000))
    result, _ = compiled(pattern, m, u, runs + [-run for run in reversed(runs)])
    assert (result.m, result.u, result.steps) == (m, u, 0)


@settings(max_examples=200)
@given(st.data())
def test_only_net_edges_count(data: st.DataObject):
    """Splitting, rocking and dithering change nothing."""
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    runs = data.draw(motions(edges_max=20_000))
    rocked, _ = compiled(pattern, m, u, runs)
    straight, _ = compiled(pattern, m, u, [sum(runs)])
    assert state(rocked) == state(straight)


def state(result: Replay) -> tuple[int, ...]:
    """All of the law's state, and the steps that led there."""
    return (
        result.m,
        result.u,
        result.dwell_edges,
        result.cycle_plus,
        result.cycle_minus,
        result.steps,
    )


def after(pattern: Pattern, m: int, u: int, net_edges: int) -> tuple[int, ...]:
    """The same by the model, which goes there straight; far ways by the closed form."""
    start = State(m, u)
    at = Screw(*vars(pattern).values()).orbit(start).after(net_edges)
    steps = (at.m >> 16) - (start.m >> 16)
    return (at.m, at.u, at.dwell_edges, at.cycle_plus, at.cycle_minus, steps)


@settings(max_examples=40)
@given(st.data())
def test_a_million_edges_with_breaker_and_dwell_leave_what_the_net_edges_say(data: st.DataObject):
    """Runs up to whole launches, rocking between: the closed form knows the net edges only."""
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    run = st.one_of(st.integers(-3, 3), st.integers(-5000, 5000), st.integers(-300_000, 300_000))
    runs = data.draw(st.lists(run.filter(bool), min_size=4, max_size=200))
    # Filled up to a million edges, here and there and back.
    rest = 1_000_000 - sum(map(abs, runs))
    if rest > 0:
        back = data.draw(st.integers(0, rest))
        runs += [edges for edges in (rest - back, -back) if edges]
    result, _ = compiled(pattern, m, u, runs)
    assert result.edges >= 1_000_000
    assert state(result) == after(pattern, m, u, sum(runs))


def test_the_breaker_lengthens_the_dwell_of_each_cycle():
    """0 to 0.2 drum turns in 8 steps: the dwell of every far point, in both directions."""
    pattern = Pattern(23, 1187, 8000, -8000, breaker=576, cycles=8)
    moving = 81_558 - 4 * 1187  # edges of the sweeps in a period of the pattern without it
    model = Model(pattern, pattern.begin, pattern.ks)
    dwells: dict[bool, list[int]] = {True: [], False: []}
    for dd in (1, -1):
        rested = 0
        for _ in range(10 * 82_200):
            before = model.u
            model.run([dd])
            rested += before == 0 and model.u == 0
            if before == 0 and model.u != 0:
                dwells[model.m >= pattern.end].append(rested)
                rested = 0
        model.positions.clear()
        model.steps.clear()
    up_and_down = [0, 144, 288, 432, 576, 432, 288, 144]
    assert dwells[True][:8] == up_and_down == dwells[False][:8]
    for side in dwells.values():
        half = len(side) // 2
        assert side[half:][: half - 1] == side[:half][::-1][: half - 1]
    period = Screw(*vars(pattern).values()).orbit(State(pattern.begin, pattern.ks)).period_edges
    assert abs(period - 8 * (moving + 4 * 1187) - 2 * sum(up_and_down)) <= 8 * 2
    check_equal(pattern, pattern.begin, pattern.ks, [200_000, -100_000])


@settings(max_examples=100)
@given(st.data())
def test_p3_slope_never_exceeds_ks_and_is_ks_in_the_sweep(data: st.DataObject):
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    for run in data.draw(motions(edges_max=2000)):
        result, _ = compiled(pattern, m, u, [run])
        assert abs(result.u) <= pattern.ks
        if pattern.region(result.m) == 0:
            assert abs(result.u) == pattern.ks
            m, u = result.m, result.u  # a call cannot begin inside of a dwell


@settings(max_examples=200)
@given(st.data())
def test_p4_p5_a_reversal_takes_2_nr_edges_and_overshoots_exactly(data: st.DataObject):
    pattern = data.draw(patterns())
    m, u = data.draw(sweep_states(pattern))
    ks, nr = pattern.ks, pattern.nr
    # Where the reversal is entered, by plain division.
    if u > 0:
        edges = -(-(pattern.end - m) // ks)
    else:
        edges = (m - pattern.begin) // ks + 1
    side = 1 if u > 0 else -1
    entry = m + edges * u

    at_entry, _ = compiled(pattern, m, u, [edges])
    far, _ = compiled(pattern, m, u, [edges + nr])
    left, _ = compiled(pattern, m, u, [edges + 2 * nr])
    assert (at_entry.m, at_entry.u) == (entry, u)
    assert (far.m, far.u) == (entry + side * pattern.overshoot, 0)
    assert (left.m, left.u) == (entry - u, -u)
    assert pattern.region(left.m) == 0
    assert pattern.region(entry) == -side
    if 2 * nr > 1:
        inside, _ = compiled(pattern, m, u, [edges + 2 * nr - 1])
        assert pattern.region(inside.m) == -side


@settings(max_examples=100)
@given(st.data())
def test_p5_position_stays_within_one_overshoot_of_the_reversal_points(data: st.DataObject):
    pattern = data.draw(patterns(dwell=True))
    m, u = data.draw(sweep_states(pattern))
    result, _ = compiled(pattern, m, u, [*data.draw(motions()), 30_000])
    reach = pattern.overshoot // USTEP + 1
    assert pattern.minus - reach - 1 <= result.min_pos
    assert result.max_pos <= pattern.plus + reach + 1


@pytest.mark.parametrize("pattern", [PROTOTYPE, *EXTREMES], ids=str)
def test_p7_no_drift_after_200_million_edges(pattern: Pattern):
    """Against the closed form, which only adds modulo the period."""
    edges = 200_000_000 if pattern is PROTOTYPE else 20_000_000
    start = State((pattern.begin + pattern.end) // 2, pattern.ks)
    orbit = Screw(*vars(pattern).values()).orbit(start)
    for run in (edges, edges - edges % orbit.period_edges, -edges // 4):
        result, _ = compiled(pattern, start.m, start.u, [run])
        expected = orbit.after(run)
        assert (result.m, result.u) == (expected.m, expected.u)


# ---- from parameters to the law ----------------------------------------------------------------

DEFAULTS = {point.name: point.default for point in PARAMETERS}


@st.composite
def parameter_sets(draw: st.DrawFn) -> dict[str, int]:
    """Parameter sets of small machines, most of which the core accepts."""
    values = dict(DEFAULTS)
    usteps_per_rev = draw(st.sampled_from((200, 400, 2000, 6400)))
    um_per_ustep = 20_000 / usteps_per_rev
    ramp_um = draw(st.integers(1, 8000))
    half_um = ramp_um + draw(st.integers(4000, 30_000))
    centre_um = draw(st.integers(-40_000, 40_000))
    clearance_um = draw(st.integers(200, 1500))
    # The overshoot reaches about as far as the flange, on either side.
    beyond_plus_um, beyond_minus_um = (
        ramp_um + round(draw(st.integers(-10, 30)) * um_per_ustep) for _ in range(2)
    )
    edges_per_pulse = draw(st.sampled_from((1, 2, 4)))
    one_step_um = 20_000 * 1440 * edges_per_pulse // usteps_per_rev  # pitch of one step per edge
    values |= {
        "microsteps_per_rev": usteps_per_rev,
        "pitch_um": draw(
            st.one_of(
                st.integers(500, 20_000),
                st.integers(one_step_um * 995 // 1000, one_step_um),
            ).filter(lambda pitch_um: pitch_um <= 100_000)
        ),
        "overshoot_um": ramp_um,
        "slope_tolerance_ppm": draw(st.sampled_from((500, 5000, 50_000))),
        "encoder_edges_per_pulse": edges_per_pulse,
        "reversal_plus_um": centre_um + half_um,
        "reversal_minus_um": centre_um - half_um,
        "flange_plus_um": centre_um + half_um + beyond_plus_um,
        "flange_minus_um": centre_um - half_um - beyond_minus_um,
        "switch_plus_um": centre_um + half_um - clearance_um,
        "switch_minus_um": centre_um - half_um + clearance_um,
        "switch_tolerance_um": 100,
        "switch_hysteresis_um": 100,
        "park_at": 0,
        "centre_position_um": centre_um,
        "travel_um": 2 * half_um + beyond_plus_um + beyond_minus_um,
        "dwell_plus_millirev": draw(st.sampled_from((0, 0, 15, 500))),
        "breaker_millirev": draw(st.sampled_from((0, 0, 200))),
        "breaker_cycles": draw(st.sampled_from((0, 2, 9))),
    }
    if draw(st.booleans()):
        nr = draw(st.integers(1, 900))
        values |= {
            "expert_mode": 1,
            "raw_nr": nr,
            "raw_ka": draw(st.integers(1, 70_000 // nr)),
            "raw_reversal_plus_usteps": round(values["reversal_plus_um"] / um_per_ustep),
            "raw_reversal_minus_usteps": round(values["reversal_minus_um"] / um_per_ustep),
        }
    return values


@settings(max_examples=200)
@given(parameter_sets(), st.data())
def test_p8_whatever_parameters_are_accepted_the_law_can_run(
    values: dict[str, int], data: st.DataObject
):
    try:
        derived = derive(values)
    except RefusedError:
        assume(False)
    pattern = Pattern(
        derived.ka,
        derived.nr,
        derived.reversal_plus_usteps,
        derived.reversal_minus_usteps,
        derived.dwell_plus_edges,
        derived.dwell_minus_edges,
        derived.breaker_edges,
        derived.breaker_cycles,
    )
    assert derived.ks == pattern.ks <= 65535
    assert pattern.plus - pattern.minus >= 2
    # The law, edge by edge, into either reversal: the model checks the width of every number.
    for m, u in ((pattern.end - 1, pattern.ks), (pattern.begin, -pattern.ks)):
        edges = 3 * pattern.nr + pattern.dwell_plus + 10
        model = check_equal(pattern, m, u, [edges, -data.draw(st.integers(1, 2 * edges))])
        um = [position * 20_000 / values["microsteps_per_rev"] for position in model.positions]
        assert values["flange_minus_um"] <= min(um)
        assert max(um) <= values["flange_plus_um"]
    # The slope is the one that was asked for.
    if not values["expert_mode"]:
        edges_per_rev = 1440 * values["encoder_edges_per_pulse"]
        wanted = values["pitch_um"] / 20_000 * values["microsteps_per_rev"] / edges_per_rev * USTEP
        tolerance = values["slope_tolerance_ppm"] / 1e6
        assert pattern.ks == pytest.approx(wanted, rel=tolerance + 1e-9)
