# SPDX-License-Identifier: Apache-2.0
"""README's table follows what was recorded, and a page that does not is told."""

import json

import edge_cost
import pytest
import readme_numbers


def table(**changed: float) -> str:
    """The table, with another average of the simulator's speed."""
    results = json.loads(readme_numbers.FIGURES.read_text())
    for result in results:
        if result["name"] == "faster than real time":
            result.update(changed)
    return readme_numbers.table(readme_numbers.Figures(results, edge_cost.recorded()))


def test_readme_has_the_recorded_numbers():
    old, new = readme_numbers.pages()
    assert old == new


def test_a_number_that_changes_changes_the_table():
    assert "| 1,234 times |" in table(avg=1234)
    assert table(avg=1234) != table()


def test_what_is_generated_is_replaced_and_nothing_else():
    page = f"before\n{readme_numbers.BEGIN}\n\nold\n\n{readme_numbers.END}\nbehind\n"
    new = readme_numbers.with_table(page, "| new |")
    assert new == page.replace("old", "| new |")
    with pytest.raises(SystemExit, match="lacks the line"):
        readme_numbers.with_table("a page without", "| new |")


def test_a_measurement_that_is_missing_is_told():
    with pytest.raises(SystemExit, match="has no 'edges lost'"):
        readme_numbers.rows(readme_numbers.Figures([], edge_cost.recorded()))
