# SPDX-License-Identifier: Apache-2.0
"""The life of the controller over the line: indexing, tracking, losing synchronization, modes."""

from levelwind.map_table import (
    BenchCommand,
    Command,
    Fault,
    Flag,
    LaunchInhibit,
    Mode,
    Reason,
    Result,
    State,
)
from slave import Slave


def index(slave: Slave) -> None:
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)


def turn_drum(slave: Slave, millirpm: int) -> None:
    assert slave.write("bench_drum_acceleration_millirpm_per_s", 300_000) == 0
    assert slave.write("bench_drum_speed_millirpm", millirpm) == 0


def test_index_then_permit(slave: Slave) -> None:
    assert not slave.flag(Flag.LAUNCH_PERMIT)
    index(slave)
    assert slave.flag(Flag.INDEXED)
    assert slave.read("launch_inhibit") == 0
    assert slave.flag(Flag.LAUNCH_PERMIT)
    assert abs(slave.read("bench_carriage_um") - slave.read("position_um")) < 300


def test_follows_the_drum_both_ways(slave: Slave) -> None:
    index(slave)
    slipped = slave.read("bench_slipped_usteps")
    turn_drum(slave, 500_000)
    slave.wait(lambda: slave.read("pattern_edges") > 100_000)
    turn_drum(slave, -400_000)
    slave.wait(lambda: slave.read("pattern_edges") < 50_000)
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert not slave.flag(Flag.LOS)
    assert slave.read("bench_slipped_usteps") == slipped
    assert abs(slave.read("bench_carriage_um") - slave.read("position_um")) < 300
    assert slave.read("illegal_transitions") == 0


def test_hand_over_waits_for_the_drum_to_rest(slave: Slave) -> None:
    assert slave.write("mode", Mode.CENTRE) == 0
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.CENTRED)
    turn_drum(slave, 100_000)
    slave.wait(lambda: not slave.flag(Flag.DRUM_AT_REST))
    assert slave.write("mode", Mode.TRACK) == 0
    slave.settle(2_000)
    assert slave.read("state") == State.CENTRED
    assert abs(slave.read("position_um")) <= 10
    turn_drum(slave, 0)
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    assert slave.flag(Flag.DRUM_AT_REST)


def test_index_is_refused_while_the_drum_turns(slave: Slave) -> None:
    turn_drum(slave, 100_000)
    slave.wait(lambda: not slave.flag(Flag.DRUM_AT_REST))
    assert slave.command(Command.INDEX) == Result.REFUSED
    assert slave.read("command_reason") == Reason.DRUM_MOVING
    assert slave.read("state") == State.UNINDEXED


def test_lost_synchronization_is_told_until_indexed_again(slave: Slave) -> None:
    index(slave)
    turn_drum(slave, 400_000)
    slave.wait(lambda: slave.read("position_um") > 0)
    slave.write("bench_stall", 1)
    slave.wait(lambda: slave.flag(Flag.LOS))
    assert slave.read("los1_plus_count") + slave.read("los1_minus_count") > 0
    slave.write("bench_stall", 0)
    slave.wait(lambda: slave.read("los_recoveries") > 0)
    assert slave.read("state") == State.TRACKING
    assert slave.read("launch_inhibit") & 1 << LaunchInhibit.LOS
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert slave.flag(Flag.LOS)
    index(slave)
    assert not slave.flag(Flag.LOS)
    assert slave.flag(Flag.LAUNCH_PERMIT)


def test_jog_is_held_and_ends_by_itself(slave: Slave) -> None:
    assert slave.write("jog", 1) == 0
    slave.wait(lambda: slave.read("state") == State.JOGGING)
    slave.wait(lambda: slave.read("state") == State.UNINDEXED, 5_000)
    assert slave.read("jog") == 0


def test_stop_ends_indexing(slave: Slave) -> None:
    assert slave.write("command", Command.INDEX) == 0
    slave.wait(lambda: slave.read("state") == State.SEEKING)
    assert slave.command(Command.STOP) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.UNINDEXED, 5_000)
    assert not slave.flag(Flag.INDEXED)


def test_reversed_stepper_is_named(slave: Slave) -> None:
    slave.write("bench_direction_reversed", 1)
    assert slave.command(Command.INDEX) == Result.FAILED
    assert slave.read("command_reason") == Reason.FAULTED
    assert slave.read("fault") == Fault.INDEX_WRONG_SWITCH
    assert not slave.flag(Flag.LAUNCH_PERMIT)


def test_power_cut_forgets_the_index(slave: Slave) -> None:
    index(slave)
    slave.write("bench_command", BenchCommand.POWER_CUT)
    slave.wait(lambda: slave.read("state") == State.UNINDEXED)
    assert not slave.flag(Flag.INDEXED)
    assert not slave.flag(Flag.LAUNCH_PERMIT)


def test_all_setpoints_can_be_written_in_every_cycle(slave: Slave) -> None:
    def cycle() -> bool:
        words = [0, Mode.TRACK, 0, 0xFE0C, 500]  # command, mode, jog, trims -500 and +500 um
        answer = slave.client.write_registers(0, words, device_id=1)
        return not answer.isError()

    assert cycle()
    assert slave.write("command", Command.INDEX) == 0
    slave.wait(lambda: slave.read("state") == State.SEEKING)
    assert cycle()
    slave.wait(lambda: cycle() and slave.read("state") == State.TRACKING)
    assert slave.read("reversal_plus_usteps") == 7_950
    assert slave.read("reversal_minus_usteps") == -7_950


def test_lost_pulses_are_found_by_the_index_pulse(slave: Slave) -> None:
    turn_drum(slave, 400_000)
    pulses = slave.read("encoder_index_pulses")
    slave.wait(lambda: slave.read("encoder_index_pulses") > pulses + 5)
    missed = slave.read("missed_edges")
    slave.write("bench_argument", 3)
    slave.write("bench_command", BenchCommand.LOSE_PULSES)
    slave.wait(lambda: slave.read("missed_edges") != missed)
    assert slave.read("missed_edges") == missed + 3 * 2  # two edges per pulse
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert slave.read("missed_edges") == missed + 3 * 2


def test_stepper_alarm_is_a_fault(slave: Slave) -> None:
    slave.write("bench_stepper_alarm", 1)
    slave.wait(lambda: slave.read("fault") == Fault.STEPPER_ALARM)
    assert slave.read("launch_inhibit") & 1 << LaunchInhibit.STEPPER_ALARM
    assert slave.command(Command.CLEAR_FAULT) == Result.REFUSED
    slave.write("bench_stepper_alarm", 0)
    slave.wait(lambda: not slave.read("launch_inhibit") & 1 << LaunchInhibit.STEPPER_ALARM)
    assert slave.command(Command.CLEAR_FAULT) == Result.DONE
    index(slave)


def test_the_firmware_measures_itself_where_it_can(target: str, slave: Slave) -> None:
    """The interrupt's time and the stacks, in the emulator as on hardware."""
    names = [f"stack_free_{name}_bytes" for name in ("supervisor", "limits", "modbus", "storage")]
    names += ["stack_free_interrupts_bytes", "encoder_interrupt_max_ns"]
    if target in ("sim", "native_sim"):
        assert not any(slave.read(name) for name in names)
        return
    turn_drum(slave, 400_000)
    slave.wait(lambda: all(slave.read(name) for name in names))
    # What they may need at most is computed when the firmware is built: cmake/stack_bounds.py.
    assert min(slave.read(name) for name in names[:-1]) >= 100
