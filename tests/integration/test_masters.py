# SPDX-License-Identifier: Apache-2.0
"""What is promised to every master: four of them, written by others, use the same slave."""

import os
import re
import subprocess
from collections.abc import Iterator

import pytest
from levelwind.line.points import lookup, runs
from levelwind.map_table import (
    POINTS,
    PRODUCT_CODE,
    PRODUCT_VERSION,
    VENDOR,
    Command,
    Reason,
    Result,
    State,
)
from masters import MASTERS, ExceptionAnswer, Libmodbus, Master, Pymodbus
from pymodbus.pdu.file_message import FileRecord
from slave import TEST_DIR, UNIT, Slave

SPACES = ("coil", "discrete", "holding", "input")
COPIES = ("active", "stored")


@pytest.fixture(params=MASTERS, ids=lambda kind: kind.__name__.lower())
def kind(request: pytest.FixtureRequest) -> type[Master]:
    return request.param


@pytest.fixture
def master(slave: Slave, kind: type[Master]) -> Iterator[Master]:
    """A master on the line of a slave at rest; nobody else has the port open."""
    slave.close()
    opened = kind(slave.port)
    yield opened
    opened.close()


def read_everything(master: Master) -> dict[tuple[str, int], int]:
    """Every register and bit of the map, in requests as long as they can be."""
    points = list(POINTS.values())
    points += [
        lookup(f"{copy}.{p.name}") for p in points if p.block == "parameters" for copy in COPIES
    ]
    values = {}
    for space in SPACES:
        for run in runs((p for p in points if p.space == space), 125):
            words = master.read(space, run.address, run.count)
            assert len(words) == run.count
            values |= {(space, run.address + i): word for i, word in enumerate(words)}
    return values


def read_point(master: Master, name: str) -> int:
    point = lookup(name)
    words = master.read(point.space, point.address, point.words)
    return int.from_bytes(b"".join(word.to_bytes(2, "big") for word in words), "big")


def write_point(master: Master, name: str, value: int) -> None:
    point = POINTS[name]
    words = [value >> 16 * (point.words - 1 - i) & 0xFFFF for i in range(point.words)]
    master.write(point.address, words)


def run_command(master: Master, command: Command) -> None:
    before = read_point(master, "command_sequence")
    write_point(master, "command", command)
    while read_point(master, "command_result") == Result.IN_PROGRESS:
        pass
    assert read_point(master, "command_sequence") == (before + 1) & 0xFFFF
    assert read_point(master, "command_code") == command
    assert read_point(master, "command_result") == Result.DONE


def test_full_read(slave: Slave, kind: type[Master]) -> None:
    """Whatever does not change by itself reads the same for every master."""
    slave.close()
    references = []
    for read_by in (Pymodbus, kind, Pymodbus):
        master = read_by(slave.port)
        references.append(read_everything(master))
        master.close()
    before, values, after = references
    steady = {at: value for at, value in before.items() if after[at] == value}
    assert len(steady) > 0.9 * len(before)
    assert {at: values[at] for at in steady} == steady


def test_parameter_change_apply_and_save(master: Master) -> None:
    for pitch_um in (11_000, 12_000):
        write_point(master, "pitch_um", pitch_um)
        assert read_point(master, "pitch_um") == pitch_um
        assert read_point(master, "active.pitch_um") != pitch_um
        run_command(master, Command.APPLY)
        assert read_point(master, "active.pitch_um") == pitch_um
        run_command(master, Command.SAVE)
        assert read_point(master, "stored.pitch_um") == pitch_um


def test_bad_requests(slave: Slave, kind: type[Master]) -> None:
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    slave.close()
    master = kind(slave.port)
    pitch = POINTS["pitch_um"].address
    for request, exception, reason in (
        (lambda: master.read("input", 50, 1), 2, Reason.UNKNOWN_ADDRESS),
        (lambda: master.read("holding", 100, 10), 2, Reason.UNKNOWN_ADDRESS),
        (lambda: master.write(50, [1]), 2, Reason.UNKNOWN_ADDRESS),
        (lambda: master.write(pitch, [0]), 2, Reason.HALF_OF_PAIR),
        (lambda: write_point(master, "encoder_pulses_per_rev", 0), 3, Reason.OUT_OF_RANGE),
        (lambda: write_point(master, "command", Command.SAVE), 6, Reason.BUSY_TRACKING),
        (lambda: write_point(master, "pitch_um", 11_000), 6, Reason.BUSY_TRACKING),
    ):
        with pytest.raises(ExceptionAnswer) as answer:
            request()
        assert answer.value.code == exception, reason
        assert read_point(master, "last_error_reason") == reason
        assert read_point(master, "last_error_exception") == exception
    assert read_point(master, "pitch_um") == 12_000
    master.close()


def test_pymodbus_and_the_other_functions(slave: Slave) -> None:
    """What only some masters know, in the words of pymodbus."""
    client = slave.client
    address = POINTS["encoder_pulses_per_rev"].address
    information = client.read_device_information(read_code=2, object_id=0, device_id=UNIT)
    assert [text.decode() for text in information.information.values()][:3] == [
        VENDOR,
        PRODUCT_CODE,
        PRODUCT_VERSION,
    ]
    assert information.conformity == 0x82
    server = client.report_device_id(device_id=UNIT)
    assert server.identifier.startswith(b"L\x00 " + VENDOR.encode())
    assert client.diag_query_data(b"\xa5\x37", device_id=UNIT).message == b"\xa5\x37"
    assert not client.diag_clear_counters(device_id=UNIT).isError()
    assert client.diag_read_bus_message_count(device_id=UNIT).message == 1
    answer = client.mask_write_register(
        address=address, and_mask=0xFF00, or_mask=0x0042, device_id=UNIT
    )
    assert not answer.isError()
    assert slave.read("encoder_pulses_per_rev") == 360 & 0xFF00 | 0x42
    answer = client.readwrite_registers(
        read_address=address, read_count=2, address=address, values=[500], device_id=UNIT
    )
    assert answer.registers == [500, 2]
    newest = slave.read("log_sequence")
    record = FileRecord(file_number=1, record_number=16 * (newest % 64), record_length=4)  # bytes
    answer = client.read_file_record([record], device_id=UNIT)
    assert int.from_bytes(answer.records[0].record_data, "big") == newest


def test_libmodbus_and_the_other_functions(slave: Slave) -> None:
    slave.close()
    master = Libmodbus(slave.port)
    address = POINTS["encoder_pulses_per_rev"].address
    assert master.report_server_id()[:2] == b"L\x00"
    assert master.mask_write(address, 0xFF00, 0x0042) == 1
    assert master.read("holding", address, 1) == [360 & 0xFF00 | 0x42]
    assert master.write_and_read(address, [500], address, 2) == [500, 2]
    master.close()


def test_libmodbus_client(slave: Slave) -> None:
    """The tests of the C client, run against this slave."""
    slave.close()
    done = subprocess.run(
        [str(TEST_DIR / "test_client")],
        env={**os.environ, "LEVELWIND_PORT": slave.port},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"^[1-9]\d* Tests 0 Failures 0 Ignored", done.stdout, re.M), done.stdout
