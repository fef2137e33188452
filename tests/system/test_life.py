# SPDX-License-Identifier: Apache-2.0
"""Modes, hand-over, jogging, trim, dwell, and what stops a launch."""

import pytest
from levelwind.map_table import (
    BenchCommand,
    Command,
    Fault,
    LaunchInhibit,
    Mode,
    ParkAt,
    Reason,
    Result,
    Side,
    State,
)
from world import USTEP, PlantFault, RequestRefusedError, World

# ---- hand-over and modes -----------------------------------------------------------------------


@pytest.mark.parametrize("speed", [1_000, 30_000, -30_000])
@pytest.mark.parametrize("park", list(ParkAt), ids=lambda p: p.label)
def test_a_turning_drum_is_not_followed(speed: int, park: ParkAt):
    world = World(park_at=park)
    world.write(command=Command.INDEX)
    world.run(1.0)
    world.drum(speed)
    world.run_until(lambda: world.state == State.READY, step_s=0.01)
    before = world.read("steps", "m", "pattern_edges", "net_edges")
    for _ in range(50):
        world.run(0.1)
        assert world.state == State.READY
        assert not world.permit
    after = world.read("steps", "m", "pattern_edges", "net_edges")
    assert after.pop("net_edges") != before.pop("net_edges")
    assert after == before

    # Engaged at rest, it follows from there.
    world.stop_drum()
    world.run(0.01)
    assert world.state == State.TRACKING
    laid = speed > 0  # what was hauled in meanwhile lies in one heap
    assert world.value("launch_inhibit") == laid << LaunchInhibit.ROPE_LAID_STANDING
    orbit = world.orbit()
    world.drum(speed)
    world.run(4.0)
    world.check_follows(orbit)


@pytest.mark.parametrize("direction", list(Side), ids=lambda s: s.label)
def test_hand_over_direction(direction: Side):
    world = World(park_at=ParkAt.POSITION, handover_direction=direction).index()
    world.drum(2_000)
    world.run(1.0)
    assert (world.value("u") > 0) == (direction == Side.PLUS)
    assert (world.truth.carriage_um > 500) == (direction == Side.PLUS)


def test_mode_centre_waits_for_rest_and_holds_while_rope_is_pulled_out():
    world = World().index()
    world.drum(20_000)
    world.run(3.0)
    world.mode(Mode.CENTRE)
    world.run(1.0)
    assert world.state == State.TRACKING
    assert world.value("active_mode") == Mode.TRACK
    assert world.value("mode") == Mode.CENTRE
    world.drum(0)
    world.run_until(lambda: world.state == State.CENTRING, step_s=0.01)
    world.run_until(lambda: world.state == State.CENTRED, step_s=0.01)
    world.run(0.2)
    assert abs(world.value("position_um")) <= 10
    assert abs(world.truth.carriage_um) <= 100
    assert not world.permit

    before = world.read("steps", "m")
    world.drum(-20_000)
    world.run(10.0)
    assert world.read("steps", "m") == before
    assert world.value("rope_mm") < -50_000

    world.mode(Mode.TRACK)  # still turning
    world.run(1.0)
    assert world.state == State.CENTRED
    world.stop_drum()
    world.run(0.01)
    assert world.permit
    assert abs(world.error_usteps) < 12


def test_mode_off_takes_the_current_and_the_index():
    world = World().index()
    world.drum(20_000)
    world.run(2.0)
    world.mode(Mode.OFF)
    world.run(0.002)
    assert world.state == State.OFF
    assert world.flags.isdisjoint({"indexed", "launch_permit", "stepper_enabled", "tracking"})
    steps = world.value("steps")
    world.stop_drum()
    assert world.value("steps") == steps
    with pytest.raises(RequestRefusedError, match="06, mode_off"):
        world.command(Command.INDEX)
    world.mode(Mode.TRACK)
    world.run(0.01)
    assert world.state == State.UNINDEXED
    assert world.index().permit


# ---- jogging -----------------------------------------------------------------------------------


def hold_jog(world: World, direction: int, seconds: float) -> None:
    """Write the jog again as a panel does."""
    for _ in range(round(seconds / 0.1)):
        world.write(jog=direction)
        world.run(0.1)


@pytest.mark.parametrize("direction", [1, -1])
def test_jog_ends_at_the_reversal_points_and_keeps_the_index(direction: int):
    world = World()
    world.mode(Mode.CENTRE)
    world.index()
    world.run_until(lambda: world.state == State.CENTRED, step_s=0.01)
    world.mode(Mode.TRACK)
    for _ in range(60):
        world.write(jog=direction)
        world.run(0.1)
        assert abs(world.truth.carriage_um) < 80_100
    assert abs(world.value("position_um")) == pytest.approx(80_000, abs=40)
    assert abs(world.error_usteps) < 12
    assert "indexed" in world.flags
    world.write(jog=0)
    world.run(0.5)
    assert world.permit  # handed over again
    orbit = world.orbit()
    world.drum(20_000)
    world.run(10.0)
    world.check_follows(orbit)
    assert "los" not in world.flags


@pytest.mark.parametrize("direction", [1, -1])
def test_jog_without_index_ends_at_the_switch(direction: int):
    world = World(1, 40_000 * direction)
    with pytest.raises(RequestRefusedError, match="06"):
        hold_jog(world, direction, 4.0)  # time enough to the end stop
    world.run(0.5)
    assert world.state == State.UNINDEXED
    assert 78_400 <= abs(world.truth.carriage_um) < 82_000
    with pytest.raises(RequestRefusedError, match="06, limit_switch"):
        world.write(jog=direction)
    hold_jog(world, -direction, 1.0)
    assert abs(world.truth.carriage_um) < 77_000


def test_jog_ends_by_itself_when_it_is_not_written_again():
    world = World()
    world.write(jog=1)
    assert world.run_until(lambda: world.state == State.JOGGING, 0.01) <= 0.01
    stopped_s = world.run_until(lambda: world.state == State.UNINDEXED)
    ramp_s = 1187 / 5000
    assert 0.5 <= stopped_s <= 0.5 + ramp_s + 0.02
    assert world.value("jog") == 0


# ---- trim and dwell ----------------------------------------------------------------------------


def farthest_um(world: World, seconds: float) -> tuple[int, int]:
    """Reported extremes; checks the slope in the sweep on the way."""
    ks, least, most = world.value("ks"), 10**6, -(10**6)
    for _ in range(round(seconds / 0.002)):
        world.run(0.002)
        at = world.read("position_um", "u")
        least, most = min(least, at["position_um"]), max(most, at["position_um"])
        if world.in_sweep():
            assert abs(at["u"]) == ks
    return least, most


def test_trim_moves_the_reversals_and_only_in_the_sweep():
    world = World().index()
    world.drum(20_000)
    world.run_until(lambda: world.value("position_usteps") > 8100)  # inside the plus reversal
    world.write(trim_plus_um=-1000, trim_minus_um=800)
    world.run(0.002)
    assert "trim_pending" in world.flags
    assert world.value("reversal_plus_usteps") == 8000
    world.run_until(lambda: "trim_pending" not in world.flags, 0.5)
    assert world.in_sweep()
    assert world.value("reversal_plus_usteps") == 7900
    assert farthest_um(world, 5.0) == pytest.approx((-79_200 - 2_470, 79_000 + 2_470), abs=25)
    assert world.permit
    assert "los" not in world.flags

    world.write(trim_plus_um=0, trim_minus_um=0)
    world.run(3.0)
    assert farthest_um(world, 5.0) == pytest.approx((-80_000 - 2_470, 80_000 + 2_470), abs=25)
    assert abs(world.error_usteps) < 20

    with pytest.raises(RequestRefusedError, match="03, overshoot_beyond_flange_plus"):
        world.write(trim_plus_um=800)
    with pytest.raises(RequestRefusedError, match="03, switch_plus_outside"):
        world.write(trim_plus_um=-1600)


@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_dwell_is_exact(drum: int):
    world = World(dwell_plus_millirev=500, dwell_minus_millirev=250).index()
    assert world.read("dwell_plus_edges", "dwell_minus_edges") == {
        "dwell_plus_edges": 1440,
        "dwell_minus_edges": 720,
    }
    orbit = world.orbit()
    world.drum(drum * 24_000)
    for _ in range(100):
        world.run(0.0713)
        world.check_follows(orbit)
    assert world.permit


# ---- what stops a launch -----------------------------------------------------------------------


def test_overspeed():
    world = World().index()
    world.drum(50_000)
    world.run(3.0)
    assert "overspeed_warning" not in world.flags
    world.drum(56_000)
    world.run(1.0)
    assert {"overspeed_warning", "tracking", "launch_permit"} <= world.flags
    world.drum(61_000)
    world.run_until(lambda: "overspeed_trip" in world.flags, 1.0)
    assert (world.state, world.fault) == (State.FAULT, Fault.OVERSPEED)
    assert world.value("launch_inhibit") >> LaunchInhibit.OVERSPEED & 1
    steps = world.value("steps")
    world.stop_drum()
    assert world.value("steps") == steps
    assert "overspeed_trip" in world.flags
    world.command(Command.CLEAR_FAULT)
    assert world.flags.isdisjoint({"overspeed_trip", "faulted", "indexed", "launch_permit"})
    assert not world.index().permit  # what was hauled in meanwhile lies in one heap
    assert world.command(Command.ACKNOWLEDGE_ROPE) == Result.DONE
    assert world.permit


@pytest.mark.parametrize(("side", "sign"), [("plus", 1), ("minus", -1)])
@pytest.mark.parametrize("drum", [1, -1], ids=["in", "out"])
def test_overtravel_in_a_launch(side: str, sign: int, drum: int):
    world = World().index()
    world.drum(drum * 20_000)
    world.run_until(lambda: world.value("u") * sign * drum > 0 and world.in_sweep())
    world.run(0.3)
    world.write(**{f"bench_overtravel_{side}": 1})
    steps = world.value("steps")
    world.run(0.002)
    assert (world.state, world.fault) == (State.FAULT, Fault[f"OVERTRAVEL_{side.upper()}"])
    assert world.value("steps") == steps  # blocked in the interrupt, not by the next tick
    assert world.flags.isdisjoint({"stepper_enabled", "launch_permit", "indexed"})
    world.stop_drum()
    with pytest.raises(RequestRefusedError, match="06, cause_present"):
        world.command(Command.CLEAR_FAULT)
    with pytest.raises(RequestRefusedError, match="06, overtravel"):
        world.write(jog=sign)
    assert world.value("steps") == steps


@pytest.mark.parametrize(("side", "sign"), [("plus", 1), ("minus", -1)])
def test_out_of_overtravel_by_jogging(side: str, sign: int):
    world = World(1, sign * 87_500)
    world.run(0.1)
    assert world.fault == Fault[f"OVERTRAVEL_{side.upper()}"]
    with pytest.raises(RequestRefusedError, match="06, overtravel"):
        world.write(jog=sign)
    hold_jog(world, -sign, 1.0)
    world.write(jog=0)
    world.run(0.5)
    assert abs(world.truth.carriage_um) < 85_000
    assert world.command(Command.CLEAR_FAULT) == Result.DONE
    assert world.index().permit


def test_stepper_alarm_in_a_launch():
    world = World().index()
    world.drum(20_000)
    world.run(1.0)
    world.write(bench_stepper_alarm=1)
    world.run(0.004)
    assert (world.state, world.fault) == (State.FAULT, Fault.STEPPER_ALARM)
    assert world.value("launch_inhibit") & 1 << LaunchInhibit.STEPPER_ALARM
    steps = world.value("steps")
    world.run(1.0)
    assert world.value("steps") == steps
    world.stop_drum()
    with pytest.raises(RequestRefusedError, match="06, cause_present"):
        world.command(Command.CLEAR_FAULT)
    world.write(bench_stepper_alarm=0)
    world.run(0.004)
    world.command(Command.CLEAR_FAULT)
    assert "rope_laid_standing" in world.index().flags
    assert world.command(Command.ACKNOWLEDGE_ROPE) == Result.DONE
    assert world.permit


def test_stepper_alarm_at_power_up():
    world = World()
    world.write(bench_stepper_alarm=1, bench_command=BenchCommand.POWER_CUT)
    world.run(0.01)
    assert world.fault == Fault.STEPPER_ALARM
    assert not world.permit


def test_too_many_recoveries_stop_the_launch():
    world = World(los_recoveries_max=2).index()
    world.drum(20_000)
    for recovery in range(1, 4):
        world.run_until(lambda: world.in_sweep() and abs(world.value("position_um")) < 20_000)
        # Back from the side that it goes to: noticed as too late by its switch.
        away = -1 if world.truth.carriage_um_per_s > 0 else 1
        world.inject(PlantFault.SLIP_USTEPS, away * 200)
        count = world.value("los2_plus_count") + world.value("los2_minus_count")
        world.run_until(
            lambda n=count: world.value("los2_plus_count") + world.value("los2_minus_count") > n
        )
        world.run(0.2)
        if recovery <= 2:
            assert world.state == State.TRACKING
            assert world.value("los_recoveries") == recovery
    assert (world.state, world.fault) == (State.FAULT, Fault.LOS_LIMIT)
    assert not world.permit


def test_a_silent_master_takes_the_permit_not_the_launch():
    world = World(master_timeout_ms=1000).index()
    world.drum(20_000)
    world.run(0.9)
    assert world.permit
    world.run(1.1)
    orbit_steps = world.value("steps")
    assert world.value("launch_inhibit") == 1 << LaunchInhibit.MASTER_LOST
    assert world.state == State.TRACKING
    world.run(0.1)  # the master is heard again
    assert world.value("steps") > orbit_steps
    assert world.permit


def test_stop_in_a_launch_loses_the_index_and_at_rest_keeps_it():
    world = World().index()
    world.write(command=Command.STOP)
    world.run(1.0)
    assert world.state == State.READY
    assert "indexed" in world.flags
    world.mode(Mode.TRACK)
    world.run_until(lambda: world.permit, 5.0)
    world.drum(20_000)
    world.run(2.0)
    world.write(command=Command.STOP)
    world.run(0.01)
    assert world.state == State.UNINDEXED
    assert not world.permit


# ---- power cut ---------------------------------------------------------------------------------


@pytest.mark.parametrize("moment", range(20))
def test_power_cut_at_any_moment(moment: int):
    """Also within a SAVE: the old set or the new one, and never an index."""
    world = World(seed=moment + 1)
    world.write(command=Command.INDEX)
    world.run(0.43 * moment)
    if world.state == State.TRACKING:
        world.drum(15_000)
        world.run(0.31 * (moment % 7))
        world.stop_drum()
        world.write(command=Command.STOP)
        world.run(0.01)
    elif moment % 2:
        world.write(command=Command.STOP)
        world.run(0.5)
    saving = moment % 4 != 0 and world.state in (State.READY, State.UNINDEXED)
    if saving:
        world.apply(rope_per_drum_rev_um=2_000_000)
        world.write(command=Command.SAVE)
        world.run((moment % 4 - 1) * 0.0007)
    saved = world.value("command_result") == Result.DONE and saving
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.05)
    assert world.value("uptime_ms") <= 50
    assert world.value("command_sequence") == 0
    assert world.state in (State.UNINDEXED, State.FAULT)
    assert world.flags.isdisjoint({"indexed", "tracking", "launch_permit", "staged", "dirty"})
    assert world.value("active.rope_per_drum_rev_um") == (2_000_000 if saved else 2_400_000)
    assert ("defaults_loaded" in world.flags) == (not saved)
    steps = world.value("steps")
    world.run(1.0)
    assert world.value("steps") == steps
    assert world.index().permit


def test_power_cut_in_a_launch():
    world = World().index()
    world.drum(20_000)
    world.run(2.0)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(1.0)
    assert world.state == State.UNINDEXED
    assert world.value("steps") == 0
    with pytest.raises(RequestRefusedError) as refused:
        world.command(Command.INDEX)
    assert refused.value.reason == Reason.DRUM_MOVING
    assert world.value("net_edges") * USTEP > 0


# ---- from rest inside a reversal back to the drum ------------------------------------------------


def stop_by_command(world: World, sign: int) -> None:
    """Stop, then track again."""
    world.write(command=Command.STOP)
    world.run(0.1)
    world.mode(Mode.TRACK)


def jog_outward(world: World, sign: int) -> None:
    """Jog past the limit of a jog."""
    world.write(jog=sign)
    world.run(0.1)
    world.write(jog=0)


def trim_while_held(world: World, sign: int) -> None:
    """Stop a jog near its limit, then trim the reversal to the other side of the carriage."""
    hold_jog(world, -sign, 0.5)
    world.write(jog=0)
    world.run(1.0)
    world.write(jog=sign)
    while sign * world.value("position_um") < 79_600:
        world.run(0.01)
        world.write(jog=sign)
    world.write(command=Command.STOP)
    world.run(0.5)
    assert world.state == State.READY
    world.write(trim_plus_um=-1000, trim_minus_um=1000)
    world.mode(Mode.TRACK)


@pytest.mark.parametrize("leave", [stop_by_command, jog_outward, trim_while_held])
@pytest.mark.parametrize("sign", [1, -1], ids=["plus", "minus"])
@pytest.mark.parametrize("direction", list(Side), ids=lambda s: s.label)
def test_hand_over_of_a_carriage_that_rests_in_a_reversal(leave, sign: int, direction: Side):
    world = World(handover_direction=direction).index()
    world.drum(10_000, edges_per_s2=1e6)
    world.run_until(lambda: sign * world.value("position_um") > 82_200)
    world.drum(0, edges_per_s2=1e6)
    world.run(0.5)
    assert sign * world.value("position_um") > 81_000
    leave(world, sign)
    world.run_until(lambda: world.permit, 5.0, 0.01)
    ks = world.value("ks")
    world.drum(20_000)
    for _ in range(4000):
        world.run(0.002)
        assert abs(world.value("u")) <= ks
        assert abs(world.value("position_um")) <= 82_480  # reversal point and overshoot
        if world.in_sweep():
            assert abs(world.value("u")) == ks
    assert world.permit
    assert abs(world.error_usteps) < 20
