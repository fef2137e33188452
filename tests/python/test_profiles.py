# SPDX-License-Identifier: Apache-2.0
"""Reading speed profiles and converting them to drum speed."""

from pathlib import Path

import pytest
from levelwind.errors import ToolError
from levelwind.files.profiles import Gearing, read, thin

GEARING = Gearing(
    rope_per_drum_rev_um=2_400_000,
    edges_per_1000_drum_revs=2_880_000,
    encoder_revs_per_drum_rev=4.0,
)
LAUNCH = Path(__file__).parents[2] / "profiles" / "ground_launch.csv"


def written(folder: Path, text: str) -> Path:
    path = folder / "profile.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("column", "value", "millirpm"),
    [
        ("rope_m_per_s", "20", 500_000),  # 20 m/s / 2.4 m
        ("drum_rpm", "-12.5", -12_500),
        ("motor_rpm", "3000", 500_000),  # / 1.5 / 4
        ("edges_per_s", "24000", 500_000),  # / 2880 edges
    ],
)
def test_conversions(tmp_path: Path, column: str, value: str, millirpm: int):
    path = written(tmp_path, f"time_s,{column}\n0,0\n1.5,{value}\n")
    assert read(path, GEARING) == [(0, 0), (1500, millirpm)]


def test_times_begin_at_zero_and_share_no_millisecond(tmp_path: Path):
    path = written(tmp_path, "time,other,drum_rpm\n7.0,x,1\n7.0001,x,2\n7.002,x,3\n")
    assert read(path, GEARING) == [(0, 1000), (2, 3000)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_s,speed\n0,0\n", "names time_s, speed"),
        ("time_s,drum_rpm,motor_rpm\n0,0,0\n", "one of"),
        ("time_s,drum_rpm\n0,0\n1,fast\n", r"profile\.csv, line 3, column 2: 'fast' is no number"),
        ("time_s,drum_rpm\n0,0\n1\n", r"profile\.csv, line 3, column 2: the cell is empty"),
        ("time_s,drum_rpm\n0,0\n1,nan\n", "'nan' is no number"),
        ("time_s,drum_rpm\n2,0\n1,0\n", "line 3, column 1: time 1.0 s does not come after 2.0"),
        ("time_s,drum_rpm\n0,0\n1,3001\n", "3001 drum revolutions a minute, limit 3000"),
        ("time_s,drum_rpm\n0,0\n", "at least two points"),
        ("", "names nothing"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, message: str):
    with pytest.raises(ToolError, match=message):
        read(written(tmp_path, text), GEARING)


def test_missing_file(tmp_path: Path):
    with pytest.raises(ToolError, match="No such file"):
        read(tmp_path / "none.csv", GEARING)


@pytest.mark.parametrize("count", [2, 100, 101, 150, 199, 200, 1000])
def test_thinning_keeps_both_ends_and_fits(count: int):
    profile = [(i, i * 10) for i in range(count)]
    thinned = thin(profile, 100)
    assert len(thinned) <= 100
    assert (thinned[0], thinned[-1]) == (profile[0], profile[-1])
    assert set(thinned) <= set(profile)
    assert thinned == sorted(set(thinned))
    assert count > 100 or thinned == profile


def test_the_launch_of_the_demonstration_goes_both_ways_and_ends_at_rest():
    profile = read(LAUNCH, GEARING)
    speeds = [speed for _, speed in profile]
    assert max(speeds) > 500_000
    assert min(speeds) < 0
    assert speeds[0] == speeds[-1] == 0
    assert 75_000 <= profile[-1][0] <= 90_000
