# SPDX-License-Identifier: Apache-2.0
"""A power cut between two launches: with `resume` the lay goes on as if there had been none."""

import random

import pytest
from levelwind.map_table import BenchCommand, Command, Mode, Result, State
from world import PlantFault, World

PLACES = 100  # for each drum sign
REPEATS_USTEPS = (
    2  # an indexing repeats to one microstep; a resting rotor lies 0.15 beside its field
)
DRUMS = pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
PARKED_UM = -82_480


def machine(seed: int = 1, **parameters: int) -> World:
    """A machine with its parameters saved, following the drum."""
    parameters = {"index_rate_edges_per_s": 40_000, "resume": 1} | parameters
    world = World(seed, carriage_um=137 * seed % 60_000, **parameters)
    assert world.command(Command.SAVE) == Result.DONE
    return world.index()


def wind(world: World, edges_per_s: float, seconds: float) -> None:
    """A launch, and the time that the storage needs at its end."""
    world.drum(edges_per_s, edges_per_s2=1e5)
    world.run(seconds)
    world.drum(0, edges_per_s2=1e5)
    world.run_until(lambda: "drum_at_rest" in world.flags, step_s=0.01)
    world.run(0.1)


def power_cut(world: World) -> None:
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)
    assert world.state in (State.UNINDEXED, State.FAULT)


@DRUMS
def test_the_pattern_goes_on_where_it_was(drum: int):
    """At 200 places: in sweep and reversal, outside of the switches, at any phase of a step."""
    chance = random.Random(15 + drum)
    reversals = 0
    for seed in range(PLACES):
        pattern = {"dwell_plus_millirev": 500, "dwell_minus_millirev": 300} if seed % 4 == 0 else {}
        breaker = {"breaker_millirev": 700, "breaker_cycles": 4} if seed % 8 == 0 else {}
        world = machine(seed, **pattern, **breaker)
        orbit = world.orbit()
        wind(world, drum * chance.uniform(5_000, 48_000), chance.uniform(0.5, 6.0))
        world.check_follows(orbit)
        reversals += not world.in_sweep()
        kept = world.read("m", "u", "resume_position_um", "position_um", "pattern_edges")
        error_usteps = world.error_usteps
        assert kept["resume_position_um"] == kept["position_um"]
        power_cut(world)
        told = world.read("resume_position_um", "resume_direction")
        assert told["resume_position_um"] == kept["position_um"]
        assert "resume_doubtful" not in world.flags
        if kept["u"]:
            assert told["resume_direction"] == (1 if kept["u"] > 0 else -1)
        world.index()
        world.run_until(lambda w=world: w.state == State.TRACKING, step_s=0.01)
        world.run(0.3)
        assert world.permit
        assert {n: world.value(n) for n in ("m", "u")} == {n: kept[n] for n in ("m", "u")}
        assert world.error_usteps == pytest.approx(error_usteps, abs=REPEATS_USTEPS)
        # To the last bit, as if there had been no cut.
        wind(world, drum * 40_000, 4.0)
        at = world.read("m", "u", "pattern_edges")
        ideal = orbit.after(kept["pattern_edges"] + at["pattern_edges"])
        assert (at["m"], at["u"]) == (ideal.m, ideal.u)
        assert world.truth.slipped_usteps == 0
        assert "los" not in world.flags
    assert reversals > PLACES / 20


@DRUMS
def test_without_it_all_is_as_today(drum: int):
    for seed in range(10):
        world = machine(seed, resume=0)
        fresh = world.read("m", "u")
        wind(world, drum * 40_000, 1.0 + 0.3 * seed)
        assert world.read("resume_position_um", "resume_direction") == {
            "resume_position_um": 0,
            "resume_direction": 0,
        }
        power_cut(world)
        world.index()
        assert world.state == State.TRACKING
        assert world.value("position_um") == pytest.approx(PARKED_UM, abs=20)
        assert world.value("u") == fresh["u"]
        assert "resume_doubtful" not in world.flags


def kept_at(seed: int = 3) -> tuple[World, int]:
    """A machine after a launch and a power cut, and where its rope goes on."""
    world = machine(seed)
    wind(world, 40_000, 2.0 + seed / 10)
    at_um = world.value("position_um")
    power_cut(world)
    return world, at_um


def ends_at_the_flange(world: World) -> bool:
    world.index()
    world.run_until(lambda: world.state == State.TRACKING, step_s=0.01)
    return abs(world.value("position_um") - PARKED_UM) <= 100


def test_a_drum_that_turned_before_the_indexing_is_told_and_not_taken_up():
    world, _ = kept_at()
    world.write(standing_turns_permille=0)
    wind(world, 2_000, 0.5)
    assert "resume_doubtful" in world.flags
    # It stays so over another power cut, and is over when the carriage has followed again.
    power_cut(world)
    assert "resume_doubtful" in world.flags
    assert ends_at_the_flange(world)
    world.run(0.5)
    assert "resume_doubtful" not in world.flags
    assert world.value("resume_direction") == 1


def test_a_drum_that_rocks_by_less_than_the_lay_shows_is_no_doubt():
    world, at_um = kept_at()
    world.inject(PlantFault.ENCODER_DITHER, 20)
    world.run(1.0)
    assert not ends_at_the_flange(world)
    assert world.value("position_um") == at_um


def test_a_power_cut_in_a_launch_is_noticed_by_where_the_carriage_stands():
    """Nothing can be stored while the drum turns: what is stored is from before the launch."""
    doubts = 0
    for seed in range(1, 7):
        world = machine(seed)
        wind(world, 40_000, 1.5)
        world.drum(30_000)
        world.run(1.0 + 0.25 * seed)
        world.write(bench_command=BenchCommand.POWER_CUT)
        world.drum(0, edges_per_s2=1e6)
        world.run(1.0)
        doubts += ends_at_the_flange(world)
    assert doubts == 6


def test_a_carriage_moved_by_hand_is_noticed():
    world, _ = kept_at()
    world.mode(Mode.OFF)
    world.run(0.1)
    world.inject(PlantFault.PLACE_CARRIAGE_UM, -40_000)
    world.run(0.1)
    world.mode(Mode.TRACK)
    world.run(0.01)
    assert ends_at_the_flange(world)


def test_an_indexing_that_was_stopped_and_jogging_lose_nothing():
    world, at_um = kept_at()
    for _ in range(20):
        world.write(jog=-1)
        world.run(0.1)
    world.write(jog=0)
    world.run(1.0)
    world.write(command=Command.INDEX)
    world.run(0.5)
    world.write(command=Command.STOP)
    world.run(1.0)
    assert world.state == State.UNINDEXED
    assert not ends_at_the_flange(world)
    assert world.value("position_um") == at_um


def test_a_stop_on_the_way_there_holds_and_the_mode_lets_it_go_on():
    world, at_um = kept_at()
    world.command(Command.INDEX)
    world.run_until(lambda: world.state == State.CENTRING)
    world.run(0.05)
    world.write(command=Command.STOP)
    world.run_until(lambda: world.state == State.READY)
    assert world.value("position_um") != at_um
    world.run(1.0)
    assert world.state == State.READY
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING, step_s=0.01)
    assert world.value("position_um") == at_um


@DRUMS
def test_with_another_trim_it_goes_on_in_the_sweep(drum: int):
    """A live trim is over with the power: the state in a reversal of then is on no orbit of now."""
    world = machine()
    world.drum(drum * 20_000)
    world.run_until(world.in_sweep)
    world.write(trim_plus_um=-1_500, trim_minus_um=1_500)
    world.run_until(lambda: world.value("u") * drum > 0 and world.value("position_um") > 70_000)
    world.drum(0, edges_per_s2=1e6)
    world.run(0.5)
    kept = world.read("position_um", "u")
    power_cut(world)
    world.index()
    world.run_until(lambda: world.state == State.TRACKING, step_s=0.01)
    assert world.value("u") * kept["u"] > 0
    assert abs(world.value("u")) == world.value("ks")
    assert world.value("position_um") == pytest.approx(kept["position_um"], abs=20)
    orbit = world.orbit()
    wind(world, drum * 40_000, 5.0)
    world.check_follows(orbit)


def test_another_pattern_is_not_gone_on_in():
    world, _ = kept_at()
    world.apply(pitch_um=11_000)
    assert world.value("resume_direction") == 0
    assert ends_at_the_flange(world)
