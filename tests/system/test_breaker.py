# SPDX-License-Identifier: Apache-2.0
"""The ribbon breaker on the machine: follows, retraces, and what of its cycle survives."""

import pytest
from levelwind.core.ideal_screw import Screw
from levelwind.map_table import BenchCommand, Command, Mode, ParkAt, State
from world import RequestRefusedError, World

BREAKER = {"breaker_millirev": 200, "breaker_cycles": 8}
PERIOD_EDGES = 81_558  # of the factory pattern without it


def cycles(world: World) -> tuple[int, int]:
    """Far points passed, modulo the breaker's cycles."""
    at = world.read("breaker_cycle_plus", "breaker_cycle_minus")
    return at["breaker_cycle_plus"], at["breaker_cycle_minus"]


def turn(world: World, edges: int) -> None:
    """About so many edges, then rest."""
    world.drum(30_000 if edges > 0 else -30_000, 240_000)
    world.run(abs(edges) / 30_000)
    world.stop_drum()


@pytest.mark.parametrize("park", list(ParkAt), ids=lambda p: p.label)
def test_the_carriage_follows_and_retraces_it(park: ParkAt):
    world = World(**BREAKER, dwell_plus_millirev=30, park_at=park).index()
    assert cycles(world) == (0, 0)
    orbit = world.orbit()
    assert orbit.period_edges > 8 * PERIOD_EDGES
    for edges in (3 * PERIOD_EDGES, -PERIOD_EDGES, 9 * PERIOD_EDGES, -14 * PERIOD_EDGES):
        turn(world, edges)
        world.check_follows(orbit)
        ideal = orbit.after(world.value("pattern_edges"))
        assert cycles(world) == (ideal.cycle_plus, ideal.cycle_minus)
    assert world.permit
    assert abs(world.error_usteps) < 12


def test_the_reversals_are_longer_cycle_by_cycle():
    """The drum's way from far point to far point, counted on the machine."""
    world = World(**BREAKER).index()
    world.drum(30_000, 240_000)
    lengths, begin, last = [], None, world.value("breaker_cycle_plus")
    while len(lengths) < 9:
        world.run(0.0005)
        at = world.read("breaker_cycle_plus", "pattern_edges")
        if at["breaker_cycle_plus"] != last:
            if begin is not None:
                lengths.append(at["pattern_edges"] - begin)
            begin, last = at["pattern_edges"], at["breaker_cycle_plus"]
    # From leaving the plus far point to leaving it again: minus number k, then plus number k + 1.
    up = [0, 144, 288, 432, 576, 432, 288, 144]
    adds = [up[(k + 1) % 8] + up[(k + 1) % 8] for k in range(9)]
    for length, more in zip(lengths, adds, strict=True):
        assert abs(length - PERIOD_EDGES - more) < 60  # polled every half millisecond


def test_a_stop_and_going_on_keep_the_cycle():
    world = World(**BREAKER).index()
    turn(world, 3 * PERIOD_EDGES)
    before = world.read("m", "u", "breaker_cycle_plus", "breaker_cycle_minus")
    world.command(Command.STOP)
    assert world.state == State.READY
    world.mode(Mode.TRACK)
    world.run(0.01)
    assert world.state == State.TRACKING
    assert world.read("m", "u", "breaker_cycle_plus", "breaker_cycle_minus") == before
    assert cycles(world) != (0, 0)
    orbit = world.orbit()
    turn(world, -4 * PERIOD_EDGES)
    world.check_follows(orbit)


def test_a_correction_after_a_slip_keeps_the_cycle():
    world = World(**BREAKER).index()
    turn(world, 2 * PERIOD_EDGES)
    before = cycles(world)
    world.write(bench_argument=240, bench_command=BenchCommand.SLIP)
    turn(world, PERIOD_EDGES)
    assert "los" in world.flags
    assert cycles(world) == (before[0] + 1, before[1] + 1)


def test_an_indexing_and_a_hand_over_from_a_place_begin_anew():
    world = World(**BREAKER).index()
    turn(world, 3 * PERIOD_EDGES)
    assert cycles(world) != (0, 0)
    world.index()
    assert cycles(world) == (0, 0)
    turn(world, 3 * PERIOD_EDGES)
    world.mode(Mode.CENTRE)
    world.run_until(lambda: world.state == State.CENTRED, step_s=0.01)
    world.mode(Mode.TRACK)
    world.run(0.05)
    assert world.state == State.TRACKING
    assert cycles(world) == (0, 0)
    turn(world, 3 * PERIOD_EDGES)
    world.command(Command.STOP)
    world.command(Command.SAVE)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)
    world.index()
    assert cycles(world) == (0, 0)
    assert world.value("active.breaker_cycles") == 8


def test_a_trim_keeps_the_cycle():
    world = World(**BREAKER).index()
    turn(world, 2 * PERIOD_EDGES)
    before = cycles(world)
    world.write(trim_plus_um=-500)
    turn(world, PERIOD_EDGES // 8)
    assert "trim_pending" not in world.flags
    assert before[0] <= cycles(world)[0] <= before[0] + 1


def test_one_cycle_is_refused_and_names_the_limit():
    world = World()
    world.write(breaker_millirev=200, breaker_cycles=1)
    world.command(Command.APPLY)
    at = world.read("command_reason", "command_value", "command_limit")
    assert at == {"command_reason": 48, "command_value": 1, "command_limit": 2}


def test_buttons_shift_the_reversal_ahead_by_the_step():
    world = World(trim_step_um=300).index()
    world.drum(5_000)
    world.run_until(lambda: world.in_sweep() and world.value("u") > 0, step_s=0.01)
    world.run(0.05)
    for name, plus_um in (("bench_trim_early", -300), ("bench_trim_late", 0)):
        world.write(**{name: 1})
        world.run(0.5)
        world.write(**{name: 0})
        world.run(0.05)
        assert world.value("trim_plus_um") == plus_um
    world.write(bench_trim_early=1)
    world.run(0.05)
    assert world.value("trim_plus_um") == -300
    orbit_end = world.value("reversal_plus_usteps")
    assert orbit_end == 7970
    world.write(bench_trim_early=0)
    world.stop_drum()
    world.command(Command.STOP)
    with pytest.raises(RequestRefusedError, match="trim_not_following"):
        world.command(Command.TRIM_LATE)


def test_an_orbit_without_the_breaker_is_not_this_one():
    """The check of the check: the ideal screw without the breaker is elsewhere soon."""
    world = World(**BREAKER).index()
    orbit = world.orbit()
    plain = Screw(**{**vars(orbit.screw), "breaker_edges": 0, "breaker_cycles": 0})
    turn(world, 3 * PERIOD_EDGES)
    net = world.value("pattern_edges")
    start = orbit.state_at_phase(orbit.phase)
    assert plain.orbit(start).after(net).m != orbit.after(net).m
