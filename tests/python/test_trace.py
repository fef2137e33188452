# SPDX-License-Identifier: Apache-2.0
"""Judging a trace against the ideal screw."""

from pathlib import Path

import pytest
from levelwind.core.ideal_screw import Screw, State
from levelwind.errors import ToolError
from levelwind.simulate import trace

SCREW = Screw(23, 1187, 8000, -8000)
HEADER = "time_ms,state,net_edges,pattern_edges,m,u,steps,carriage_um,drum_millirpm,flags\n"
# Forward over two reversals, then backward over one of them.
EDGES = [*range(0, 90_000, 25), *range(90_000, 40_000, -25)]


def written(folder: Path, edges: list[int], spoil_m: int = 0, spoil_u: int = 0) -> Path:
    orbit = SCREW.orbit(State(0, SCREW.ks))
    lines = ["0,2,0,0,5,0,0,0.0,0,0\n"]  # indexing: not judged
    for time_ms, edge in enumerate(edges, 1):
        state = orbit.after(edge)
        spoiled = time_ms == len(edges) // 2
        m = state.m + spoiled * spoil_m
        u = state.u + spoiled * spoil_u
        lines.append(f"{time_ms},7,{edge},{edge},{m},{u},0,0.0,0,5\n")
    path = folder / "trace.csv"
    path.write_text(HEADER + "".join(lines), encoding="utf-8")
    return path


def test_an_ideal_trace_has_no_error(tmp_path: Path):
    tracked = trace.read(written(tmp_path, EDGES)).tracking()
    pattern = trace.judge(tracked, SCREW)
    assert pattern.rows == len(EDGES)
    assert pattern.largest_error_q16 == 0
    assert (pattern.forward_edges, pattern.backward_edges) == (89_975 + 25, 49_975)
    assert pattern.reversals == 3
    assert pattern.overshoot_q16 == pytest.approx(SCREW.overshoot, rel=1e-4)


@pytest.mark.parametrize("spoil", [{"spoil_m": 1}, {"spoil_u": 1}])
def test_one_wrong_bit_shows(tmp_path: Path, spoil: dict[str, int]):
    tracked = trace.read(written(tmp_path, EDGES, **spoil)).tracking()
    assert trace.judge(tracked, SCREW).largest_error_q16 > 0


def test_a_trace_without_tracking_is_told(tmp_path: Path):
    with pytest.raises(ToolError, match="never follows"):
        trace.read(written(tmp_path, [])).tracking()
