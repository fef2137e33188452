# SPDX-License-Identifier: Apache-2.0
"""The cam table of a level-wind law."""

from dataclasses import replace
from math import ceil, isqrt

from levelwind.cam.table import ROWS_MAX
from levelwind.core.ideal_screw import USTEP, Screw, State
from levelwind.errors import ToolError

# How far a straight row may cut a reversal's parabola, in microsteps. With half a microstep of
# rounding at the rows this keeps the cam within one microstep of the law.
CHORD_MAX_USTEPS = 0.25


def rows(screw: Screw) -> tuple[tuple[int, int], ...]:
    """One period of the pattern from the minus side's end of the sweep, linear between rows.

    Without its ribbon breaker, which a cam does not have.
    """
    screw = replace(screw, breaker_edges=0)
    orbit = screw.orbit(State(screw.sweep_begin, screw.ks))
    chord_edges = max(1, isqrt(int(8 * CHORD_MAX_USTEPS * USTEP / screw.ka)))
    at = {0, orbit.period_edges}
    for begin, end, dwell in (
        (orbit.plus_at, orbit.down_at, screw.dwell_plus_edges),
        (orbit.minus_at, orbit.period_edges, screw.dwell_minus_edges),
    ):
        rest = begin + screw.nr
        for first, last in ((begin, rest), (rest + dwell, end)):
            count = ceil((last - first) / chord_edges)
            at |= {first + (last - first) * i // count for i in range(count + 1)}
    if len(at) > ROWS_MAX:
        raise ToolError(
            f"The law needs {len(at)} rows, limit {ROWS_MAX}: shorter reversals "
            "(overshoot_um) need fewer."
        )
    # The cam rounds to nearest, the law rounds down: at a row both are at the same microstep.
    return tuple((edge, orbit.after(edge).m // USTEP) for edge in sorted(at))
