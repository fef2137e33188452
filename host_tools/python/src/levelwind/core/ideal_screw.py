# SPDX-License-Identifier: Apache-2.0
"""The ideal reversing screw: where the carriage is after any number of net drum edges.

A closed form of the control law, written independently of the compiled core so that the two can
judge each other. The pattern is a closed orbit in net edges,

    N sweep edges up, 2 Nr + dwell plus, N sweep edges down, 2 Nr + dwell minus,

so a state is a phase on the orbit, and going on by any number of edges, forward or backward, is an
addition modulo the period. A ribbon breaker lengthens the dwells by cycle: then the period is that
of all its cycles. Integers only; positions and slopes are Q16.16 microsteps.
"""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate

USTEP = 65536


@dataclass(frozen=True)
class State:
    """A state of the law."""

    m: int
    u: int
    dwell_edges: int = 0  # edges rested at the far point of a reversal
    cycle_plus: int = 0  # far points passed at plus, modulo breaker_cycles
    cycle_minus: int = 0

    @property
    def pos_usteps(self) -> int:
        """Whole microsteps, rounded toward minus infinity."""
        return self.m >> 16


@dataclass(frozen=True)
class Screw:
    """The numbers that define a pattern."""

    ka: int
    nr: int
    reversal_plus_usteps: int
    reversal_minus_usteps: int
    dwell_plus_edges: int = 0
    dwell_minus_edges: int = 0
    breaker_edges: int = 0
    breaker_cycles: int = 0

    def __post_init__(self) -> None:
        if not (self.ka >= 1 and self.nr >= 1 and self.ks < USTEP):
            raise ValueError(f"Ka {self.ka}, Nr {self.nr}: needs Ka, Nr >= 1 and Ka * Nr <= 65535")
        if self.reversal_plus_usteps - self.reversal_minus_usteps < 2:
            raise ValueError("L+ must lie at least 2 microsteps above L-")
        if self.breaker_edges and self.breaker_cycles < 2:
            raise ValueError(f"breaker_cycles is {self.breaker_cycles}: needs at least 2")

    @property
    def ks(self) -> int:
        """Slope in the sweep, Q16.16."""
        return self.ka * self.nr

    @property
    def sweep_begin(self) -> int:
        """First position of the sweep, Q16.16."""
        return (self.reversal_minus_usteps + 1) * USTEP

    @property
    def sweep_end(self) -> int:
        """First position past the sweep, Q16.16."""
        return self.reversal_plus_usteps * USTEP

    @property
    def overshoot(self) -> int:
        """How far a reversal runs past its entry point, Q16.16."""
        return self.rise(self.nr)

    def rise(self, j: int) -> int:
        """Distance past the entry point, j edges into a reversal, Q16.16."""
        return self.ka * j * (2 * self.nr - 1 - j) // 2

    @property
    def cycles(self) -> int:
        """Double traverses until the pattern comes back."""
        return self.breaker_cycles if self.breaker_edges else 1

    def breaker(self, cycle: int) -> int:
        """What the ribbon breaker adds to a dwell: up, and down again."""
        if not self.breaker_edges:
            return 0
        steps = min(cycle % self.breaker_cycles, -cycle % self.breaker_cycles)
        return self.breaker_edges * steps // (self.breaker_cycles // 2)

    def orbit(self, state: State) -> "Orbit":
        """The closed orbit that a state is on; ValueError if it is on none."""
        return Orbit(self, state)


class Orbit:
    """One closed orbit of a screw, and where on it the state is that it was made from."""

    def __init__(self, screw: Screw, state: State) -> None:
        self.screw = screw
        ks = screw.ks
        point = self._lattice_point(state)
        if point is None:
            raise ValueError(f"m {state.m}, u {state.u} is not on an orbit of {screw}")
        # Sweep positions are congruent modulo Ks; so are the entries of both reversals.
        self.first_up = screw.sweep_begin + (point - screw.sweep_begin) % ks
        self.sweep_edges = -((self.first_up - screw.sweep_end) // ks)  # states in [begin, end)
        self.entry_plus = self.first_up + self.sweep_edges * ks
        self.entry_minus = self.first_up - ks
        # Cycle c begins with the sweep up. Its far points have these numbers more than c: one that
        # has been passed when the state is, is one less than what is counted.
        passed_plus, passed_minus = self._passed(state)
        self._number_plus = state.cycle_plus - passed_plus
        self._number_minus = state.cycle_minus - passed_minus
        self._begins = [0, *accumulate(self._cycle_edges(c) for c in range(screw.cycles))]
        self.period_edges = self._begins[-1]
        self.plus_at = self.sweep_edges
        self.down_at = self.plus_at + 2 * screw.nr + self._dwell_plus(0)
        self.minus_at = self.down_at + self.sweep_edges
        self.phase = self._phase_of(state)
        if self.state_at_phase(self.phase) != state:
            raise ValueError(f"m {state.m}, u {state.u} is not on an orbit of {screw}")

    def _passed(self, state: State) -> tuple[int, int]:
        """Which far points of its cycle lie behind a state: 1 or 0, plus and minus."""
        side = self._side(state.m)
        if side == 0:
            return int(state.u < 0), 0
        return int(side < 0 or state.u < 0), int(side < 0 and state.u > 0)

    def _dwell_plus(self, cycle: int) -> int:
        return self.screw.dwell_plus_edges + self.screw.breaker(self._number_plus + cycle)

    def _dwell_minus(self, cycle: int) -> int:
        return self.screw.dwell_minus_edges + self.screw.breaker(self._number_minus + cycle)

    def _cycle_edges(self, cycle: int) -> int:
        moving = 2 * self.sweep_edges + 4 * self.screw.nr
        return moving + self._dwell_plus(cycle) + self._dwell_minus(cycle)

    def _lattice_point(self, state: State) -> int | None:
        """A position congruent to the orbit's sweep positions; None if u fits no orbit."""
        screw = self.screw
        side = self._side(state.m)
        if side == 0:
            return state.m if abs(state.u) == screw.ks else None
        j, rest = divmod(screw.ks - side * state.u, screw.ka)
        return state.m - side * screw.rise(j) if rest == 0 and 0 <= j < 2 * screw.nr else None

    def _side(self, m: int) -> int:
        """+1 in the reversal at plus, -1 in the one at minus, 0 in the sweep."""
        return (m >= self.screw.sweep_end) - (m < self.screw.sweep_begin)

    def _phase_of(self, state: State) -> int:
        screw = self.screw
        ks = screw.ks
        side = self._side(state.m)
        if side == 0:
            k = (state.m - self.first_up) // ks
            return k if state.u > 0 else self.minus_at - 1 - k
        j = (ks - side * state.u) // screw.ka
        begin, dwell = (
            (self.plus_at, self._dwell_plus(0))
            if side > 0
            else (self.minus_at, self._dwell_minus(0))
        )
        if j < screw.nr:
            return begin + j
        return begin + j + (state.dwell_edges if j == screw.nr else dwell)

    def after(self, net_edges: int) -> State:
        """The state after so many net edges, negative for backward."""
        return self.state_at_phase((self.phase + net_edges) % self.period_edges)

    def state_at_phase(self, phase: int) -> State:
        """The state at a place on the orbit, 0 <= phase < period_edges."""
        screw = self.screw
        ks = screw.ks
        cycle = bisect_right(self._begins, phase) - 1
        in_cycle = phase - self._begins[cycle]
        plus, minus = (
            number % screw.cycles
            for number in (self._number_plus + cycle, self._number_minus + cycle)
        )
        if in_cycle < self.plus_at:
            return State(self.first_up + in_cycle * ks, ks, 0, plus, minus)
        dwell = self._dwell_plus(cycle)
        down_at = self.plus_at + 2 * screw.nr + dwell
        past = (plus + 1) % screw.cycles
        if in_cycle < down_at:
            j, rested = _unrest(in_cycle - self.plus_at, screw.nr, dwell)
            m, u = self.entry_plus + screw.rise(j), ks - j * screw.ka
            return State(m, u, rested, past if j > screw.nr else plus, minus)
        if in_cycle < down_at + self.sweep_edges:
            k = self.sweep_edges - 1 - (in_cycle - down_at)
            return State(self.first_up + k * ks, -ks, 0, past, minus)
        j, rested = _unrest(
            in_cycle - down_at - self.sweep_edges, screw.nr, self._dwell_minus(cycle)
        )
        m, u = self.entry_minus - screw.rise(j), j * screw.ka - ks
        return State(m, u, rested, past, (minus + 1) % screw.cycles if j > screw.nr else minus)


def _unrest(edges: int, nr: int, dwell: int) -> tuple[int, int]:
    """Edges since a reversal's entry as (edges that moved, edges rested at the far point)."""
    if edges < nr:
        return edges, 0
    rested = min(edges - nr, dwell)
    return edges - rested, rested if edges - rested == nr else 0
