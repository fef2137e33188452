# SPDX-License-Identifier: Apache-2.0
"""What the encoder may do to the pattern: nothing but to turn it."""

import random

import pytest
from levelwind.map_table import BenchCommand
from world import World

EDGES_PER_PULSE = 2


def bench(world: World, command: BenchCommand, argument: int) -> None:
    """Run a command of the bench."""
    world.write(bench_argument=argument, bench_command=command)
    assert world.value("bench_result") == 0


MODES = {  # edges per pulse: the edges that so many transitions of the encoder make
    1: lambda transitions: (transitions + 3) // 4,  # of channel A while B is low
    2: lambda transitions: (transitions + 1) // 2,  # of channel A
    4: lambda transitions: transitions,
}


def counted_edges(world: World) -> int:
    """What the decoder must have counted had it seen every transition."""
    return MODES[world.value("active.encoder_edges_per_pulse")](world.value("bench_transitions"))


def launched(speed: int = 20_000) -> World:
    """A world in a launch, in the sweep."""
    world = World().index()
    world.drum(speed)
    world.run(1.5)
    return world


def check_slope(world: World, seconds: float) -> None:
    """In the sweep the slope is +Ks or -Ks and nothing else."""
    ks = world.value("ks")
    for _ in range(round(seconds / 0.002)):
        world.run(0.002)
        u = abs(world.value("u"))
        assert u == ks if world.in_sweep() else u <= ks


@pytest.mark.parametrize("speed", [48_000, -48_000])
def test_no_edge_is_lost_at_top_speed(speed: int):
    world = World().index()
    orbit = world.orbit()
    world.drum(speed)
    world.run(10.0)
    assert abs(world.value("drum_speed_edges_per_s")) == pytest.approx(48_000, rel=0.01)
    assert world.value("net_edges") == counted_edges(world)
    world.check_follows(orbit)
    world.stop_drum()
    assert world.value("net_edges") == counted_edges(world)
    world.check_follows(orbit)
    assert world.truth.in_sync
    assert world.permit


@pytest.mark.parametrize("edges_per_pulse", MODES)
def test_dither_at_rest_nets_to_zero(edges_per_pulse: int):
    """Wherever in its pulse the encoder rests."""
    world = World(encoder_edges_per_pulse=edges_per_pulse, pitch_um=6000, overshoot_um=2400)
    world.index()
    rests = set()
    for stop in range(12):
        world.drum(500 + 37 * stop, edges_per_s2=1e6)
        world.run(0.3)
        world.stop_drum()
        rests.add(world.value("bench_transitions") % 4)
        before = world.read("net_edges", "m", "u", "position_um")
        assert before["net_edges"] == counted_edges(world)
        world.write(bench_argument=1000, bench_command=BenchCommand.DITHER)
        world.run(0.1)
        assert world.read("net_edges", "m", "u", "position_um") == before
    assert rests == {0, 1, 2, 3}
    assert world.value("illegal_transitions") == 0
    assert world.permit


def test_dither_in_a_launch_changes_nothing():
    world = World().index()
    orbit = world.orbit()
    world.drum(20_000)
    for _ in range(50):
        bench(world, BenchCommand.DITHER, 500)
        world.run(0.1)
        world.check_follows(orbit)
    world.stop_drum()
    lost = 2 * world.value("illegal_transitions") * EDGES_PER_PULSE
    assert abs(world.value("net_edges") - counted_edges(world)) <= lost
    world.check_follows(orbit)


def test_lost_pulses_shift_the_pattern_and_nothing_else():
    """Without index pulses nobody can know of them."""
    world = World()
    world.write(bench_index_pulses=0)
    world.index()
    orbit = world.orbit()
    world.drum(20_000)
    world.run(1.0)
    lost = 0
    for pulses in (1, 7, 250, 3000):
        bench(world, BenchCommand.LOSE_PULSES, pulses)
        lost += pulses * EDGES_PER_PULSE
        check_slope(world, 2.0)
        assert counted_edges(world) - world.value("net_edges") == pytest.approx(lost, abs=2)
        world.check_follows(orbit)
    assert world.flags.isdisjoint({"los", "faulted"})
    assert world.truth.in_sync
    assert world.permit


def test_illegal_transitions_are_counted_and_do_not_move():
    world = launched()
    before = world.read("net_edges", "pattern_edges")
    transitions = world.value("bench_transitions")
    bench(world, BenchCommand.ILLEGAL_TRANSITIONS, 400)
    check_slope(world, 2.0)
    world.stop_drum()
    assert world.value("illegal_transitions") == 400
    seen = world.value("net_edges") - before["net_edges"]
    real = (world.value("bench_transitions") - transitions) / 2
    # Each hides two transitions: one edge.
    assert real - seen == pytest.approx(400, abs=1)
    assert world.value("pattern_edges") - before["pattern_edges"] == seen
    assert {"los1_plus", "los1_minus", "los2_plus", "los2_minus"}.isdisjoint(world.flags)


@pytest.mark.parametrize("edges_per_pulse", MODES)
def test_a_rocking_drum_leaves_the_ideal_pattern(edges_per_pulse: int):
    """A launch with the drum pulled back and forth: every stop is where the ideal screw is."""
    rng = random.Random(edges_per_pulse)
    world = World(encoder_edges_per_pulse=edges_per_pulse, pitch_um=6000, overshoot_um=2400)
    world.index()
    orbit = world.orbit()
    for _ in range(12):
        world.drum(rng.choice((1, -1)) * rng.randint(500, 20_000), edges_per_s2=200_000)
        world.run(rng.uniform(0.05, 2.0))
        bench(world, BenchCommand.DITHER, rng.randint(0, 50))
        world.check_follows(orbit)
    world.stop_drum()
    world.check_follows(orbit)
    assert world.truth.in_sync
    assert world.permit


def test_back_and_forth_by_the_same_edges_restores_all():
    world = World().index()
    at_start = world.read("m", "u", "position_um")
    for speed in (20_000, -20_000):
        world.drum(speed)
        world.run(5.0)
        world.stop_drum()
    # The drum is not exactly where it was: bring the last edges back one by one.
    while world.value("pattern_edges"):
        world.drum(-200 if world.value("pattern_edges") > 0 else 200, edges_per_s2=1e6)
        world.run(0.0005)
    assert world.read("m", "u", "position_um") == at_start


@pytest.mark.parametrize("speed", [20_000, -20_000])
@pytest.mark.parametrize("edges_per_pulse", MODES)
def test_lost_pulses_are_found_by_the_index(edges_per_pulse: int, speed: int):
    # One microstep is the most that an edge may ask for: a finer pitch where edges are fewer.
    world = World(encoder_edges_per_pulse=edges_per_pulse, pitch_um=3_000).index()
    world.drum(speed)
    world.run(3.0)
    assert world.value("encoder_index_pulses") > 20
    assert world.value("missed_edges") == 0
    bench(world, BenchCommand.LOSE_PULSES, 3)
    world.run(0.2)
    assert world.value("missed_edges") == 3 * edges_per_pulse
    world.drum(-speed)
    world.run(6.0)
    world.stop_drum()
    assert world.value("missed_edges") == 3 * edges_per_pulse
    assert world.value("late_interrupts") == 0


def test_dither_at_the_index_is_not_a_missed_edge():
    world = World().index()
    for turn in range(40):
        world.drum(2_000 if turn % 2 else -2_000)
        bench(world, BenchCommand.DITHER, 50)
        world.run(0.3 + turn / 100)
    world.stop_drum()
    assert world.value("encoder_index_pulses") > 20
    assert world.value("missed_edges") == 0
