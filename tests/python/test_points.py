# SPDX-License-Identifier: Apache-2.0
"""Values of the map: names, limits, registers."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from levelwind.errors import ToolError
from levelwind.line.parameter_sets import set_crc
from levelwind.line.points import (
    NO_ADDRESS,
    PARAMETERS,
    at_address,
    check_limits,
    decode,
    encode,
    format_value,
    lookup,
    parse_assignments,
    parse_value,
    refusal_text,
    runs,
)
from levelwind.map_table import POINTS, Fault, Point, Reason

DOC = Path(__file__).parents[2] / "doc"
PAGE = DOC / "integration.md"
FAULTS = DOC / "field-setup.md"
SPACES = {
    "input registers": "input",
    "holding registers": "holding",
    "discrete inputs": "discrete",
    "coils": "coil",
}
BENCH = 0xF000  # from here on the simulated machine's
WRITABLE = [p for p in POINTS.values() if p.space == "holding" and p.writable]


@given(st.sampled_from(WRITABLE), st.data())
def test_every_writable_value_survives_the_wire(point: Point, data: st.DataObject):
    value = data.draw(st.integers(point.min, point.max))
    registers = encode(point, value)
    assert len(registers) == point.words
    assert all(0 <= register <= 0xFFFF for register in registers)
    assert decode(point, registers) == value


def test_the_high_word_comes_first():
    assert encode(POINTS["pitch_um"], 0x00012345) == [0x0001, 0x2345]
    assert decode(POINTS["net_edges"], [0xFFFF, 0xFFFF, 0xFFFF, 0xFFFE]) == -2


def test_every_default_is_within_its_limits():
    for point in PARAMETERS:
        assert check_limits(point, point.default) == point.default


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("pitch_um=9", "pitch_um=9 is outside its limits: 10 to 100000 um"),
        ("pitch_um=100001", "10 to 100000 um"),
        ("pitch_um=1.5", "pitch_um=1.5: give a whole number"),
        ("pitch_um", "give NAME=VALUE"),
        ("encoder_edges_per_pulse=3", "outside its limits: 1, 2, 4"),
        ("index_switch=left", "give one of plus, minus"),
        ("index_switch=2", "plus, minus"),
        ("line_format=7E1", "8E1, 8O1, 8N1, 8N2"),
        ("position_um=0", "position_um can only be read"),
        ("pich_um=1", "Did you mean pitch_um"),
        ("stored.pitch_um=11000", "can only be read"),
        ("active.mode=1", "only parameters have the copies"),
    ],
)
def test_limits_are_named_before_anything_is_sent(assignment: str, message: str):
    with pytest.raises(ToolError, match=message):
        parse_assignments([assignment])


def test_enum_names_and_numbers_are_accepted():
    assert parse_assignments(["index_switch=minus", "line_format=8N2", "pitch_um=0x100"]) == {
        "index_switch": 1,
        "line_format": 3,
        "pitch_um": 256,
    }
    assert format_value(POINTS["index_switch"], 1) == "minus"
    assert format_value(POINTS["state"], 99) == "99"
    assert parse_value(POINTS["mode"], 2) == 2


def test_runs_are_contiguous_and_complete():
    groups = runs(PARAMETERS, 20)
    assert [p.name for g in groups for p in g.points] == [p.name for p in PARAMETERS]
    for group in groups:
        assert group.count == sum(p.words for p in group.points) <= 20
    assert runs([POINTS["bench_profile"]], 125)[0].count == 120


def test_copies_have_their_own_addresses():
    assert lookup("active.pitch_um").address == 1114
    assert lookup("stored.pitch_um").space == "input"


def test_the_second_register_of_a_value_belongs_to_it():
    assert at_address(POINTS["pitch_um"].address + 1) is POINTS["pitch_um"]
    assert at_address(109) is None


def test_refusals_name_value_and_limit_only_where_one_is_to_blame():
    broken = refusal_text(Reason.OUT_OF_RANGE, 114, 9, 10)
    assert broken.endswith("pitch_um = 9 um, must be at least 10 um (holding register 114)")
    too_much = refusal_text(Reason.OUT_OF_RANGE, 114, 11, 10)
    assert too_much.endswith("pitch_um = 11 um, must be at most 10 um (holding register 114)")
    inside = refusal_text(Reason.SWITCH_MINUS_OUTSIDE, 130, -9, -9)
    assert "switch_minus_um = -9 um, must be more than -9 um" in inside
    assert refusal_text(Reason.BUSY_TRACKING, 114, 9, 0) == Reason.BUSY_TRACKING.text
    assert refusal_text(Reason.OUT_OF_RANGE, NO_ADDRESS, 0, 0) == Reason.OUT_OF_RANGE.text
    assert "newer than this tool" in refusal_text(999, NO_ADDRESS, 0, 0)


def test_the_builders_page_says_of_every_fault_what_to_look_at():
    table = re.search(r"^\| fault \|.*?(?=\n\n)", FAULTS.read_text(), re.M | re.S)
    assert table
    told = [name for row in table[0].splitlines()[2:] for name in row.split("|")[1].split(",")]
    assert sorted(name.strip() for name in told) == sorted(
        fault.name.lower() for fault in Fault if fault != Fault.NONE
    )


@pytest.mark.parametrize("title", SPACES)
def test_the_integrators_page_has_the_runs_without_holes(title: str):
    line = re.search(rf"^\| {title} \| (.*)$", PAGE.read_text(), re.M)
    assert line
    told = [tuple(map(int, pair)) for pair in re.findall(r"(\d+), (\d+)", line[1])]
    points = [p for p in POINTS.values() if p.space == SPACES[title] and p.address < BENCH]
    assert told == [(run.address, run.count) for run in runs(points, 10_000)]


def test_a_set_is_named_as_the_core_names_it():
    """The same number stands in tests/unit/test_params.c."""
    assert set_crc({point.name: point.default or 0 for point in PARAMETERS}) == 860_867_484
