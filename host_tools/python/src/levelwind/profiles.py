"""Drum speed profiles: CSV files of rope, motor or drum speed over time."""

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from levelwind.errors import ToolError
from levelwind.map_table import POINTS

POINTS_MAX = 8192  # what the simulated plant holds
SPEED_LIMIT_MILLIRPM = -(POINTS["bench_profile"].min or 0)
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


def read(path: Path, gearing: Gearing) -> Profile:
    """Drum speed points of a CSV file, beginning at 0 ms, at most one a millisecond."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            return thin(_points(path, csv.DictReader(file), gearing))
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise ToolError(f"{path} is no text file.") from error


def _points(path: Path, reader: csv.DictReader, gearing: Gearing) -> Profile:
    columns = reader.fieldnames or []
    time_column = next((name for name in TIME_COLUMNS if name in columns), None)
    speed_columns = [name for name in SPEED_COLUMNS if name in columns]
    if time_column is None or len(speed_columns) != 1:
        raise ToolError(
            f"{path}: the first line must name the columns time_s and one of "
            f"{', '.join(SPEED_COLUMNS)}; it names {', '.join(columns) or 'nothing'}."
        )
    convert = gearing.drum_rpm(speed_columns[0])
    profile: Profile = []
    begin_s = last_s = None
    for row in reader:
        place = f"{path}:{reader.line_num}"
        time_s = _number(row, time_column, place)
        speed = _number(row, speed_columns[0], place)
        if last_s is not None and time_s <= last_s:
            raise ToolError(f"{place}: time {time_s:g} s does not come after {last_s:g} s.")
        begin_s = time_s if begin_s is None else begin_s
        last_s = time_s
        point = (round((time_s - begin_s) * 1000), round(convert(speed) * 1000))
        if abs(point[1]) > SPEED_LIMIT_MILLIRPM:
            raise ToolError(
                f"{place}: {speed:g} is {point[1] / 1000:.0f} drum revolutions a minute, "
                f"limit {SPEED_LIMIT_MILLIRPM / 1000:.0f}."
            )
        if not profile or point[0] > profile[-1][0]:
            profile.append(point)
    if len(profile) < 2:
        raise ToolError(f"{path}: a profile has at least two points.")
    return profile


def _number(row: Mapping[str, str | None], column: str, place: str) -> float:
    text = row[column]
    try:
        value = float(text or "")
    except ValueError:
        raise ToolError(f"{place}: {column} is {text!r}, not a number.") from None
    if not math.isfinite(value) or abs(value) > 1e9:
        raise ToolError(f"{place}: {column} is {text!r}, not a number that can be meant.")
    return value


def thin(profile: Profile, limit: int = POINTS_MAX) -> Profile:
    """Every n-th point and the last, so that they fit; unchanged if they do."""
    if len(profile) <= limit:
        return profile
    stride = -(-(len(profile) - 1) // (limit - 1))
    kept = profile[:-1:stride]
    return [*kept, profile[-1]]
