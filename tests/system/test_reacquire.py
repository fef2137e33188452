# SPDX-License-Identifier: Apache-2.0
"""A restart in a launch: the turning drum is taken up, and the carriage re-indexed on its way."""

import random

import pytest
from levelwind.map_table import BenchCommand, Command, Fault, Mode, Result, State, SwitchFault
from world import World

PLACES = 100  # for each direction of the drum
DELAY_US = 1_500  # of the plant's switches
REINDEX_USTEPS = 5  # what a re-index on a switch is off at the most, its delay taken out
OVERTRAVEL_UM = 86_000
DRUMS = pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])


def machine(seed: int = 1, **parameters: int) -> World:
    """A machine with its parameters saved, following the drum."""
    parameters = {
        "index_rate_edges_per_s": 40_000,
        "switch_delay_us": DELAY_US,
        "reacquire_after_restart": 1,
    } | parameters
    world = World(seed, carriage_um=137 * seed % 60_000, **parameters)
    assert world.command(Command.SAVE) == Result.DONE
    return world.index()


def restart(world: World) -> None:
    """As the watchdog does it; the drum turns on."""
    world.write(bench_command=BenchCommand.RESTART)
    world.run(0.002)


def traverses(world: World, edges: int) -> float:
    """How many times from end to end so many edges lead."""
    at = world.read("ks", "nr", "reversal_plus_usteps", "reversal_minus_usteps")
    sweep_usteps = at["reversal_plus_usteps"] - at["reversal_minus_usteps"]
    return abs(edges) / (sweep_usteps * 65536 / at["ks"] + 2 * at["nr"])


def to_the_middle(world: World) -> None:
    """On a way through the sweep, at constant speed."""
    world.run_until(lambda: abs(world.value("position_um")) < 20_000, 120.0, 0.01)


@DRUMS
def test_restarted_at_200_places_it_is_taken_up_within_two_traverses(drum: int):
    chance = random.Random(60 + drum)
    taken_up = coasted = seed = 0
    while taken_up < PLACES:
        seed += 1
        world = machine(seed)
        world.drum(drum * chance.choice((48_000, chance.uniform(2_000, 48_000))), 1e5)
        world.run(chance.uniform(1.0, 6.0))
        restart(world)
        assert not world.permit
        world.run(0.25)
        assert world.value("steps") == 0  # from rest, not from where it coasts
        if world.state == State.FAULT:  # let go at speed, it came to the overtravel switch
            assert world.fault in (Fault.OVERTRAVEL_PLUS, Fault.OVERTRAVEL_MINUS)
            assert abs(world.truth.carriage_um) > OVERTRAVEL_UM - 2_000
            coasted += 1
            continue
        slips = world.truth.pole_slips
        world.run_until(lambda w=world: w.state == State.REACQUIRING)
        assert {"los", "reacquired"} <= world.flags
        world.run_until(lambda w=world: w.state != State.REACQUIRING, 120.0)
        assert world.state == State.TRACKING, f"{world}"
        assert traverses(world, world.value("net_edges")) < 2
        to_the_middle(world)
        assert abs(world.error_usteps) <= REINDEX_USTEPS, f"seed {seed}: {world}"
        # And it stays so, over both switches; nothing but an indexing gives the permit back.
        los = world.read(
            "los1_plus_count", "los1_minus_count", "los2_plus_count", "los2_minus_count"
        )
        assert not any(los.values()), f"seed {seed}: {los}"
        assert world.truth.pole_slips == slips
        assert not world.permit
        taken_up += 1
    assert coasted < PLACES / 2


@DRUMS
def test_it_goes_on_over_both_switches_and_only_an_indexing_ends_it(drum: int):
    world = machine()
    world.drum(drum * 48_000)
    world.run(4.0)
    to_the_middle(world)
    restart(world)
    world.run_until(lambda: world.state == State.TRACKING, 10.0)
    world.run(5.0)
    assert world.value("switch_plus_triggers") > 1
    assert world.value("switch_minus_triggers") > 1
    to_the_middle(world)
    assert abs(world.error_usteps) <= REINDEX_USTEPS
    assert not world.permit
    world.stop_drum()
    assert not world.permit
    world.index()
    world.write(command=Command.ACKNOWLEDGE_ROPE)
    world.run(0.01)
    assert world.permit
    assert "reacquired" not in world.flags


@DRUMS
@pytest.mark.parametrize("toward", [1, -1], ids=["plus", "minus"])
def test_it_goes_on_in_the_direction_that_was(drum: int, toward: int):
    world = machine()
    world.drum(drum * 10_000)
    world.run_until(
        lambda: (
            world.truth.carriage_um_per_s * toward > 30_000
            and abs(world.value("position_um")) < 10_000
        )
    )
    restart(world)
    world.run_until(lambda: world.state == State.REACQUIRING)
    world.run(0.5)
    assert world.truth.carriage_um_per_s * toward > 30_000


def test_after_a_power_cut_nothing_moves_unasked_and_the_command_takes_it_up():
    world = machine()
    world.drum(20_000)
    world.run(2.0)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(3.0)
    assert world.state == State.UNINDEXED
    assert world.value("steps") == 0
    assert world.command(Command.REACQUIRE) == Result.DONE
    assert world.state == State.TRACKING
    to_the_middle(world)
    assert abs(world.error_usteps) <= REINDEX_USTEPS


def test_without_the_parameter_nothing_moves_unasked():
    world = machine(reacquire_after_restart=0)
    world.drum(20_000)
    world.run(2.0)
    restart(world)
    world.run(3.0)
    assert world.state == State.UNINDEXED
    assert world.value("steps") == 0


def broken(toward: int, **bench: int) -> World:
    """Restarted in the middle, moving toward a side, with something broken; until it ends."""
    world = machine()
    world.drum(20_000)
    world.run_until(
        lambda: (
            world.truth.carriage_um_per_s * toward > 50_000
            and abs(world.value("position_um")) < 30_000
        )
    )
    restart(world)
    world.write(**bench)
    world.run_until(lambda: world.state != State.UNINDEXED)
    world.run_until(lambda: world.state != State.REACQUIRING, 20.0)
    return world


@pytest.mark.parametrize("toward", [1, -1], ids=["plus", "minus"])
def test_what_goes_wrong_has_a_name(toward: int):
    ahead, behind = ("plus", "minus") if toward > 0 else ("minus", "plus")
    stuck = SwitchFault.STUCK_RELEASED
    assert broken(toward, bench_stall=1).fault == Fault.REACQUIRE_NO_SWITCH
    reversed_motor = broken(toward, bench_direction_reversed=1)
    assert reversed_motor.fault == Fault.REACQUIRE_WRONG_SWITCH
    missing = broken(toward, **{f"bench_switch_{ahead}_fault": stuck})
    assert missing.fault == Fault[f"OVERTRAVEL_{ahead.upper()}"]
    actuated = {f"bench_switch_{behind}_fault": SwitchFault.STUCK_ACTUATED}
    world = broken(-toward, **{f"bench_switch_{ahead}_fault": SwitchFault.SHORTED})
    assert world.fault in (Fault.WIRING_PLUS, Fault.WIRING_MINUS)
    assert not world.permit
    # Taken for one that the carriage stands on, and goes away from: it does not release.
    world = broken(toward, **actuated)
    assert world.fault == Fault.REACQUIRE_WRONG_SWITCH
    assert {"los", "reacquired"} <= world.flags
    assert not world.permit


def test_a_launch_that_ends_before_the_switch_is_indexed_as_ever():
    world = machine()
    world.drum(20_000)
    to_the_middle(world)
    restart(world)
    world.run_until(lambda: world.state == State.REACQUIRING)
    world.stop_drum()
    assert world.state == State.REACQUIRING
    world.index()
    assert world.state == State.TRACKING
    assert "los" not in world.flags


def test_the_mode_waits_and_stop_ends_it():
    world = machine()
    world.drum(20_000)
    world.run(2.0)
    restart(world)
    world.run_until(lambda: world.state == State.REACQUIRING)
    world.mode(Mode.CENTRE)
    world.run(0.05)
    assert world.state == State.REACQUIRING
    world.write(command=Command.STOP)
    world.run(0.05)
    assert world.state == State.UNINDEXED
    steps = world.value("steps")
    world.run(2.0)
    assert world.value("steps") == steps
