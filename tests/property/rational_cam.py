# SPDX-License-Identifier: Apache-2.0
"""The cam in rational arithmetic, written from doc/cam.md and nothing else."""

from bisect import bisect
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import floor, inf

from hypothesis import strategies as st
from levelwind.cam.table import Scale, Table
from levelwind.map_table import CamInterpolation

STEPS_PER_EDGE_MAX = 4

# The application note's example. Its row number 10 stands twice there; the numbers mean nothing.
NOTE_ROWS = (
    (0, 0),
    (40_000, 1_500),
    (60_000, 0),
    (80_000, -50_000),
    (100_000, -50_000),
    (120_000, 0),
    (140_000, 4_000),
    (160_000, 4_000),
    (180_000, 1_350),
    (195_000, 0),
    (200_000, 0),
)


@dataclass(frozen=True)
class RationalCam:
    """A table as the set of rational positions that its interpolation means."""

    table: Table
    scale: Scale = field(default_factory=Scale)

    @property
    def cycle(self) -> int:
        """Length of a cycle in master units."""
        return self.table.rows[-1][0]

    def exact(self, edges: int) -> Fraction:
        """Position in microsteps after so many net edges from the begin of cycle 0."""
        cycles, in_cycle = divmod(edges * self.scale.master_units, self.cycle * self.scale.edges)
        master = Fraction(in_cycle, self.scale.edges)
        begin, slave, slope, curve = self._pieces[bisect(self._pieces, (master, inf)) - 1]
        into = master - begin
        slave += into * (slope + into * curve) if curve else into * slope
        usteps = (slave + cycles * self.table.advance) * self.scale.usteps
        return Fraction(usteps, self.scale.slave_units)

    def usteps(self, edges: int) -> int:
        """The same, rounded to the nearest whole one, halves up."""
        return floor(self.exact(edges) + Fraction(1, 2))

    @cached_property
    def _pieces(self) -> list[tuple[Fraction, Fraction, Fraction, Fraction]]:
        """Begin, and slave there, and the coefficients of the way from there, piece by piece."""
        pieces = []
        for (begin, slave), (end, next_slave) in pairwise(self.table.rows):
            length, way = Fraction(end - begin), Fraction(next_slave - slave)
            if self.table.interpolation == CamInterpolation.LINEAR:
                pieces.append((Fraction(begin), Fraction(slave), way / length, Fraction(0)))
                continue
            ramp = length / self.scale.ramp_divisor
            top = way / (length - ramp)  # the plateau and half of each ramp make the way
            curve = top / ramp / 2
            pieces.append((Fraction(begin), Fraction(slave), Fraction(0), curve))
            pieces.append((begin + ramp, slave + top * ramp / 2, top, Fraction(0)))
            pieces.append((end - ramp, next_slave - top * ramp / 2, top, -curve))
        return pieces


def fractions() -> st.SearchStrategy[tuple[int, int]]:
    """Scales, most of them simple."""
    part = st.integers(1, 20) | st.integers(1, 200)
    return st.just((1, 1)) | st.tuples(part, part)


@st.composite
def cams(draw: st.DrawFn) -> RationalCam:
    """Random tables that the core's rules allow, with random scales, as steep as it may be."""
    edges, master_units = draw(fractions())
    usteps, slave_units = draw(fractions())
    scale = Scale(edges, master_units, usteps, slave_units, draw(st.integers(2, 16)))
    interpolation = draw(st.sampled_from(CamInterpolation))
    steepest = STEPS_PER_EDGE_MAX * Fraction(edges * slave_units, master_units * usteps)
    if interpolation == CamInterpolation.TRAPEZOID:
        steepest *= 1 - Fraction(1, scale.ramp_divisor)
    rows = [(0, draw(st.integers(-1000, 1000)))]
    for _ in range(draw(st.integers(1, 8))):
        row_edges = 1 + draw(st.integers(0, 3) | st.integers(0, 300))
        length = -(-row_edges * master_units // edges)
        most = floor(steepest * length)
        slave = draw(st.integers(-most, most) | st.sampled_from((-most, 0, most)))
        rows.append((rows[-1][0] + length, rows[-1][1] + slave))
    table = Table(tuple(rows), interpolation, rows[-1][1] - rows[0][1])
    return RationalCam(table, scale)
