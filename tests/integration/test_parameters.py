# SPDX-License-Identifier: Apache-2.0
"""Staged parameters, APPLY, REVERT, SAVE, FACTORY, and what survives a restart."""

import signal
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.line.parameter_sets import set_crc
from levelwind.map_table import POINTS, Command, Flag, Reason, Result, SlotState, State
from slave import Simulator, Slave

PARAMETERS = [point for point in POINTS.values() if point.block == "parameters"]


def test_write_changes_the_staged_set_only(slave: Slave) -> None:
    assert slave.write("pitch_um", 11_000) == 0
    assert slave.read("pitch_um") == 11_000
    assert slave.read("pitch_um", 1000) == 12_000
    assert slave.flag(Flag.STAGED)
    assert slave.command(Command.REVERT) == Result.DONE
    assert slave.read("pitch_um") == 12_000
    assert not slave.flag(Flag.STAGED)


def test_apply_swaps_the_whole_set(slave: Slave) -> None:
    slave.write("pitch_um", 11_000)
    slave.write("reversal_plus_um", 79_500)
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.read("pitch_um", 1000) == 11_000
    assert slave.read("reversal_plus_usteps") == 7_950
    assert slave.read("ks") == slave.read("ka") * slave.read("nr")
    assert not slave.flag(Flag.STAGED)
    assert slave.flag(Flag.DIRTY)


def test_the_tool_and_the_controller_name_a_set_alike(slave: Slave) -> None:
    changes = {"pitch_um": 11_000, "switch_minus_um": -78_300, "baud_rate": 9600, "lock_code": 77}
    for name, value in changes.items():
        slave.write(name, value)
    assert slave.command(Command.APPLY) == Result.DONE
    active = {point.name: slave.read(point.name, 1000) for point in PARAMETERS}
    assert slave.read("active_crc") == set_crc(active)
    assert slave.read("active_crc") != set_crc(active | {"pitch_um": 12_000})
    assert slave.flag(Flag.NOT_ACCEPTED)
    slave.write("unlock", 77)
    slave.write("accepted_crc", set_crc(active))
    assert slave.command(Command.APPLY) == Result.DONE
    assert not slave.flag(Flag.NOT_ACCEPTED)


def test_refused_apply_leaves_the_active_set(slave: Slave) -> None:
    slave.write("pitch_um", 11_000)
    slave.write("switch_plus_um", 81_000)  # outside of the reversal at 80,000
    assert slave.command(Command.APPLY) == Result.REFUSED
    assert slave.read("command_reason") == Reason.SWITCH_PLUS_OUTSIDE
    assert slave.read("command_address") == POINTS["switch_plus_um"].address
    assert slave.read("command_value") == 81_000
    assert slave.read("command_limit") == 80_000
    assert slave.read("pitch_um", 1000) == 12_000
    assert slave.read("switch_plus_um", 1000) == 78_400


@pytest.mark.parametrize("point", PARAMETERS, ids=lambda point: point.name)
def test_limits_of_every_parameter(slave: Slave, point) -> None:
    before = slave.read(point.name)
    lowest = -(1 << (16 * point.words - 1)) if point.type.startswith("i") else 0
    highest = (1 << (16 * point.words - point.type.startswith("i"))) - 1
    outside = [value for value in (point.min - 1, point.max + 1) if lowest <= value <= highest]
    if point.allowed:
        outside += [value + 1 for value in point.allowed if value + 1 not in point.allowed]
    for value in outside:
        assert slave.write(point.name, value) == 3, value
        assert slave.read("last_error_reason") == Reason.OUT_OF_RANGE
        assert slave.read("last_error_address") == point.address
        assert slave.read("last_error_value") == value
        assert slave.read(point.name) == before
    for value in point.allowed or (point.min, point.max):
        assert slave.write(point.name, value) == 0, value
        shown = slave.read(point.name)
        assert shown == (before if point.secret and value == point.max else value)
    assert slave.command(Command.REVERT) == Result.DONE


def test_factory_scopes(slave: Slave) -> None:
    slave.write("pitch_um", 11_000)
    slave.write("unit_id", 9)
    assert slave.command(Command.FACTORY_LINE) == Result.DONE
    assert (slave.read("pitch_um"), slave.read("unit_id")) == (11_000, 1)
    slave.write("unit_id", 9)
    assert slave.command(Command.FACTORY_MOTION) == Result.DONE
    assert (slave.read("pitch_um"), slave.read("unit_id")) == (12_000, 9)
    assert slave.command(Command.FACTORY_ALL) == Result.DONE
    assert slave.read("unit_id") == 1


def test_parameters_are_refused_while_tracking(slave: Slave) -> None:
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    assert slave.write("pitch_um", 11_000) == 6
    assert slave.read("last_error_reason") == Reason.BUSY_TRACKING
    for command in (Command.APPLY, Command.SAVE, Command.REVERT, Command.FACTORY_ALL):
        assert slave.command(command) == Result.REFUSED
        assert slave.read("command_reason") == Reason.BUSY_TRACKING
    assert slave.read("pitch_um") == 12_000


def test_save_survives_a_kill(
    target: str, own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    if target == "qemu":
        pytest.skip("the emulated board keeps its parameters in RAM")
    storage = tmp_path / "parameters.bin"
    first = own_simulator(storage)
    slave = Slave(str(first.port))
    assert slave.flag(Flag.DEFAULTS_LOADED)
    slave.write("pitch_um", 11_000)
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.command(Command.SAVE) == Result.DONE
    assert not slave.flag(Flag.DIRTY)
    slave.write("pitch_um", 10_000)
    assert slave.command(Command.APPLY) == Result.DONE  # not saved
    slave.close()
    first.stop(signal.SIGKILL)

    second = own_simulator(storage)
    slave = Slave(str(second.port))
    for offset in (0, 1000, 2000):
        assert slave.read("pitch_um", offset) == 11_000
    assert not slave.flag(Flag.DEFAULTS_LOADED)
    slave.close()
    assert second.stop() == 0


def test_save_that_fails_says_so(target: str, own_simulator: Callable[..., Simulator]) -> None:
    if target != "sim":
        pytest.skip("only the simulator's storage can be made to fail: a full device")
    running = own_simulator(Path("/dev/full"))
    slave = Slave(str(running.port))
    assert slave.command(Command.SAVE) == Result.FAILED
    assert slave.read("command_reason") == Reason.STORAGE_FAILED
    assert slave.read("slot_0") == SlotState.DAMAGED
    slave.close()
    assert running.stop() == 0


def test_damaged_records_leave_the_older_set_then_the_factory_values(
    target: str, own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    if target != "sim":
        pytest.skip("only the simulator's storage is a plain file")
    storage = tmp_path / "parameters.bin"
    running = own_simulator(storage)
    slave = Slave(str(running.port))
    for pitch_um in (11_000, 10_000):
        slave.write("pitch_um", pitch_um)
        assert slave.command(Command.APPLY) == Result.DONE
        assert slave.command(Command.SAVE) == Result.DONE
    for damaged_um, left_um in ((10_000, 11_000), (11_000, 12_000)):
        slave.close()
        running.stop(signal.SIGKILL)
        raw = bytearray(storage.read_bytes())
        entry = struct.pack(">Hi", POINTS["pitch_um"].address, damaged_um)
        raw[raw.index(entry) + 5] ^= 1
        storage.write_bytes(raw)
        running = own_simulator(storage)
        slave = Slave(str(running.port))
        assert slave.read("pitch_um", 1000) == left_um
        assert slave.flag(Flag.DEFAULTS_LOADED) == (left_um == 12_000)
        assert slave.read("slot_1") == SlotState.DAMAGED
    assert slave.read("slot_0") == SlotState.DAMAGED
    slave.close()
    assert running.stop() == 0


def test_a_record_of_schema_1_is_converted_and_kept_until_the_second_save(
    target: str, own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    if target != "sim":
        pytest.skip("only the simulator's storage is a plain file")
    later = ("breaker_millirev", "breaker_cycles", "switch_delay_us")
    points = [p for p in PARAMETERS if p.address <= 183 and p.name not in later]
    values = [point.default + (point.name == "rope_per_drum_rev_um") for point in points]
    old = struct.pack(f"<4sHH{len(points)}i", b"LWPS", 1, len(points), *values)
    old += struct.pack("<I", zlib.crc32(old))
    storage = tmp_path / "parameters.bin"
    storage.write_bytes(old)
    running = own_simulator(storage)
    slave = Slave(str(running.port))
    assert slave.read("rope_per_drum_rev_um", 2000) == 2_400_001
    assert slave.read("slot_0") == SlotState.OLDER
    assert slave.read("record_schema") == 1
    assert not slave.flag(Flag.DEFAULTS_LOADED)
    assert slave.command(Command.SAVE) == Result.DONE
    assert slave.read("record_schema") == 2
    assert storage.read_bytes().startswith(old)
    assert slave.command(Command.SAVE) == Result.DONE
    assert not storage.read_bytes().startswith(old)
    slave.close()
    assert running.stop() == 0
