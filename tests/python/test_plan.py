# SPDX-License-Identifier: Apache-2.0
"""From millimetres to registers: what is taken, what is moved along, what is warned of."""

import json

import pytest
from levelwind.cli import app
from levelwind.core import native
from levelwind.map_table import POINTS
from levelwind.plan import planning
from typer.testing import CliRunner


def levelwind(*arguments: str):
    return CliRunner().invoke(app, ["plan", *arguments])


def document(*arguments: str) -> dict:
    result = levelwind("--json", *arguments)
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


def parameters(*arguments: str) -> dict[str, int]:
    return document(*arguments)["parameters"]


def rows(*arguments: str) -> dict[str, str]:
    """First two columns of the table, by the first."""
    names = ("screw", "pulley", "index speed", "jog speed", "range")
    lines = levelwind(*arguments).stdout.splitlines()
    found = {
        n: line.removeprefix(n).split()[:2] for n in names for line in lines if line.startswith(n)
    }
    return {name: " ".join(value) for name, value in found.items()}


def test_speeds_of_screw_indexing_and_jogging():
    """By hand: 40 m/s at 2.4 m a rev are 1000 drum rpm, 12 mm a rev by a screw of 20 mm: 600 rpm.

    Indexing at 10,000 edges/s of 2,880 a drum rev: 41.7 mm/s; jogging at half of it.
    """
    shown = rows("--rope-speed", "40")
    assert shown["screw"] == "600 rpm"
    assert shown["index speed"] == "41.7 mm/s"
    assert shown["jog speed"] == "20.8 mm/s"
    rates = document("--rope-speed", "40")["at_rope_speed"]
    assert rates["screw_rpm"] == pytest.approx(600, rel=1e-3)
    assert rates["index_mm_per_s"] == pytest.approx(12 * 10_000 / 2880, rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "warned", "quiet"),
    [
        ((), (), ("rope",)),
        (("--rope-speed", "40"), (), ("rope",)),
        (("--rope-speed", "45"), ("overspeed_warning_edges_per_s 52000",), ("trip", "rpm")),
        (("--rope-speed", "60"), ("overspeed_trip_edges_per_s 60000 (50.0 m/s)",), ("warning_e",)),
        (("--rope-speed", "60", "--lead-mm", "5", "--microsteps", "400"), ("3601 rpm",), ()),
        (("--overshoot-mm", "0.3", "--rope-speed", "60"), ("m/s2, more than 20",), ("rpm",)),
        (("--set", "index_rate_edges_per_s=30000"), ("Indexing moves",), ("Jogging",)),
        (("--set", "jog_rate_edges_per_s=30000"), ("Jogging moves",), ("Indexing",)),
        (("--set", "cam_steps_per_s_max=5000"), ("9998 steps/s",), ()),
    ],
)
def test_a_plan_that_a_winch_could_hardly_follow_is_warned_of(
    arguments: tuple[str, ...], warned: tuple[str, ...], quiet: tuple[str, ...]
):
    result = levelwind(*arguments)
    assert result.exit_code == 0
    assert all(text in result.stderr for text in warned), result.stderr
    assert not any(text in result.stderr for text in quiet), result.stderr
    told = document(*arguments)["warnings"]
    assert len(told) >= len(warned)
    assert all(f"levelwind: {text}" in result.stderr.splitlines() for text in told)


def test_flanges_alone_take_reversals_switches_and_travel_along():
    result = levelwind("--flange-mm", "106/-106")
    assert result.exit_code == 0
    assert "reversal_plus_um 103 mm" in result.stderr
    assert "travel_um 226 mm" in result.stderr
    line = result.stdout.splitlines()[-1]
    for change in ("reversal_plus_um=103000", "reversal_minus_um=-103000", "travel_um=226000"):
        assert change in line
    assert parameters("--flange-mm", "106/-106")["switch_minus_um"] == -101_400
    assert document("--flange-mm", "106/-106")["moved_along"]["switch_plus_um"] == 101_400


def test_flanges_given_as_parameters_take_the_same_along():
    given = parameters("--set", "flange_plus_um=106000", "--set", "flange_minus_um=-106000")
    assert given == parameters("--flange-mm", "106/-106")


def test_flanges_near_each_other_leave_no_reversal_outside():
    given = parameters("--flange-mm", "50/-50")
    assert (given["reversal_plus_um"], given["switch_plus_um"]) == (47_000, 45_400)
    assert given["travel_um"] == 180_000  # long enough


def test_a_long_overshoot_keeps_room_at_the_flange():
    given = parameters("--flange-mm", "106/-106", "--overshoot-mm", "5")
    assert given["reversal_plus_um"] == 106_000 - 5_500


def test_what_is_given_is_not_moved():
    places = ("--flange-mm", "106/-106", "--reversal-mm", "102/-101", "--switch-mm", "99/-98")
    result = levelwind(*places, "--travel-mm", "230")
    assert result.exit_code == 0
    assert "moved along" not in result.stderr
    given = parameters(*places, "--travel-mm", "230")
    assert given["travel_um"] == 230_000
    assert (given["reversal_plus_um"], given["switch_minus_um"]) == (102_000, -98_000)
    assert levelwind().stderr == ""


def test_reversals_alone_take_the_switches_along_and_stay_inside_the_flanges():
    assert parameters("--reversal-mm", "70/-60")["switch_minus_um"] == -58_400
    result = levelwind("--reversal-mm", "90/-90")
    assert result.exit_code == 1
    assert "flange_plus_um = 83000 um" in result.stderr


def test_a_travel_that_the_positions_cannot_hold_says_the_way_out():
    wide = ("--flange-mm", "150/-150", "--microsteps", "5000", "--pitch-mm", "4")
    result = levelwind(*wide)
    assert result.exit_code == 1
    assert "32700 microsteps, which are 130.8 mm with 5000 microsteps" in result.stderr
    way_out = result.stderr.split()[-1]
    assert way_out == "2000"
    assert levelwind(*wide[:2], "--microsteps", way_out, *wide[4:]).exit_code == 0
    assert levelwind(*wide[:2], "--microsteps", "3200", *wide[4:]).exit_code == 1
    assert rows()["range"] == "327.0 mm"


def test_the_limit_of_positions_is_that_of_the_core():
    factory = {p.name: p.default or 0 for p in planning.PARAMETERS}
    um_per_ustep = factory["screw_lead_um"] // factory["microsteps_per_rev"]
    at_limit = planning.POSITION_MAX_USTEPS * um_per_ustep
    for travel_um, taken in ((at_limit - 60_000, True), (at_limit, False)):
        try:
            native.derive({**factory, "travel_um": travel_um})
        except planning.RefusedError as error:
            assert not taken
            assert str(planning.POSITION_MAX_USTEPS) in str(error)
        else:
            assert taken


def test_a_belt_has_a_pulley_and_no_screw():
    given = ("--belt-mm-per-rev", "40", "--microsteps", "1600")
    assert parameters(*given)["screw_lead_um"] == 40_000
    assert rows(*given)["pulley"] == "150 rpm"  # 500 drum rpm, 12 of 40 mm
    assert "screw" not in rows(*given)
    both = levelwind("--belt-mm-per-rev", "40", "--lead-mm", "20")
    assert both.exit_code == 1
    assert "not both" in both.stderr


@pytest.mark.parametrize(
    ("text", "numerator", "denominator"),
    [("1", 1, 1), ("4", 4, 1), ("4/1", 4, 1), ("200/50", 4, 1), ("2.5", 5, 2), ("5:2", 5, 2)],
)
def test_a_ratio_in_lowest_terms(text: str, numerator: int, denominator: int):
    given = parameters("--ratio", text, "--pitch-mm", "5")
    assert given["encoder_ratio_numerator"] == numerator
    assert given["encoder_ratio_denominator"] == denominator


def test_a_ratio_beyond_the_registers_names_the_nearest_that_fits():
    result = levelwind("--ratio", "127/50")
    assert result.exit_code == 1
    assert "numerator goes to 100" in result.stderr
    assert "94/37, +213 ppm" in result.stderr
    # No other pair within the limits of the registers comes nearer.
    limits = [POINTS[f"encoder_ratio_{part}"].max for part in ("numerator", "denominator")]
    errors = [abs(n / d - 2.54) for n in range(1, limits[0] + 1) for d in range(1, limits[1] + 1)]
    assert min(errors) == pytest.approx(abs(94 / 37 - 2.54))


@pytest.mark.parametrize("text", ["0", "4/0", "-4", "nan", "1e9", "x", "4/", "1/2/3", ""])
def test_a_ratio_that_is_none_is_refused(text: str):
    result = levelwind("--ratio", text)
    assert result.exit_code == 1
    assert "as 4/1 or 4" in result.stderr


def test_a_ratio_just_beyond_a_register_goes_to_its_limit():
    assert "nearest that fits is 1/1000, +1000 ppm" in levelwind("--ratio", "1/1001").stderr


@pytest.mark.parametrize("text", ["5000", "1/2000"])
def test_a_ratio_far_out_has_no_neighbour(text: str):
    result = levelwind("--ratio", text)
    assert result.exit_code == 1
    assert "to 1000, in lowest terms." in result.stderr


@pytest.mark.parametrize(
    "arguments", [("--pitch-mm", "nan"), ("--flange-mm", "inf/-80"), ("--travel-mm", "inf")]
)
def test_what_is_no_number_is_refused(arguments: tuple[str, str]):
    result = levelwind(*arguments)
    assert result.exit_code == 1
    assert "give a number" in result.stderr
    assert arguments[0].removeprefix("--").removesuffix("-mm") in result.stderr
