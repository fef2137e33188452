# SPDX-License-Identifier: Apache-2.0
"""What `./dev longrun` does for a day and a billion edges, for some minutes and millions here."""

import pytest
from long_run import SCREWS, day, law


@pytest.mark.parametrize("number", range(len(SCREWS)))
def test_the_law_ends_where_the_closed_form_says(number: int):
    assert law(SCREWS[number], 20_000_000, seed=10 + number) == 20_000_000


def test_minutes_of_winch_time_from_one_hand_over():
    hours, edges = day(0.1, seed=2)
    assert hours >= 0.1
    assert edges > 2_000_000
