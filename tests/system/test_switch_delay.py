# SPDX-License-Identifier: Apache-2.0
"""Limit switches that tell late, by a time: measured by indexing, taken out of every place."""

import pytest
from levelwind.line.switch_delay import USTEP, Sample, fit
from levelwind.map_table import Command, Side, SwitchFault
from world import PlantFault, World

LATE_US = 2_000  # and the millisecond that a contact travels: 3 ms in all
DELAY_US = 3_000
UM_PER_USTEP = 10
RATES = (2_500, 5_000, 10_000, 20_000)
TOP_EDGES_PER_S = 48_000
LATE_AT_TOP_UM = 600  # 3 ms at 200 mm/s
SLIP_USTEPS = 160  # above switch_tolerance_um; whole electrical periods
SIDES = pytest.mark.parametrize("side", list(Side), ids=lambda s: s.label)


def measured(world: World, side: Side = Side.PLUS) -> tuple[float, float]:
    """The delay and the span by indexing at several rates, as `levelwind index --rates` does it."""
    samples = []
    for rate in RATES:
        world.apply(index_rate_edges_per_s=rate, index_switch=side)
        world.index()
        now = world.read("ks", "span_error_um")
        speed_um_per_s = now["ks"] / USTEP * rate * UM_PER_USTEP
        apart_um = now["span_error_um"] * (-1 if side == Side.PLUS else 1)
        samples.append(Sample(rate, speed_um_per_s, apart_um))
        world.write(command=Command.STOP)  # a set is not changed while tracking
    delay = fit(samples)
    return delay.delay_us, delay.apart_um


@SIDES
@pytest.mark.parametrize("late_us", [0, 500, LATE_US])
def test_indexing_at_several_rates_measures_the_delay(side: Side, late_us: int):
    world = World(bench_switch_late_us=late_us)
    delay_us, apart_um = measured(world, side)
    assert delay_us == pytest.approx(late_us + 1_000, abs=150)
    assert apart_um == pytest.approx(0, abs=30)
    # With it in force nothing is left of it.
    world.apply(switch_delay_us=round(delay_us))
    delay_us, apart_um = measured(world, side)
    assert delay_us == pytest.approx(0, abs=100)
    assert apart_um == pytest.approx(0, abs=30)


def reindexed_um(world: World, drum: int, side: Side) -> float:
    """How far the carriage is from where it believes to be, re-indexed at 48,000 edges/s."""
    name, outward = side.label, 1 if side == Side.PLUS else -1
    world.drum(drum * TOP_EDGES_PER_S)
    world.run(3.0)
    before = world.value(f"los2_{name}_count")
    world.run_until(
        lambda: (
            abs(world.value("position_um")) < 10_000 and world.truth.carriage_um_per_s * outward > 0
        )
    )
    world.inject(PlantFault.SLIP_USTEPS, outward * SLIP_USTEPS)
    world.run_until(lambda: world.value(f"los2_{name}_count") > before)
    # Back in the sweep, and away from the switch: what was wrong has been corrected.
    world.run_until(lambda: abs(world.value("position_um")) < 10_000)
    assert "correction_pending" not in world.flags
    return outward * world.error_usteps * UM_PER_USTEP


@SIDES
@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_a_late_switch_is_reindexed_on_where_it_is(side: Side, drum: int):
    late = World(bench_switch_late_us=LATE_US).index()
    assert reindexed_um(late, drum, side) == pytest.approx(LATE_AT_TOP_UM, abs=50)

    world = World(bench_switch_late_us=LATE_US)
    delay_us, _ = measured(world)
    world.apply(switch_delay_us=round(delay_us), index_rate_edges_per_s=10_000)
    world.index()
    assert world.error_usteps * UM_PER_USTEP == pytest.approx(0, abs=20)
    assert abs(reindexed_um(world, drum, side)) < 50


@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_late_switches_are_no_loss_of_synchronization(drum: int):
    """6 ms late is 1.2 mm at this speed, further than the tolerance of 1 mm."""
    late = {"bench_switch_late_us": 5_000}
    world = World(**late, span_tolerance_um=3_000).index()
    world.drum(drum * TOP_EDGES_PER_S)
    world.run(6.0)
    assert "los" in world.flags

    world = World(**late, span_tolerance_um=3_000, switch_delay_us=6_000).index()
    world.drum(drum * TOP_EDGES_PER_S)
    world.run(6.0)
    assert world.value("switch_plus_triggers") > 2
    assert "los" not in world.flags
    assert world.permit
    # A switch that does not tell at all is still missed.
    world.write(bench_switch_plus_fault=SwitchFault.STUCK_RELEASED)
    world.run(2.0)
    assert "los1_plus" in world.flags
