# SPDX-License-Identifier: Apache-2.0
"""The closed form of the reversing screw against the law itself, edge by edge."""

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from levelwind.core.ideal_screw import USTEP, Screw, State

PROTOTYPE = Screw(23, 1187, 8000, -8000)


def law_forward(screw: Screw, state: State) -> State:
    """One forward edge, as doc/control-law.md writes it; a dwell holds the far point."""
    m, u, rested = state.m, state.u, state.dwell_edges
    cycles = {"plus": state.cycle_plus, "minus": state.cycle_minus}
    if u == 0:
        side = "plus" if m >= screw.sweep_end else "minus"
        dwell = screw.dwell_plus_edges if side == "plus" else screw.dwell_minus_edges
        if screw.breaker_edges:
            k = cycles[side]
            half = screw.breaker_cycles // 2
            down = screw.breaker_cycles - half
            height = k if k <= half else half if k <= down else screw.breaker_cycles - k
            dwell += screw.breaker_edges * height // half
        if rested < dwell:
            return State(m, u, rested + 1, *cycles.values())
        if screw.breaker_edges:
            cycles[side] = (cycles[side] + 1) % screw.breaker_cycles
    pos = m >> 16
    if pos >= screw.reversal_plus_usteps:
        u -= screw.ka
    elif pos <= screw.reversal_minus_usteps:
        u += screw.ka
    return State(m + u, u, 0, *cycles.values())


@st.composite
def screws(draw: st.DrawFn) -> Screw:
    nr = draw(st.integers(1, 60))
    ka = draw(st.integers(1, (USTEP - 1) // nr))
    minus = draw(st.integers(-20, 5))
    return Screw(
        ka,
        nr,
        minus + draw(st.integers(2, 25)),
        minus,
        draw(st.sampled_from([0, 1, 7])),
        draw(st.sampled_from([0, 2, 5])),
        draw(st.sampled_from([0, 1, 40])),
        draw(st.integers(2, 7)),
    )


@settings(max_examples=60, deadline=None)
@given(screws(), st.integers(0, 10**6))
def test_equals_the_law_over_more_than_a_period(screw: Screw, offset: int):
    state = State(screw.sweep_begin + offset % (screw.sweep_end - screw.sweep_begin), screw.ks)
    orbit = screw.orbit(state)
    assume(orbit.period_edges < 20_000)
    start = state
    for edges in range(1, orbit.period_edges + 50):
        state = law_forward(screw, state)
        assert orbit.after(edges) == state
        # From here, the way back leads to the start: every state knows its phase.
        assert screw.orbit(state).after(-edges) == start


def test_the_prototype_after_a_billion_edges():
    orbit = PROTOTYPE.orbit(State(0, PROTOTYPE.ks))
    assert orbit.after(10**9 * orbit.period_edges) == State(0, PROTOTYPE.ks)
    assert PROTOTYPE.overshoot == PROTOTYPE.ks * (PROTOTYPE.nr - 1) // 2
    highest = max(orbit.state_at_phase(p).m for p in range(orbit.plus_at, orbit.down_at))
    assert highest == orbit.entry_plus + PROTOTYPE.overshoot


@pytest.mark.parametrize(
    "state",
    [
        State(0, PROTOTYPE.ks - 1),  # a slope that no edge makes
        State(0, 0),  # at rest in the sweep
        State(PROTOTYPE.sweep_end, -PROTOTYPE.ks),  # has left the reversal, and is still in it
        State(PROTOTYPE.sweep_end + 2 * PROTOTYPE.ks, PROTOTYPE.ks),  # entered too late
    ],
)
def test_a_state_off_the_orbit_is_refused(state: State):
    with pytest.raises(ValueError, match="not on an orbit"):
        PROTOTYPE.orbit(state)


def test_a_breaker_needs_two_cycles():
    with pytest.raises(ValueError, match="at least 2"):
        Screw(23, 1187, 8000, -8000, breaker_edges=5, breaker_cycles=1)


def test_a_screw_that_asks_for_two_steps_an_edge_is_refused():
    with pytest.raises(ValueError, match="65535"):
        Screw(66, 1000, 8000, -8000)
