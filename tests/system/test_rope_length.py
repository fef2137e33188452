# SPDX-License-Identifier: Apache-2.0
"""Metres of rope by the layers, on a drum that really grows."""

from math import pi, sqrt

import pytest
from levelwind.map_table import BenchCommand, Command, Reason
from world import RequestRefusedError, World

CORE_UM = 380_000
ROPE_UM = 5_000
# As the rope really lies: layers of 4.7 mm, 31 turns in each. The controller does not know it.
BENCH = {
    "bench_rope_core_um": CORE_UM,
    "bench_rope_layer_um": 4_700,
    "bench_rope_layer_milliturns": 31_000,
}
FAST = 48_000  # edges/s
EDGES_PER_REV = 2880


def machine(**parameters: int) -> World:
    """A bare drum; what is to be known of it but the packing."""
    world = World(rope_diameter_um=ROPE_UM, drum_core_diameter_um=CORE_UM, **parameters)
    for name, value in BENCH.items():
        world.write(**{name: value})
    return world


def wind_to(world: World, metres: float) -> None:
    """Wind until about so much is really on the drum, and rest it."""
    forward = world.truth.rope_um < metres * 1e6
    world.drum(FAST if forward else -FAST, 400_000)
    world.run_until(
        lambda: (world.truth.rope_um > metres * 1e6) == forward, limit_s=300, step_s=0.02
    )
    world.stop_drum()


def fit(width_mm: float, first_mm: float, second_mm: float, turns: float) -> float:
    """The packing with which so many turns lie between two lengths, by the formula."""

    def turns_at(length_mm: float, packing: float) -> float:
        c = (ROPE_UM / 1000) ** 2 / (4 * packing * width_mm)
        radius = CORE_UM / 2000
        return (sqrt(radius**2 + c * length_mm) - radius) / (pi * c)

    low, high = 0.1, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        more = turns_at(second_mm, middle) - turns_at(first_mm, middle)
        low, high = (middle, high) if more < turns else (low, middle)
    return low


def fitted(world: World) -> World:
    """What a builder does once: two known lengths, and what lies between them."""
    known = []
    for metres in (100, 800):
        wind_to(world, metres)
        known.append((world.truth.rope_um / 1000, world.value("net_edges")))
    (first, begin), (second, end) = known
    derived = world.read("reversal_plus_usteps", "reversal_minus_usteps", "overshoot_actual_um")
    usteps = derived["reversal_plus_usteps"] - derived["reversal_minus_usteps"]
    width = usteps / 100 + 2 * derived["overshoot_actual_um"] / 1000
    packing = fit(width, first, second, (end - begin) / EDGES_PER_REV)
    world.apply(rope_packing_permille=round(1000 * packing))
    return world


def tell(world: World, mm: float) -> None:
    """So much is on the drum."""
    world.write(set_rope_mm=round(mm))
    world.command(Command.SET_ROPE)
    world.run(0.01)


def test_after_a_fit_a_kilometre_is_right_to_three_per_mille():
    world = fitted(machine())
    wind_to(world, 1000)
    tell(world, world.truth.rope_um / 1000)
    assert "rope_doubtful" not in world.flags
    worst = 0.0
    for metres in (900, 750, 600, 450, 300, 150, 50, 0):
        wind_to(world, metres)
        at = world.read("rope_on_drum_mm", "rope_out_mm", "rope_layer", "rope_radius_um")
        error_mm = at["rope_on_drum_mm"] - world.truth.rope_um / 1000
        worst = max(worst, abs(error_mm))
        layers = 1 + (at["rope_radius_um"] - CORE_UM // 2) // ROPE_UM
        assert at["rope_layer"] == layers or metres == 0
    assert worst < 0.003 * 1_000_000


def test_the_drum_really_grows_by_more_than_a_constant_can_say():
    """The check of the check: with one length per turn the same drum is wrong by per cents."""
    world = machine(rope_per_drum_rev_um=round(pi * CORE_UM))
    wind_to(world, 1000)
    assert abs(world.value("rope_mm") - world.truth.rope_um / 1000) > 0.05 * 1_000_000


def test_in_and_out_again_is_exactly_nothing():
    world = fitted(machine())
    tell(world, 800_000)
    begin = world.value("net_edges")
    for edges_per_s, seconds in ((FAST, 5.0), (-FAST, 21.0), (7_001, 3.0), (-FAST, 2.0)):
        world.drum(edges_per_s, 400_000)
        world.run(seconds)
        world.stop_drum()
    # Back to the edge where it was told, at a crawl.
    world.drum(20_000 if world.value("net_edges") < begin else -20_000, 400_000)
    world.run_until(lambda: abs(world.value("net_edges") - begin) < 3_000, 120, 0.005)
    world.stop_drum()
    while world.value("net_edges") != begin:
        world.drum(40 if world.value("net_edges") < begin else -40, 400_000)
        world.run_until(lambda: world.value("net_edges") == begin, 200, 0.002)
        world.drum(0, 4_000_000)
        world.run(0.5)
    at = world.read("rope_on_drum_mm", "rope_out_mm")
    assert at == {"rope_on_drum_mm": 800_000, "rope_out_mm": 0}
    assert "rope_doubtful" not in world.flags


def test_speed_is_that_of_the_wound_drum():
    world = fitted(machine())
    tell(world, world.truth.rope_um / 1000)
    world.drum(10_000, 400_000)
    world.run(1.0)
    before = world.truth
    speed = world.value("rope_speed_mm_per_s")
    world.run(0.1)
    really = (world.truth.rope_um - before.rope_um) / 1000 / 0.1
    assert speed == pytest.approx(really, rel=0.01)


def test_it_outlasts_a_power_cut_and_is_doubtful_until_told_anew():
    world = fitted(machine())
    tell(world, 800_000)
    wind_to(world, 500)
    at = world.read("rope_on_drum_mm", "rope_out_mm", "rope_layer")
    world.command(Command.SAVE)
    world.run(3.0)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)
    assert world.read("rope_on_drum_mm", "rope_out_mm", "rope_layer") == at
    assert "rope_doubtful" in world.flags
    tell(world, at["rope_on_drum_mm"])
    assert "rope_doubtful" not in world.flags


def test_set_rope_is_refused_where_it_cannot_be_true():
    world = machine()
    with pytest.raises(RequestRefusedError, match="rope_not_described"):
        world.command(Command.SET_ROPE)
    world.apply(rope_packing_permille=750)
    assert "rope_doubtful" in world.flags
    with pytest.raises(RequestRefusedError, match="rope_length_missing"):
        world.command(Command.SET_ROPE)
    world.write(set_rope_mm=900_000)
    world.drum(2_000)
    world.run(0.5)
    with pytest.raises(RequestRefusedError, match="drum_moving"):
        world.command(Command.SET_ROPE)
    assert Reason(world.value("command_reason")) == Reason.DRUM_MOVING
    assert world.value("rope_on_drum_mm") == 0
