# SPDX-License-Identifier: Apache-2.0
"""An edge costs what it may, and every step is the model's."""

import pytest
from edge_cost import HOW_TO_INSTALL, Cost, available, failures, measure_all, recorded


@pytest.mark.skipif(not available(), reason=f"no compiler for Arm: {HOW_TO_INSTALL}")
def test_an_edge_costs_what_it_may_on_a_cortex_m4():
    costs, _ = measure_all(("cortex-m4",))
    assert failures(costs, recorded()) == []


def test_what_is_dearer_than_the_record_or_the_target_is_told():
    old = Cost("law alone", "cortex-m4", "-O2", "all", 9, 10.0, 17)
    assert failures([old], [old]) == []
    assert len(failures([Cost("law alone", "cortex-m4", "-O2", "all", 9, 11.1, 17)], [old])) == 1
    assert len(failures([Cost("law alone", "cortex-m4", "-O2", "all", 9, 10.0, 19)], [old])) == 1
    assert len(failures([Cost("law alone", "cortex-m4", "-O2", "all", 9, 12.1, 17)], [])) == 1
    assert len(failures([Cost("law alone", "cortex-m4", "-O2", "all", 9, 10.0, 21)], [])) == 1
