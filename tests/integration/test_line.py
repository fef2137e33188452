# SPDX-License-Identifier: Apache-2.0
"""What comes over a line that is not as it should be: answers of others, late bytes."""

import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.map_table import Command, Flag, Result, State
from slave import UNIT, RawLine, Simulator, Slave, sealed, start_simulator

STOP = bytes.fromhex("06 0000 0002")
READ_SELF_TEST = bytes.fromhex("04 0000 0002")
SELF_TEST_ANSWER = bytes.fromhex("04 04 12345678")


@pytest.mark.parametrize("unit", [UNIT, 0])
@pytest.mark.parametrize(
    "pdu",
    ["84 02", "81 01", "90 06", "ff 00", "80 01", "03 02 0001", "10 0072 0002", "11 03 4c0041"],
)
def test_an_answer_of_another_device_is_no_request(
    slave: Slave, raw: RawLine, pdu: str, unit: int
) -> None:
    requests, error = slave.read("requests"), slave.read("last_error_function")
    assert raw.request(bytes.fromhex(pdu), unit) == b""
    assert slave.read("requests") == requests + 2  # the two readings
    assert slave.read("last_error_function") == error
    assert slave.write("master_timeout_ms", 200) == 0
    assert slave.command(Command.APPLY) == Result.DONE
    for _ in range(3):
        assert raw.request(bytes.fromhex(pdu), unit) == b""
    # Nobody has asked for longer than the time-out, whatever else was on the line.
    assert raw.request(bytes.fromhex("02 0013 0001")) == bytes.fromhex("02 01 01")


def test_a_repeated_write_is_done_again(slave: Slave, raw: RawLine) -> None:
    sequence = slave.read("command_sequence")
    for _ in range(5):
        assert raw.request(STOP) == STOP
        time.sleep(0.05)
    assert slave.read("command_sequence") == (sequence + 5) & 0xFFFF


def test_a_request_to_a_program_that_stood_still_is_dropped(
    target: str, own_simulator: Callable[..., Simulator]
) -> None:
    if target != "sim":
        pytest.skip("the time of the others stands still with them")
    simulator = own_simulator()
    slave = Slave(str(simulator.port))
    raw = RawLine(str(simulator.port))
    sequence = slave.read("command_sequence")
    simulator.process.send_signal(signal.SIGSTOP)
    raw.line.write(sealed(bytes([UNIT]) + STOP))
    time.sleep(1.2)
    simulator.process.send_signal(signal.SIGCONT)
    time.sleep(0.3)
    assert raw.line.read(8) == b""
    assert slave.read("command_sequence") == sequence
    assert raw.request(STOP) == STOP


def test_a_frame_in_two_lots_of_a_usb_adapter_needs_a_longer_silence(
    target: str, tmp_path: Path
) -> None:
    if target != "sim":
        pytest.skip("an option of the simulator")
    for options, answer in (((), b""), (("--frame-silence-ms", "40"), SELF_TEST_ANSWER)):
        simulator = start_simulator(tmp_path, tmp_path / "parameters.bin", False, *options)
        raw = RawLine(str(simulator.port))
        frame = sealed(bytes([UNIT]) + READ_SELF_TEST)
        raw.line.write(frame[:3])
        time.sleep(0.016)
        assert raw.exchange(frame[3:])[1:-2] == answer
        raw.close()
        assert simulator.stop() == 0


def test_babble_on_the_line_does_not_end_a_launch(
    target: str, own_simulator: Callable[..., Simulator]
) -> None:
    if target == "board":
        pytest.skip("more bytes than its line carries would wait; what it carries: tests/board")
    simulator = own_simulator()
    slave = Slave(str(simulator.port))
    raw = RawLine(str(simulator.port))
    slave.write("bench_drum_acceleration_millirpm_per_s", 100_000_000)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    slave.write("bench_drum_speed_millirpm", 200_000)
    before = slave.read_run("uptime_ms", "state", "net_edges")
    resets, errors = slave.read("watchdog_resets"), slave.read("crc_errors")
    end = time.monotonic() + 4
    while time.monotonic() < end:
        raw.line.write(b"\x55" * 16)
        time.sleep(0.0015)
    time.sleep(0.1)
    assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER
    after = slave.read_run("uptime_ms", "state", "net_edges")
    assert slave.read("watchdog_resets") == resets
    # Not all of the 4 s: where the processor is short, the simulator lets time go.
    assert after["uptime_ms"] - before["uptime_ms"] > 1000
    assert after["state"] == State.TRACKING
    assert after["net_edges"] - before["net_edges"] > 20_000
    assert slave.read("crc_errors") > errors


def test_a_request_soon_after_the_answer_of_another_slave_is_heard(
    own_simulator: Callable[..., Simulator], target: str
) -> None:
    raw = RawLine(str(own_simulator().port))
    silence_s = {"sim": 0.002, "native_sim": 0.010, "board": 0.030, "qemu": 0.030}[target]
    other = sealed(bytes.fromhex("09 04 04 0001 0002"))
    for _ in range(50):
        raw.line.write(other)
        time.sleep(4 * silence_s)
        assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER
