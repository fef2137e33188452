# SPDX-License-Identifier: Apache-2.0
"""What a cam table asks of the machine, in numbers and in a picture."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

from levelwind.cam.table import Cam, Limits, Scale, Statistics, Table, check
from levelwind.map_table import CamInterpolation

# Where the application note QCI-AN029 gives a number, it is the note's.
RATIO_MAX = 3.0
RATIO_MIN = 0.01
ROW_EDGES_MIN = 5
RATIO_CHANGE_MAX = 0.1
STEPS_PER_EDGE_MAX = 4
PLOT_POINTS = 20_000


@dataclass(frozen=True)
class Piece:
    """A part of a row in which the gear ratio (microsteps per edge) changes evenly."""

    row: int
    begin_edges: float
    end_edges: float
    begin_ratio: float
    end_ratio: float

    @property
    def acceleration(self) -> float:
        """Microsteps per edge per edge."""
        return (self.end_ratio - self.begin_ratio) / (self.end_edges - self.begin_edges)


def pieces(table: Table, scale: Scale) -> Iterator[Piece]:
    """All pieces of a cycle."""
    per_master = scale.edges / scale.master_units
    per_slave = scale.usteps / scale.slave_units
    for number, ((begin, slave), (end, next_slave)) in enumerate(pairwise(table.rows), 1):
        a, b = begin * per_master, end * per_master
        ratio = (next_slave - slave) * per_slave / (b - a)
        if table.interpolation == CamInterpolation.LINEAR:
            yield Piece(number, a, b, ratio, ratio)
            continue
        ramp = (b - a) / scale.ramp_divisor
        top = ratio / (1 - 1 / scale.ramp_divisor)
        yield Piece(number, a, a + ramp, 0, top)
        yield Piece(number, a + ramp, b - ramp, top, top)
        yield Piece(number, b - ramp, b, top, 0)


@dataclass(frozen=True)
class Report:
    """An accepted table with everything that is to be said about it."""

    table: Table
    scale: Scale
    limits: Limits
    statistics: Statistics
    warnings: list[str]

    def document(self) -> dict[str, object]:
        """For --json."""
        return {
            "name": self.table.name,
            "rows": len(self.table.rows),
            "interpolation": self.table.interpolation.label,
            "advance": self.table.advance,
            **asdict(self.statistics),
            "steps_per_s_at_top_edge_rate": self.steps_per_s,
            "warnings": self.warnings,
        }

    @property
    def steps_per_s(self) -> int:
        """Fastest pulse rate at the top edge rate."""
        return self.statistics.slope_max_permille * self.limits.top_edges_per_s // 1000

    def lines(self) -> list[tuple[str, str, str, str]]:
        """For the table on the screen."""
        s = self.statistics
        kind = "cyclic" if self.table.advance == 0 else f"advances {self.table.advance} per cycle"
        return [
            ("rows", str(len(self.table.rows)), "", self.table.interpolation.label),
            ("cycle", str(s.cycle_edges), "edges", kind),
            ("lowest", str(s.min_usteps), "usteps", ""),
            ("highest", str(s.max_usteps), "usteps", ""),
            (
                "steepest",
                f"{s.slope_max_permille / 1000:.3f}",
                "steps/edge",
                f"from row {s.slope_max_row}, limit {STEPS_PER_EDGE_MAX}",
            ),
            (
                "step rate",
                str(self.steps_per_s),
                "steps/s",
                f"at {self.limits.top_edges_per_s} edges/s, limit {self.limits.steps_per_s_max}",
            ),
        ]


def report(table: Table, scale: Scale, limits: Limits) -> Report:
    """Check a table; CamRefusedError if the core refuses it."""
    statistics = check(table, scale, limits)
    return Report(table, scale, limits, statistics, list(_warnings(table, scale, limits)))


def _warnings(table: Table, scale: Scale, limits: Limits) -> Iterator[str]:
    parts = list(pieces(table, scale))
    top = limits.top_edges_per_s

    # From the last row back to the first too: the table goes round.
    jumps = [(abs(b.begin_ratio - a.end_ratio), b.row) for a, b in pairwise([*parts, parts[0]])]
    jump, row = max(jumps)
    if jump > RATIO_CHANGE_MAX:
        yield (
            f"Smoothness: at row {row} the gear ratio changes by {jump:.3f} microsteps per edge at "
            f"once, {jump * top:.0f} steps/s at {top} edges/s; recommended {RATIO_CHANGE_MAX:g}. "
            "More rows around it, or trapezoid rows."
        )
    fastest = max(parts, key=lambda part: max(abs(part.begin_ratio), abs(part.end_ratio)))
    ratio = max(abs(fastest.begin_ratio), abs(fastest.end_ratio))
    if ratio > RATIO_MAX:
        yield (
            f"Ratio: from row {fastest.row} the slave is {ratio:.3f} times as fast as the master; "
            f"recommended {RATIO_MAX:g}. A finer encoder, or coarser microsteps."
        )
    per_master = scale.edges / scale.master_units
    rows = [
        ((end[0] - begin[0]) * per_master, abs(end[1] - begin[1]), number)
        for number, (begin, end) in enumerate(pairwise(table.rows), 1)
    ]
    trapezoid = table.interpolation == CamInterpolation.TRAPEZOID
    edges_min = max(ROW_EDGES_MIN, scale.ramp_divisor if trapezoid else 0)
    edges, _, row = min(rows)
    if edges < edges_min:
        yield (
            f"Spacing: from row {row} to the next are {edges:.1f} edges, {edges / top * 1e6:.0f} "
            f"us at {top} edges/s; recommended {edges_min} edges, {edges_min / top * 1e6:.0f} us."
        )
    moving = [
        (way * scale.usteps / scale.slave_units / edges, number)
        for edges, way, number in rows
        if way != 0
    ]
    if moving and min(moving)[0] < RATIO_MIN:
        ratio, row = min(moving)
        yield (
            f"Smallest ratio: from row {row} the slave moves one microstep in {1 / ratio:.0f} "
            f"edges; recommended {1 / RATIO_MIN:.0f} at the most. The position is exact, the "
            "motion is single steps."
        )


def plot(result: Report, path: Path) -> None:
    """Slave position, gear ratio and acceleration over a cycle, with the limits."""
    from levelwind.show.plots import new_figure, save  # noqa: PLC0415 - matplotlib takes a second

    table, scale, limits = result.table, result.scale, result.limits
    parts = list(pieces(table, scale))
    cycle = result.statistics.cycle_edges
    _, trace, stride = Cam(table, scale).run([cycle], PLOT_POINTS)
    figure = new_figure(11, 9)
    position, ratio, acceleration = figure.subplots(3, 1, sharex=True)

    per_master, per_slave = scale.edges / scale.master_units, scale.usteps / scale.slave_units
    position.plot([i * stride for i in range(len(trace))], trace, color="tab:blue")
    position.plot(
        [master * per_master for master, _ in table.rows],
        [slave * per_slave for _, slave in table.rows],
        "o",
        color="tab:blue",
        markersize=4,
        label="rows",
    )
    position.set_ylabel("slave, microsteps")
    kind = "cyclic" if table.advance == 0 else f"advances {table.advance} per cycle"
    position.set_title(
        f"{table.name or 'cam table'}: {len(table.rows)} rows, {table.interpolation.label}, {kind}",
        parse_math=False,  # a name may have $ in it
    )

    edges = [edge for part in parts for edge in (part.begin_edges, part.end_edges)]
    ratio.plot(edges, [r for p in parts for r in (p.begin_ratio, p.end_ratio)], color="tab:green")
    by_rate = limits.steps_per_s_max / limits.top_edges_per_s
    lines = (
        (STEPS_PER_EDGE_MAX, "-", f"limit: {STEPS_PER_EDGE_MAX} steps per edge"),
        (by_rate, "--", f"limit: {limits.steps_per_s_max} steps/s at {limits.top_edges_per_s}"),
        (RATIO_MAX, ":", f"recommended: {RATIO_MAX:g}"),
    )
    for value, style, label in lines:
        ratio.axhline(value, color="tab:red", linestyle=style, linewidth=0.9, label=label)
        ratio.axhline(-value, color="tab:red", linestyle=style, linewidth=0.9)
    ratio.set_ylabel("gear ratio, microsteps/edge")

    jumps = [
        (b.begin_edges, b.begin_ratio - a.end_ratio)
        for a, b in pairwise(parts)
        if b.begin_ratio != a.end_ratio
    ]
    wrap = parts[0].begin_ratio - parts[-1].end_ratio
    if wrap:
        jumps.append((cycle, wrap))
    if jumps:
        acceleration.stem(
            [edge for edge, _ in jumps], [jump for _, jump in jumps], basefmt=" ",
            linefmt="tab:orange", label="at once, microsteps/edge",
        )  # fmt: skip
        for value in (RATIO_CHANGE_MAX, -RATIO_CHANGE_MAX):
            acceleration.axhline(value, color="tab:red", linestyle=":", linewidth=0.9)
    if any(part.acceleration for part in parts):
        acceleration.plot(
            edges, [p.acceleration for p in parts for _ in range(2)], color="tab:purple",
            label="in the ramps, microsteps/edge²",
        )  # fmt: skip
    acceleration.set_ylabel("acceleration per master edge")
    acceleration.set_xlabel("master, edges")
    for axes in (position, ratio, acceleration):
        axes.grid(alpha=0.3)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="upper right", fontsize="small")
    save(figure, path)
