# SPDX-License-Identifier: Apache-2.0
"""Restarts that nobody asked for: by a thread that hangs, by a power cut while saving."""

import errno
import random
import struct
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.cam.table import Table, from_words, words
from levelwind.map_table import (
    POINTS,
    BenchCommand,
    BenchRestart,
    BenchThread,
    CamBankState,
    Command,
    Flag,
    LaunchInhibit,
    Result,
)
from pymodbus.exceptions import ModbusException
from slave import UNIT, NullModem, RawLine, Simulator, Slave, sealed, start_native_sim_on

THREADS = [thread for thread in BenchThread if thread != BenchThread.NONE]
PATIENCE_S = 60
POWER_CUTS = 200
CAM_POWER_CUTS = 40
SAVE_TAKES_S = 0.03


def reconnect(slave: Slave, until: Callable[[Slave], bool]) -> None:
    """Ask until there is an answer that the slave is another one."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        slave.close()
        assert slave.client.connect()
        try:
            if until(slave):
                return
        except ModbusException:
            pass  # it has not begun to answer
    raise AssertionError("no restart")


@pytest.mark.parametrize("thread", THREADS, ids=lambda thread: thread.label)
def test_a_thread_that_hangs_or_fails_is_restarted(
    target: str, own_simulator: Callable[..., Simulator], thread: BenchThread
) -> None:
    if target == "sim":
        pytest.skip("the simulator has no threads")
    if target == "board":
        pytest.skip("the image that flies has no register to hang by; tests/board hangs it")
    slave = Slave(str(own_simulator().port))
    reconnect(slave, lambda slave: slave.flag(Flag.STEPPER_ENABLED))
    assert not slave.flag(Flag.WATCHDOG_RESET)
    assert slave.read("bench_restart") == BenchRestart.NONE
    slave.write("bench_hang", thread)
    reconnect(slave, lambda slave: slave.flag(Flag.WATCHDOG_RESET))
    assert slave.read("bench_restart") == BenchRestart.WITHOUT_CURRENT
    assert not slave.flag(Flag.INDEXED)
    assert slave.read("launch_inhibit") & 1 << LaunchInhibit.NOT_TRACKING
    # It works again, and the next restart is another one.
    slave.write("bench_command", BenchCommand.POWER_CUT)
    slave.wait(lambda: not slave.flag(Flag.WATCHDOG_RESET))
    slave.close()


def test_the_simulator_has_no_thread_to_hang(target: str, slave: Slave) -> None:
    if target != "sim":
        pytest.skip("the firmware has")
    assert slave.write("bench_hang", BenchThread.MODBUS) == 0
    assert slave.read("bench_result") == errno.ENOTSUP


def parameters(number: int) -> dict[str, int]:
    """A set that shows which it is in every value, from one end of the record to the other."""
    return {
        "rope_per_drum_rev_um": 2_000_000 + number,
        "los_recoveries_max": number,
        "master_timeout_ms": 60_000 - number,
    }


def stored_number(slave: Slave) -> int:
    """Which of the sets is stored; fails if it is a mixture."""
    stored = {name: slave.read(name, 2000) for name in parameters(0)}
    number = stored["los_recoveries_max"]
    assert stored == parameters(number)
    return number


def write_command(command: Command) -> bytes:
    """The frame that writes it, to be sent without waiting for an answer."""
    return sealed(
        bytes([UNIT, 6]) + POINTS["command"].address.to_bytes(2, "big") + bytes([0, command])
    )


def cut_power_after(
    running: Simulator, line: NullModem, flash: Path, frame: bytes, after_s: float
) -> bool:
    """Send a frame, kill the firmware so long after it: has anything been written?"""
    before = flash.read_bytes()
    raw = RawLine(str(running.port))
    raw.line.write(frame)
    time.sleep(after_s)
    running.process.kill()
    running.process.wait()
    raw.close()
    line.close()
    return flash.read_bytes() != before


def test_power_cuts_while_saving(target: str, tmp_path: Path) -> None:
    """Old or new, never a mixture, never indexed, wherever in the writing the power goes."""
    if target != "native_sim":
        pytest.skip("kills the firmware and keeps its flash")
    flash = tmp_path / "flash.bin"
    chance = random.Random(1)
    kept = torn = taken = old = 0
    changed = False

    for number in range(1, POWER_CUTS + 2):
        line = NullModem()
        running = start_native_sim_on(line, flash, speed=4)
        slave = Slave(str(running.port))
        reconnect(slave, lambda slave: not slave.flag(Flag.INDEXED))
        if number == 1:  # something old to be kept
            for name, value in parameters(0).items():
                assert slave.write(name, value) == 0
            assert slave.command(Command.APPLY) == Result.DONE
            assert slave.command(Command.SAVE) == Result.DONE
        else:
            found = stored_number(slave)
            assert found in (old, number - 1)
            assert not slave.flag(Flag.DEFAULTS_LOADED)
            taken += found != old
            kept += found == old
            torn += found == old and changed
            old = found
        for name, value in parameters(number).items():
            assert slave.write(name, value) == 0
        assert slave.write("command", Command.APPLY) == 0
        assert slave.read("command_result") == Result.DONE
        slave.close()
        changed = cut_power_after(
            running, line, flash, write_command(Command.SAVE), chance.uniform(0, SAVE_TAKES_S)
        )
    print(f"{kept - torn} cuts before the writing, {torn} into it, {taken} after it")
    # The cuts fell before, into, and after the writing.
    assert min(kept - torn, torn, taken) > 0, (kept, torn, taken)


def flat_table(number: int) -> Table:
    """As long as a table can be; it shows which it is in every row."""
    return Table(tuple((20 * i, number) for i in range(256)), name="flat", version=number)


def upload(slave: Slave, file: int, table: Table) -> None:
    """Write a bank and have it checked."""
    slave.close()
    raw = RawLine(str(slave.port))
    data = words(table)
    for at in range(0, len(data), 120):
        part = data[at : at + 120]
        group = struct.pack(f">BHHH{len(part)}H", 6, file, at, len(part), *part)
        request = bytes([21, len(group)]) + group
        assert raw.request(request) == request
    raw.close()
    assert slave.client.connect()
    assert slave.command(Command.CAM_CHECK) == Result.DONE


def table_in_force(slave: Slave) -> tuple[Table | None, int]:
    """The whole of it by FC20, its CRC compared; and the file of the other bank."""
    states = [slave.read("cam_bank_0_state"), slave.read("cam_bank_1_state")]
    if CamBankState.ACTIVE not in states:
        return None, 2
    bank = states.index(CamBankState.ACTIVE)
    slave.close()
    raw = RawLine(str(slave.port))
    data = b""
    while len(data) < 2 * len(words(flat_table(0))):
        at = len(data) // 2
        data += raw.request(struct.pack(">BBBHHH", 20, 7, 6, 2 + bank, at, 104))[4:]
    raw.close()
    assert slave.client.connect()
    return from_words(struct.unpack(f">{len(data) // 2}H", data)), 3 - bank


def test_power_cuts_while_a_cam_table_comes_into_force(target: str, tmp_path: Path) -> None:
    """The old table or the new one, whole, wherever in the writing the power goes."""
    if target != "native_sim":
        pytest.skip("kills the firmware and keeps its flash")
    flash = tmp_path / "flash.bin"
    chance = random.Random(2)
    kept = torn = taken = 0
    changed = False
    old = None

    for number in range(1, CAM_POWER_CUTS + 2):
        line = NullModem()
        running = start_native_sim_on(line, flash, speed=4)
        slave = Slave(str(running.port))
        reconnect(slave, lambda slave: not slave.flag(Flag.INDEXED))
        found, other = table_in_force(slave)
        if number > 1:
            assert found in (old, flat_table(number - 1))
            assert found is None or slave.read("cam_stored") == 1
            taken += found != old
            kept += found == old
            torn += found == old and changed
        old = found
        upload(slave, other, flat_table(number))
        slave.close()
        changed = cut_power_after(
            running,
            *(line, flash, write_command(Command.CAM_ACTIVATE)),
            chance.uniform(0, SAVE_TAKES_S / 2),
        )
    print(f"{kept - torn} cuts before the writing, {torn} into it, {taken} after it")
    assert min(kept - torn, taken) > 0, (kept, torn, taken)
