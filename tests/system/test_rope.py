# SPDX-License-Identifier: Apache-2.0
"""Rope laid while the carriage stands, and what needs a look: told until somebody has looked."""

import pytest
from levelwind.line import event_log
from levelwind.map_table import BenchCommand, Command, Event, LaunchInhibit, Mode, State
from world import RequestRefusedError, World

DRUM_EDGES_PER_S = 4800  # 100 drum turns a minute


def log(world: World) -> list[event_log.LogRecord]:
    """The event log, by its sequence numbers."""
    answer = b""
    for first in range(0, event_log.RECORDS * event_log.WORDS, 112):
        count = min(112, event_log.RECORDS * event_log.WORDS - first)
        request = bytes([20, 7, 6, 0, 1, *first.to_bytes(2, "big"), 0, count])
        answer += world.request(request)[4:]
    records = [event_log.LogRecord(*fields) for fields in event_log.LAYOUT.iter_unpack(answer)]
    return sorted((r for r in records if r.sequence), key=lambda record: record.sequence)


def events(world: World) -> list[Event]:
    """What happened."""
    return [Event(record.event) for record in log(world)]


def power_cut(world: World) -> None:
    """Off, and on again; the drum stands."""
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.4)


def overtravel(world: World) -> None:
    """The plus overtravel switch, for a moment."""
    world.write(bench_overtravel_plus=1)
    world.run(1.0)
    world.write(bench_overtravel_plus=0)


def alarm(world: World) -> None:
    """The stepper driver's alarm, for a moment."""
    world.write(bench_stepper_alarm=1)
    world.run(1.0)
    world.write(bench_stepper_alarm=0)


def stop(world: World) -> None:
    """The command stop in mid-launch."""
    world.command(Command.STOP)
    world.run(1.0)


def overspeed(world: World) -> None:
    """Faster than the trip, for a moment."""
    world.drum(61_000, 1e6)
    world.run_until(lambda: world.state == State.FAULT)
    world.drum(DRUM_EDGES_PER_S, 1e6)
    world.run(1.0)


@pytest.mark.parametrize("cause", [overtravel, alarm, stop, overspeed], ids=lambda c: c.__name__)
def test_rope_hauled_in_behind_a_standing_carriage_is_told_and_an_indexing_is_not_enough(cause):
    world = World().index()
    assert world.permit
    world.drum(DRUM_EDGES_PER_S)
    world.run(3.0)
    cause(world)
    world.stop_drum()
    assert "rope_laid_standing" in world.flags
    assert world.value("rope_standing_millirev") > 1500
    assert world.value("rope_standing_place_known") == 1
    assert Event.ROPE_LAID_STANDING in events(world)
    with pytest.raises(RequestRefusedError, match="06, rope_index_first"):
        world.command(Command.ACKNOWLEDGE_ROPE)

    world.mode(Mode.TRACK)
    world.index()
    assert world.state == State.TRACKING
    assert world.value("launch_inhibit") == 1 << LaunchInhibit.ROPE_LAID_STANDING
    power_cut(world)
    world.index()
    assert world.value("launch_inhibit") == 1 << LaunchInhibit.ROPE_LAID_STANDING
    world.command(Command.ACKNOWLEDGE_ROPE)
    assert world.permit
    assert world.value("rope_standing_millirev") == 0
    assert Event.ROPE_ACKNOWLEDGED in events(world)


@pytest.mark.parametrize("mode", [Mode.OFF, Mode.CENTRE], ids=lambda m: m.label)
def test_where_the_mode_means_it_nothing_is_told(mode: Mode):
    world = World().index()
    world.mode(mode)
    world.run(10.0)
    world.drum(DRUM_EDGES_PER_S)
    world.run(3.0)
    world.stop_drum()
    assert "rope_laid_standing" not in world.flags


def test_an_unindexed_carriage_stands_too():
    world = World()
    world.drum(-DRUM_EDGES_PER_S)  # pulled out by hand: nothing is laid
    world.run(3.0)
    assert "rope_laid_standing" not in world.flags
    world.drum(DRUM_EDGES_PER_S)
    world.run(3.0)
    world.stop_drum()
    assert "rope_laid_standing" in world.flags
    assert world.value("rope_standing_place_known") == 0


def lose_synchronization(world: World) -> None:
    """In a launch; then the drum rests."""
    world.drum(20_000)
    world.run(1.0)
    world.write(bench_argument=400, bench_command=BenchCommand.SLIP)
    world.run_until(lambda: "los" in world.flags)
    world.run(1.0)
    world.stop_drum()


def test_a_loss_of_synchronization_is_not_forgotten_over_a_power_cut():
    world = World(los_recoveries_max=0).index()
    lose_synchronization(world)
    assert world.state == State.TRACKING
    kinds = {flag for flag in world.flags if flag.startswith("los")}
    place = world.read("los2_plus_position_um", "los2_minus_position_um")
    world.run(0.1)
    power_cut(world)
    assert {flag for flag in world.flags if flag.startswith("los")} == kinds
    assert world.read("los2_plus_position_um", "los2_minus_position_um") == place
    assert world.value("look_before_power_up") != 0
    assert world.value("launch_inhibit") >> LaunchInhibit.LOS & 1
    assert world.index().permit
    world.run(0.1)
    power_cut(world)
    assert "los" not in world.flags


def test_the_loss_is_in_the_log_although_the_state_stayed_tracking():
    world = World(los_recoveries_max=0).index()
    lose_synchronization(world)
    world.run(30.0)
    newest = world.value("log_sequence")
    power_cut(world)
    kinds = {Event.LOS1_PLUS, Event.LOS1_MINUS, Event.LOS2_PLUS, Event.LOS2_MINUS}
    assert kinds & set(events(world))
    assert world.value("log_sequence") > newest


@pytest.mark.parametrize("after_s", [0.25, 0.5, 1.0, 3.0, 30.0])
def test_no_number_of_an_event_is_given_anew(after_s: float):
    world = World().index()
    given: list[event_log.LogRecord] = []
    for _ in range(4):
        world.drum(20_000)
        for _ in range(5):
            world.command(Command.STOP)
        world.run(after_s)
        given += [r for r in log(world) if r not in given]
        world.drum(0, 1e6)
        power_cut(world)
    numbers = [record.sequence for record in given]
    assert len(numbers) == len(set(numbers))
