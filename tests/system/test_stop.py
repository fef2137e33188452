# SPDX-License-Identifier: Apache-2.0
"""STOP, and going on after it: from wherever the carriage was left, the slope comes out right."""

import pytest
from levelwind.map_table import Command, Fault, Mode, Reason, Result, State
from world import PlantFault, RequestRefusedError, World


def follow(world: World) -> None:
    """A sweep and its reversals at 20,000 edges/s; the carriage stays on the pattern."""
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING)
    orbit = world.orbit()
    ks = world.value("ks")
    world.drum(20_000)
    for _ in range(400):
        world.run(0.01)
        world.check_follows(orbit)
        assert abs(world.value("u")) <= ks
    world.stop_drum()
    assert "los" not in world.flags
    assert world.permit


@pytest.mark.parametrize("distance_edges", [0, 500, 20_000, 40_000, 41_000])
def test_stop_at_rest_then_track_again(distance_edges: int) -> None:
    """Parked in a reversal, leaving it, in the sweep, and inside the other reversal."""
    world = World().index()
    if distance_edges:
        world.drum(20_000, 200_000)
        world.run_until(lambda: world.value("pattern_edges") >= distance_edges)
        world.drum(0, 4_000_000)
        world.run_until(lambda: "drum_at_rest" in world.flags)
    before = world.read("m", "u")
    assert world.command(Command.STOP) == Result.DONE
    world.run(1)
    assert world.state == State.READY
    assert world.read("m", "u") == before
    assert not world.permit
    follow(world)


@pytest.mark.parametrize("direction", [-1, 1])
def test_jog_from_the_flange_then_track(direction: int) -> None:
    world = World().index()
    world.write(jog=direction)
    world.run_until(lambda: world.state == State.TRACKING, step_s=0.01)
    follow(world)


def test_resting_outside_of_a_trimmed_sweep_goes_inside_first() -> None:
    world = World(jog_hold_ms=5_000, jog_rate_edges_per_s=50_000).index()
    world.command(Command.STOP)
    while world.value("position_um") < 79_900:
        world.write(jog=1)
        world.run(0.01)
    world.run_until(lambda: world.state == State.READY)
    world.write(trim_plus_um=-500)
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING)
    assert 79_400 < world.value("position_um") < 79_500
    follow(world)


def test_stop_with_a_correction_held_in_a_reversal() -> None:
    world = World().index()
    world.drum(20_000)
    world.run_until(world.in_sweep)
    world.inject(PlantFault.SLIP_USTEPS, -400)  # the switch triggers inside the reversal
    world.run_until(lambda: "correction_pending" in world.flags)
    world.drum(0, 4_000_000)
    world.run_until(lambda: "drum_at_rest" in world.flags)
    assert "correction_pending" in world.flags
    world.command(Command.STOP)
    assert world.state == State.READY
    assert abs(world.error_usteps) < 30
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING)
    orbit = world.orbit()
    world.drum(20_000)
    for _ in range(400):
        world.run(0.01)
        world.check_follows(orbit)
    assert abs(world.error_usteps) < 30


def test_stop_from_speed_loses_the_index() -> None:
    world = World().index()
    world.drum(20_000)
    world.run(2)
    world.command(Command.STOP)
    assert world.state == State.UNINDEXED
    assert not world.permit


@pytest.mark.parametrize("tolerance_um", [1_000, 5_000])
def test_index_with_a_dead_second_switch_ends(tolerance_um: int) -> None:
    """Also where the tolerance reaches past the far point of the reversal."""
    world = World(span_tolerance_um=tolerance_um)
    world.write(bench_switch_minus_fault=1)
    assert world.index_faulted() == Fault.INDEX_SPAN


def test_refused_trim_names_the_farthest_that_passes() -> None:
    world = World().index()
    for wanted in (5_000, -5_000):
        with pytest.raises(Exception, match="Modbus exception 03"):
            world.write(trim_plus_um=wanted)
        limit = world.value("last_error_limit")
        assert 0 <= limit / wanted < 1
        world.write(trim_plus_um=limit)
        with pytest.raises(Exception, match="Modbus exception 03"):
            world.write(trim_plus_um=limit + (1 if wanted > 0 else -1))


def test_stopped_is_told() -> None:
    world = World().index()
    assert "held" not in world.flags
    world.command(Command.STOP)
    assert "held" in world.flags
    world.mode(Mode.TRACK)
    assert "held" not in world.flags


def test_commands_of_a_request_come_last() -> None:
    """A trim that the staged set would refuse does not slip in beside its APPLY."""
    world = World().index()
    world.command(Command.STOP)
    world.write(flange_plus_um=82_600)
    world.write(command=Command.APPLY, mode=Mode.TRACK, jog=0, trim_plus_um=400, trim_minus_um=0)
    assert world.value("command_result") == Result.DONE
    assert world.value("trim_plus_um") == 0
    assert world.value("reversal_plus_usteps") == 8_000


def test_apply_under_a_turning_drum_waits_for_rest() -> None:
    world = World()
    world.drum(5_000)
    world.run(1)
    world.write(encoder_invert_a=1)
    with pytest.raises(RequestRefusedError) as refused:
        world.write(command=Command.APPLY)
    assert refused.value.reason == Reason.DRUM_MOVING
    world.write(encoder_invert_a=0, rope_per_drum_rev_um=2_000_000)
    assert world.command(Command.APPLY) == Result.DONE


def test_clear_fault_while_jogging_away_leaves_no_nameless_fault() -> None:
    world = World().index()
    world.write(bench_overtravel_minus=1)
    world.run_until(lambda: world.state == State.FAULT)
    world.write(jog=1)
    world.run(0.1)
    world.write(bench_overtravel_minus=0)
    world.run(0.1)
    world.command(Command.CLEAR_FAULT)
    world.run_until(lambda: world.state != State.JOGGING)
    assert (world.state, world.fault) == (State.UNINDEXED, Fault.NONE)


def test_a_trim_may_not_break_the_debounce_rule() -> None:
    world = World(switch_contacts=1).index()
    with pytest.raises(RequestRefusedError):
        world.write(trim_plus_um=-600)
    assert world.value("last_error_reason") == Reason.DEBOUNCE_TOO_LONG
