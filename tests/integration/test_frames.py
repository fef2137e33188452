# SPDX-License-Identifier: Apache-2.0
"""Frames and function codes, byte by byte."""

import pytest
from levelwind.map_table import (
    POINTS,
    PRODUCT_CODE,
    PRODUCT_NAME,
    PRODUCT_VERSION,
    VENDOR,
    Command,
    Flag,
    Reason,
    Result,
    State,
)
from slave import RawLine, Slave, sealed

SUPPORTED = {1, 2, 3, 4, 5, 6, 8, 15, 16, 17, 20, 21, 22, 23, 43}
READ_SELF_TEST = bytes.fromhex("04 0000 0002")
SELF_TEST_ANSWER = bytes.fromhex("04 04 12345678")


def word(value: int) -> bytes:
    return (value & 0xFFFF).to_bytes(2, "big")


def test_self_test_reads_high_word_first(raw: RawLine) -> None:
    assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER


def test_wrong_crc_other_unit_and_noise_stay_unanswered(slave: Slave, raw: RawLine) -> None:
    good = sealed(b"\x01" + READ_SELF_TEST)
    errors = slave.read("crc_errors")
    assert raw.exchange(good[:-1] + bytes([good[-1] ^ 1])) == b""
    assert raw.exchange(good[:3]) == b""
    assert raw.exchange(b"\x55" * 300) == b""
    assert raw.exchange(sealed(b"\x02" + READ_SELF_TEST)) == b""
    assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER
    assert slave.read("crc_errors") == errors + 3


@pytest.mark.parametrize("function", sorted(set(range(1, 128)) - SUPPORTED))
def test_unknown_functions(raw: RawLine, function: int) -> None:
    assert raw.request(bytes([function, 0, 0, 0, 1])) == bytes([function | 0x80, 1])


@pytest.mark.parametrize(
    ("pdu", "exception"),
    [
        ("01 0000 0000", 3),
        ("01 0000 07d1", 3),
        ("01 0000 000e", 2),
        ("02 0000 0000", 3),
        (f"02 0000 {len(Flag) + 1:04x}", 2),
        ("03 0000 0000", 3),
        ("03 0000 007e", 3),
        ("03 0000 007d", 2),
        ("03 0008 0001", 2),
        ("03 ffff 0002", 2),
        ("04 0000 0000", 3),
        ("04 0000 007e", 3),
        ("04 000B 0001", 2),
        ("05 0000 0001", 3),
        ("05 000d ff00", 2),
        ("06 0008 0000", 2),
        ("06 0072 0000", 2),  # half of pitch_um
        ("06 0001 0003", 3),  # no such mode
        ("0f 0000 0000 01 00", 3),
        ("0f 0000 0001 02 0000", 3),
        ("0f 0000 000e 02 0000", 2),
        ("10 0000 0000 00", 3),
        ("10 0064 0001 02 00", 3),
        ("10 0064 0001 03 000000", 3),
        ("16 0008 0000 0000", 2),
        ("17 0000 0000 0064 0001 02 0001", 3),
        ("17 0008 0001 0064 0001 02 0001", 2),
        ("03 0000", 3),
        ("03 0000 0001 00", 3),
        ("08 0009 0000", 1),
        ("08 0003 0000", 1),
        ("08 000b 0001", 3),
        ("11 00", 3),
        ("14 00", 3),
        ("14 07 05 0001 0000 0001", 2),
        ("14 07 06 ffff 0000 0001", 2),
        ("15 09 06 ffff 0000 0001 0000", 2),
        ("2b 0d", 1),
        ("2b 0e 05 00", 3),
        ("2b 0e 04 06", 2),
    ],
)
def test_bad_requests(slave: Slave, raw: RawLine, pdu: str, exception: int) -> None:
    request = bytes.fromhex(pdu)
    before = [slave.read(name) for name in ("mode", "encoder_pulses_per_rev", "pitch_um")]
    assert raw.request(request) == bytes([request[0] | 0x80, exception])
    assert slave.read("last_error_function") == request[0]
    assert slave.read("last_error_exception") == exception
    assert slave.read("last_error_reason") != Reason.NONE
    assert before == [slave.read(name) for name in ("mode", "encoder_pulses_per_rev", "pitch_um")]


def test_multi_register_write_is_all_or_nothing(slave: Slave, raw: RawLine) -> None:
    # encoder_pulses_per_rev 500 is fine, encoder_edges_per_pulse 3 is not
    assert raw.request(bytes.fromhex("10 0064 0002 04 01f4 0003")) == b"\x90\x03"
    assert slave.read("encoder_pulses_per_rev") == 360
    assert slave.read("last_error_address") == 101
    assert raw.request(bytes.fromhex("10 0064 0002 04 01f4 0004")) == bytes.fromhex("10 0064 0002")
    assert (slave.read("encoder_pulses_per_rev"), slave.read("encoder_edges_per_pulse")) == (500, 4)


def test_mask_write(slave: Slave, raw: RawLine) -> None:
    slave.write("encoder_pulses_per_rev", 0x0155)
    assert raw.request(bytes.fromhex("16 0064 00f0 000a")) == bytes.fromhex("16 0064 00f0 000a")
    assert slave.read("encoder_pulses_per_rev") == 0x015A & 0x00F0 | 0x000A & ~0x00F0


def test_read_write_writes_first(slave: Slave, raw: RawLine) -> None:
    assert raw.request(bytes.fromhex("17 0064 0001 0064 0001 02 0123")) == bytes.fromhex(
        "17 02 0123"
    )
    assert slave.read("encoder_pulses_per_rev") == 0x123


def test_broadcast_is_executed_and_not_answered(slave: Slave, raw: RawLine) -> None:
    assert raw.request(bytes.fromhex("06 0064 0123"), unit=0) == b""
    assert slave.read("encoder_pulses_per_rev") == 0x123
    assert raw.request(READ_SELF_TEST, unit=0) == b""


def test_diagnostics(slave: Slave, raw: RawLine) -> None:
    assert raw.request(bytes.fromhex("08 0000 a537")) == bytes.fromhex("08 0000 a537")
    assert raw.request(bytes.fromhex("08 000a 0000")) == bytes.fromhex("08 000a 0000")
    raw.exchange(b"\x01\x04\x00\x00\x00")
    assert raw.request(bytes.fromhex("08 000c 0000")) == bytes.fromhex("08 000c 0001")
    assert raw.request(bytes.fromhex("63")) == b"\xe3\x01"
    assert raw.request(bytes.fromhex("08 000d 0000")) == bytes.fromhex("08 000d 0001")


def test_listen_only_mode_ends_by_restart(slave: Slave, raw: RawLine) -> None:
    assert raw.request(bytes.fromhex("08 0004 0000")) == b""
    assert raw.request(READ_SELF_TEST) == b""
    assert raw.request(bytes.fromhex("08 0001 0000")) == b""
    assert raw.request(READ_SELF_TEST) == SELF_TEST_ANSWER


def test_server_id(slave: Slave, raw: RawLine) -> None:
    text = f" {VENDOR} {PRODUCT_CODE} {PRODUCT_VERSION}".encode()
    answer = raw.request(b"\x11")
    assert answer == bytes([0x11, 2 + len(text), ord("L"), 0x00]) + text
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)
    assert raw.request(b"\x11")[3] == 0xFF


def test_one_device_identification_object(raw: RawLine) -> None:
    head = bytes.fromhex("2b 0e 04 82 00 00 01 04")
    name = PRODUCT_NAME.encode()
    assert raw.request(bytes.fromhex("2b 0e 04 04")) == head + bytes([len(name)]) + name


@pytest.mark.parametrize("code", [1, 2, 3])
def test_device_identification(raw: RawLine, code: int) -> None:
    answer = raw.request(bytes([0x2B, 0x0E, code, 0]))
    assert answer[:3] == bytes([0x2B, 0x0E, code])
    objects = {}
    position = 7
    for _ in range(answer[6]):
        length = answer[position + 1]
        objects[answer[position]] = answer[position + 2 : position + 2 + length].decode()
        position += 2 + length
    assert position == len(answer)
    assert [objects[i] for i in range(3)] == [VENDOR, PRODUCT_CODE, PRODUCT_VERSION]
    assert (code == 1) == (4 not in objects)
    if code > 1:  # extended (3): nothing beyond the regular objects
        assert objects[4] == PRODUCT_NAME


def test_two_commands_in_one_request_are_refused(slave: Slave, raw: RawLine) -> None:
    sequence = slave.read("command_sequence")
    assert raw.request(bytes.fromhex("0f 0003 0002 01 03")) == b"\x8f\x03"
    assert slave.read("last_error_reason") == Reason.SEVERAL_COMMANDS
    assert slave.read("command_sequence") == sequence


def test_command_coil(slave: Slave, raw: RawLine) -> None:
    sequence = slave.read("command_sequence")
    address = word(POINTS["revert"].address)
    assert raw.request(b"\x05" + address + b"\x00\x00") == b"\x05" + address + b"\x00\x00"
    assert slave.read("command_sequence") == sequence
    assert raw.request(b"\x05" + address + b"\xff\x00") == b"\x05" + address + b"\xff\x00"
    assert slave.read("command_sequence") == sequence + 1
