# SPDX-License-Identifier: Apache-2.0
"""What is counted costs no more than recorded, and every figure has a name of its own."""

import json

import counted
import pytest
from figure import FIGURES, Figure, dearer, side_by_side, without_name

RECORD = json.loads(FIGURES.read_text())


@pytest.mark.skipif(not counted.available(), reason="no callgrind: apt-get install valgrind")
def test_what_is_counted_costs_no_more_than_recorded():
    figures = counted.measure()
    recorded = {(r["name"], r["target"]) for r in RECORD}
    assert [f.key for f in figures if f.key not in recorded] == []
    assert dearer(figures, RECORD) == []


def test_every_recorded_figure_has_a_name_of_its_own():
    assert without_name(Figure(**r) for r in RECORD) == []


def test_every_figure_that_is_printed_for_arm_and_the_board_is_recorded():
    names = [(r["target"], r["name"]) for r in RECORD]
    for cpu in ("cortex-m4", "cortex-m3", "cortex-m0plus"):
        assert (cpu, "Arm edge, law alone, -O2, all") in names
        assert (cpu, "Arm, code of the law, -Os") in names
    assert ("nucleo_f446re", "board, CPI 1.0: processor's load") in names


def made(avg: float, worst: float, counted: bool = True) -> Figure:
    limits = {"avg_max": 12.0, "max_max": 20}
    return Figure("law", "core", "", 9, avg, worst, "instructions", None, limits, counted)


def test_what_misses_its_target_is_told():
    assert made(12.0, 20).missed() == []
    assert made(12.1, 20).missed() == ["law (core): average 12.1 instructions, at most 12"]
    assert made(12.0, 21).missed() == ["law (core): worst 21 instructions, at most 20"]
    fast = Figure("speed", "sim", "", 90, 100, 110, "x", None, {"avg_min": 101})
    assert fast.missed() == ["speed (sim): average 100 x, at least 101"]


@pytest.mark.parametrize(("now", "told"), [((10.9, 17), 0), ((11.1, 17), 1), ((10, 19), 1)])
def test_what_is_dearer_by_a_tenth_is_told_if_it_is_counted(now, told):
    old = [{"name": "law", "target": "core", "avg": 10.0, "max": 17.0}]
    assert len(dearer([made(*now)], old)) == told
    assert dearer([made(*now, counted=False)], old) == []


def test_side_by_side_has_what_both_have():
    old = [{"name": "law", "target": "core", "avg": 20.0, "max": 30.0}]
    text = side_by_side([made(10, 17)], old, "HEAD~1")
    assert "HEAD~1" in text and "-50.0 %" in text and "20.00     30.00" in text
