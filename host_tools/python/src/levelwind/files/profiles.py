# SPDX-License-Identifier: Apache-2.0
"""Drum speed profiles: tables of rope, motor or drum speed over time; CSV, text or XLSX."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from levelwind.errors import ToolError
from levelwind.files import tables
from levelwind.map_table import POINTS

POINTS_MAX = 8192  # what the simulated plant holds
SPEED_LIMIT_MILLIRPM = -(POINTS["bench_profile"].min or 0)
TIME_LIMIT_MS = POINTS["bench_profile"].max or 0
TIME_COLUMNS = ("time_s", "time")
SPEED_COLUMNS = ("rope_m_per_s", "drum_rpm", "motor_rpm", "edges_per_s")
MOTOR_PER_ENCODER = 1.5

Profile = list[tuple[int, int]]  # time_ms, drum_millirpm


@dataclass(frozen=True)
class Gearing:
    """How speeds of other parts convert to drum speed."""

    rope_per_drum_rev_um: int
    edges_per_1000_drum_revs: int
    encoder_revs_per_drum_rev: float
    motor_revs_per_encoder_rev: float = MOTOR_PER_ENCODER

    def drum_rpm(self, column: str) -> Callable[[float], float]:
        """The conversion of a column's values."""
        return {
            "drum_rpm": lambda rpm: rpm,
            "rope_m_per_s": lambda v: v * 60e6 / self.rope_per_drum_rev_um,
            "edges_per_s": lambda rate: rate * 60e3 / self.edges_per_1000_drum_revs,
            "motor_rpm": lambda rpm: (
                rpm / self.motor_revs_per_encoder_rev / self.encoder_revs_per_drum_rev
            ),
        }[column]


def find(name: str) -> Path:
    """A file of profiles/: of this folder, of the source tree, or of the installed tool."""
    for folder in (Path.cwd(), *Path(__file__).resolve().parents):
        path = folder / "profiles" / name
        if path.is_file():
            return path
    raise ToolError(f"profiles/{name} is missing: install the tool again, or run in its source.")


def read(path: Path, gearing: Gearing) -> Profile:
    """Drum speed points of a table, beginning at 0 ms, at most one a millisecond."""
    table = tables.read(path)
    time_column, speed_column, unit = _columns(table)
    times_s = table.real_numbers(time_column)
    speeds = table.real_numbers(speed_column)
    convert = gearing.drum_rpm(unit)
    profile: Profile = []
    for i, (row, time_s, speed) in enumerate(zip(table.rows, times_s, speeds, strict=True)):
        if i and time_s <= times_s[i - 1]:
            raise ToolError(
                f"{table.place(row, time_column)}: time {time_s} s does not come after "
                f"{times_s[i - 1]} s: each line must be later than the one before."
            )
        time_ms = round((time_s - times_s[0]) * 1000)
        if time_ms > TIME_LIMIT_MS:
            raise ToolError(
                f"{table.place(row, time_column)}: {time_s} is {time_ms / 1000:.0f} s after the "
                f"first line, limit {TIME_LIMIT_MS / 1000:.0f} s. Are these seconds?"
            )
        millirpm = convert(speed) * 1000
        if abs(millirpm) > SPEED_LIMIT_MILLIRPM:
            raise ToolError(
                f"{table.place(row, speed_column)}: {speed:g} is {millirpm / 1000:.0f} drum "
                f"revolutions a minute, limit {SPEED_LIMIT_MILLIRPM / 1000:.0f}."
            )
        if not profile or time_ms > profile[-1][0]:
            profile.append((time_ms, round(millirpm)))
    if len(profile) < 2:
        raise ToolError(f"{path}: a profile has at least two points.")
    return thin(profile)


def _columns(table: tables.Table) -> tuple[int, int, str]:
    """Where the time and the speed stand, and what the speed is of."""
    for heading in table.headings:
        names = [str(cell).casefold() for cell in heading.cells]
        times = [name for name in TIME_COLUMNS if name in names]
        speeds = [name for name in names if name in SPEED_COLUMNS]
        if not times and not speeds:
            continue
        if times and len(speeds) == 1 and names.count(times[0]) == 1:
            _check_width(table, heading)
            return names.index(times[0]), names.index(speeds[0]), speeds[0]
        break
    else:
        heading = next(iter((*table.headings, *table.rows)), tables.Row(1, ()))
    named = ", ".join(map(str, heading.cells))
    raise ToolError(
        f"{table.place(heading)}: the heading must name the columns time_s and one of "
        f"{', '.join(SPEED_COLUMNS)}; it names {named or 'nothing'}."
    )


def _check_width(table: tables.Table, heading: tables.Row) -> None:
    """A line with more cells than names is one whose cells nobody can tell apart."""
    for row in table.rows:
        if len(row.cells) > len(heading.cells):
            raise ToolError(
                f"{table.place(row)}: {len(row.cells)} cells, but the heading names "
                f"{len(heading.cells)} columns. Is there a decimal comma between commas?"
            )


def thin(profile: Profile, limit: int = POINTS_MAX) -> Profile:
    """Every n-th point and the last, so that they fit; unchanged if they do."""
    if len(profile) <= limit:
        return profile
    stride = -(-(len(profile) - 1) // (limit - 1))
    kept = profile[:-1:stride]
    return [*kept, profile[-1]]
