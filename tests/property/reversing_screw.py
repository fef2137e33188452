# SPDX-License-Identifier: Apache-2.0
"""The control law in Python, edge by edge, written from doc/control-law.md and nothing else.

Integers here have no size; every edge checks that the compiled law's fit into 32 bits.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from hypothesis import strategies as st

USTEP = 65536
REACH_MAX_USTEPS = 32_000


@dataclass(frozen=True)
class Pattern:
    """What defines a pattern. L+ and L- in microsteps, the slopes in Q16.16."""

    ka: int
    nr: int
    plus: int
    minus: int
    dwell_plus: int = 0
    dwell_minus: int = 0
    breaker: int = 0
    cycles: int = 0

    @property
    def ks(self) -> int:
        """Slope in the sweep."""
        return self.ka * self.nr

    @property
    def overshoot(self) -> int:
        """P5: how far a reversal runs past its entry."""
        return self.ks * (self.nr - 1) // 2

    @property
    def begin(self) -> int:
        """First position of the sweep."""
        return (self.minus + 1) * USTEP

    @property
    def end(self) -> int:
        """First position past the sweep."""
        return self.plus * USTEP

    def region(self, m: int) -> int:
        """-1 in the reversal at plus, +1 in the reversal at minus, 0 in the sweep."""
        if m >> 16 >= self.plus:
            return -1
        return 1 if m >> 16 <= self.minus else 0

    def setup(self, m: int, u: int) -> dict[str, int]:
        """For levelwind.core.native.replay."""
        return {
            "ka": self.ka,
            "nr": self.nr,
            "lplus_usteps": self.plus,
            "lminus_usteps": self.minus,
            "m": m,
            "u": u,
            "dwell_plus_edges": self.dwell_plus,
            "dwell_minus_edges": self.dwell_minus,
            "breaker_edges": self.breaker,
            "breaker_cycles": self.cycles,
        }

    def dwell(self, at_plus: bool, passed: int) -> int:
        """The dwell at a far point of a side, of which so many have been passed, net."""
        steps = passed % self.cycles if self.cycles else 0
        steps = min(steps, self.cycles - steps)
        adds = self.breaker * steps // (self.cycles // 2) if self.breaker else 0
        return (self.dwell_plus if at_plus else self.dwell_minus) + adds


@dataclass
class Model:
    """A state of the law, and the positions that it was at before every edge."""

    pattern: Pattern
    m: int
    u: int
    rested: int = 0
    passed: dict[bool, int] = field(default_factory=lambda: {True: 0, False: 0})
    """Far points that lie behind, at plus (True) and at minus: counted without end."""
    positions: list[int] = field(default_factory=list)
    steps: list[int] = field(default_factory=list)

    def run(self, runs: Iterable[int]) -> "Model":
        """Runs of edges, negative for backward."""
        for run in runs:
            edge = self._forward if run > 0 else self._backward
            for _ in range(abs(run)):
                before = self.m >> 16
                edge()
                assert -(2**31) <= self.m < 2**31, "P8"
                assert abs(self.u) <= 65535
                self.positions.append(before)
                self.steps.append((self.m >> 16) - before)
        return self

    def _dwell(self) -> int:
        at_plus = self.m >= self.pattern.end
        return self.pattern.dwell(at_plus, self.passed[at_plus])

    def _forward(self) -> None:
        if self.u == 0 and self.pattern.region(self.m) != 0:
            if self.rested < self._dwell():
                self.rested += 1
                return
            self.passed[self.m >= self.pattern.end] += 1
        self.rested = 0
        self.u += self.pattern.region(self.m) * self.pattern.ka
        self.m += self.u

    def _backward(self) -> None:
        if self.u == 0 and self.rested > 0:
            self.rested -= 1
            return
        self.m -= self.u
        self.u -= self.pattern.region(self.m) * self.pattern.ka
        if self.u == 0 and self.pattern.region(self.m) != 0:
            self.passed[self.m >= self.pattern.end] -= 1
            self.rested = self._dwell()

    def cycle(self, at_plus: bool) -> int:
        """The number of the cycle that the compiled law keeps."""
        return self.passed[at_plus] % self.pattern.cycles if self.pattern.breaker else 0


def paper_diagram(pattern: Pattern, m: int, u: int, edges: int) -> tuple[list[int], list[int]]:
    """The paper's block diagram for a drum that only hauls in: positions and slopes per edge.

    Differentiator of dd, upper multiplexor by the comparators, lower multiplexor by their OR,
    Velocity integrator, Position integrator; registers change together at the end of an interrupt.
    """
    positions, slopes = [], []
    dd = dd_before = 1
    for _ in range(edges):
        pos = m >> 16
        in_plus, in_minus = pos >= pattern.plus, pos <= pattern.minus
        upper_mux = -1 if in_plus else 1
        sweep_input = (dd - dd_before) * pattern.ks
        increment = dd * upper_mux * pattern.ka if in_plus or in_minus else sweep_input
        u = u + increment
        m = m + u
        dd_before = dd
        positions.append(pos)
        slopes.append(u)
    return positions, slopes


@st.composite
def patterns(draw: st.DrawFn, dwell: bool = False) -> Pattern:
    """Any pattern that the range of a position has room for; small windows, so that it reverses."""
    nr = draw(st.one_of(st.integers(1, 12), st.integers(1, 700)))
    ka = draw(st.one_of(st.integers(1, 65535 // nr), st.just(65535 // nr)))
    reach = ka * nr * (nr - 1) // 2 // USTEP + 2
    width = draw(st.integers(2, 60))
    minus = draw(st.integers(reach - REACH_MAX_USTEPS, REACH_MAX_USTEPS - reach - width))
    result = Pattern(ka, nr, minus + width, minus)
    if dwell:
        dwells = st.one_of(st.just(0), st.integers(1, 300))
        result = replace(result, dwell_plus=draw(dwells), dwell_minus=draw(dwells))
        if draw(st.booleans()):
            cycles = draw(st.integers(2, 9))
            result = replace(result, breaker=draw(st.integers(1, 400)), cycles=cycles)
    return result


@st.composite
def sweep_states(draw: st.DrawFn, pattern: Pattern) -> tuple[int, int]:
    """Any (m, u) in the sweep of a pattern."""
    m = draw(st.integers(pattern.begin, pattern.end - 1))
    return m, draw(st.sampled_from((pattern.ks, -pattern.ks)))


def motions(edges_max: int = 4000, runs_max: int = 12) -> st.SearchStrategy[list[int]]:
    """Drum motion: runs of edges either way, long ones and dither."""
    lengths = st.one_of(st.integers(1, 3), st.integers(1, edges_max))
    run = st.builds(lambda length, sign: length * sign, lengths, st.sampled_from((1, -1)))
    return st.lists(run, min_size=1, max_size=runs_max)
