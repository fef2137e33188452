# SPDX-License-Identifier: Apache-2.0
"""A rule of MISRA C that is broken without a deviation is found, and a deviation without need."""

from pathlib import Path

import misra
import pytest

TEXT = "| D1 | 15.5, 15.7 | early |\n| D12 | 2.5 | names |\n"


def test_the_deviations_are_read_from_the_table():
    assert misra.deviations(TEXT) == {"15.5", "15.7", "2.5"}
    assert len(misra.deviations((misra.ROOT / misra.DEVIATIONS).read_text(encoding="utf-8"))) > 20


def test_what_has_no_deviation_is_told_with_its_place():
    (told,) = misra.problems([("a.c:7", "13.4"), ("a.c:8", "2.5")], {"2.5"})
    assert told.startswith("a.c:7: MISRA C:2012 rule 13.4")


def test_a_deviation_that_nothing_needs_is_told():
    (told,) = misra.problems([("a.c:8", "2.5")], {"2.5", "13.4"})
    assert "rule 13.4 is kept" in told


def test_the_addon_is_asked(tmp_path: Path):
    try:
        source = tmp_path / "broken.c"
        source.write_text("int f(int *a, int *b)\n{\n\treturn *a = *b = 1;\n}\n")
        found = misra.broken_rules(tmp_path / "cache", str(source))
    except FileNotFoundError:
        pytest.skip("no cppcheck")
    assert (f"{source}:3", "13.4") in found
