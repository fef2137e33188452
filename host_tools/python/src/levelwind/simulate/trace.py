# SPDX-License-Identifier: Apache-2.0
"""The simulator's trace of a launch, and what it says about the pattern."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from levelwind.core.ideal_screw import USTEP, Screw, State
from levelwind.errors import ToolError
from levelwind.map_table import Flag
from levelwind.map_table import State as ControllerState

INTEGERS = ("time_ms", "state", "net_edges", "pattern_edges", "m", "u", "steps", "flags")


@dataclass(frozen=True)
class Trace:
    """Columns of a trace, one line per millisecond of virtual time in which something moved."""

    columns: dict[str, np.ndarray]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]

    def __len__(self) -> int:
        return len(self["time_ms"])

    def rows(self, chosen: np.ndarray) -> "Trace":
        """Only some lines."""
        return Trace({name: column[chosen] for name, column in self.columns.items()})

    def tracking(self) -> "Trace":
        """The lines of the last hand-over to the drum and after it."""
        follows = self["state"] == ControllerState.TRACKING
        starts = np.flatnonzero(follows & ~np.concatenate(([False], follows[:-1])))
        if len(starts) == 0:
            raise ToolError("The trace never follows the drum.")
        follows[: starts[-1]] = False
        return self.rows(follows)

    def flag(self, bit: Flag) -> np.ndarray:
        """One flag over time."""
        return (self["flags"] >> bit & 1).astype(bool)


def read(path: Path) -> Trace:
    """A trace that `lw_sim --trace` wrote."""
    try:
        table: Any = np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, dtype=np.float64))
    except (OSError, ValueError) as error:
        raise ToolError(f"{path}: {error}.") from error
    if not table.size:
        raise ToolError(f"{path} is empty: nothing has moved.")
    # A double holds every integer of a trace exactly.
    names = table.dtype.names or ()
    return Trace({n: table[n].astype(np.int64) if n in INTEGERS else table[n] for n in names})


@dataclass(frozen=True)
class Pattern:
    """What the tracked part of a trace did, against the ideal screw.

    The overshoot is that past reversal_plus, as far as one line per millisecond shows its top.
    """

    rows: int
    largest_error_q16: int
    reversals: int
    overshoot_q16: int
    overshoot_predicted_q16: int
    forward_edges: int
    backward_edges: int


def judge(tracked: Trace, screw: Screw) -> Pattern:
    """Compare every line with the ideal screw that starts at the first moving line."""
    edges, m, u = (tracked[name].tolist() for name in ("pattern_edges", "m", "u"))
    # At a far point a trace does not tell how much of a dwell has passed: start beside it.
    start = next((i for i, slope in enumerate(u) if slope != 0), None)
    if start is None:
        raise ToolError("The drum never moved while it was followed.")
    orbit = screw.orbit(State(m[start], u[start]))
    largest = 0
    for edge, position, slope in zip(edges, m, u, strict=True):
        ideal = orbit.after(edge - edges[start])
        wrong_slope = USTEP if ideal.u != slope else 0
        largest = max(largest, abs(ideal.m - position) + wrong_slope)
    moved = np.diff(tracked["pattern_edges"])
    return Pattern(
        rows=len(tracked),
        largest_error_q16=largest,
        reversals=int(turns(tracked).sum()),
        overshoot_q16=max(m) - orbit.entry_plus,
        overshoot_predicted_q16=screw.overshoot,
        forward_edges=int(moved[moved > 0].sum()),
        backward_edges=int(-moved[moved < 0].sum()),
    )


def turns(tracked: Trace) -> np.ndarray:
    """True for lines in which the slope has changed its sign since the one before."""
    signs = np.sign(tracked["u"])
    known = np.flatnonzero(signs)
    changed = np.zeros(len(tracked), dtype=bool)
    changed[known[1:]] = np.diff(signs[known]) != 0
    return changed
