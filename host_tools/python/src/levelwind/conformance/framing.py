# SPDX-License-Identifier: Apache-2.0
"""Cases about frames: CRC, unit ids, lengths, pauses, noise."""

from collections.abc import Iterator

from levelwind.conformance.line import FRAME_MAX, sealed
from levelwind.conformance.slave import BROADCAST, Slave, word
from levelwind.conformance.suite import (
    Finding,
    NotApplicableError,
    case,
    deviation,
    expect_answer,
    expect_silence,
    fail,
    need_function,
    need_scratch,
)
from levelwind.conformance.survey import Found

PAUSE_TRIES = 20
NOISE = {
    "00": bytes(20),
    "55": b"\x55" * 20,
    "ff": b"\xff" * 20,
    "one byte": b"\x01",
    "text": b"The quick brown fox jumps over the lazy dog\r\n",
    "300 bytes": bytes(range(256)) + bytes(44),
}


@case("frame: wrong CRC", "SL 2.5.1.2")
def wrong_crc(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for at in (0, 1, 3, len(frame) - 2, len(frame) - 1):
        broken = bytearray(frame)
        broken[at] ^= 0x10
        yield from expect_silence(slave.raw(bytes(broken)).frame, f"byte {at} wrong")
    swapped = frame[:-2] + frame[:-3:-1]
    yield from expect_silence(slave.raw(swapped).frame, "CRC high byte first")


@case("frame: wrong CRC changes nothing", "SL 2.5.1.2")
def wrong_crc_changes_nothing(slave: Slave, found: Found) -> Iterator[Finding]:
    yield from _changes_nothing(slave, found, wrong_crc=True)


@case("frame: other units", "SL 2.2")
def other_units(slave: Slave, found: Found) -> Iterator[Finding]:
    for unit in (1, 2, slave.unit - 1, slave.unit + 1, 127, 128, 247, 248, 255):
        if unit not in (slave.unit, BROADCAST):
            answer = slave.raw(slave.frame(slave.baseline, unit=unit)).frame
            yield from expect_silence(answer, f"unit {unit}")


@case("frame: a write to another unit changes nothing", "SL 2.2")
def other_units_change_nothing(slave: Slave, found: Found) -> Iterator[Finding]:
    yield from _changes_nothing(slave, found, wrong_crc=False)


def _changes_nothing(slave: Slave, found: Found, wrong_crc: bool) -> Iterator[Finding]:
    address = need_scratch(found)
    before = slave.request(b"\x03" + word(address, 1)).pdu[2:]
    other = bytes([before[0], before[1] ^ 1])
    unit = slave.unit if wrong_crc else slave.unit % 247 + 1
    frame = bytearray(slave.frame(b"\x06" + word(address) + other, unit=unit))
    if wrong_crc:
        frame[-1] ^= 1
    yield from expect_silence(slave.raw(bytes(frame)).frame, "write")
    if slave.request(b"\x03" + word(address, 1)).pdu[2:] != before:
        yield fail("the register has changed")
        slave.request(b"\x06" + word(address) + before)


@case("broadcast: not answered", "SL 2.1")
def broadcast_not_answered(slave: Slave, found: Found) -> Iterator[Finding]:
    for pdu in (slave.baseline, b"\x63\x00", b"\x03" + word(0xFFFF, 2), b"\x08" + word(0, 1)):
        answer = slave.raw(slave.frame(pdu, unit=BROADCAST)).frame
        yield from expect_silence(answer, f"FC{pdu[0]:02d}")


@case("broadcast: FC06 is executed", "SL 2.1", function=6)
@case("broadcast: FC16 is executed", "SL 2.1", function=16)
def broadcast_executed(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    need_function(found, function)
    address = need_scratch(found)
    before = slave.request(b"\x03" + word(address, 1)).pdu[2:]
    other = bytes([before[0], before[1] ^ 1])
    head = {6: word(address), 16: word(address, 1) + b"\x02"}[function]
    pdu = bytes([function]) + head
    yield from expect_silence(slave.raw(slave.frame(pdu + other, unit=BROADCAST)).frame, "write")
    if slave.request(b"\x03" + word(address, 1)).pdu[2:] != other:
        yield deviation("not executed")
    slave.request(pdu + before)


@case("frame: shorter than 4 bytes", "SL 2.5.1.1")
def short_frames(slave: Slave, found: Found) -> Iterator[Finding]:
    unit = bytes([slave.unit])
    for frame in (unit, unit + slave.baseline[:1], unit + b"\x03\x00", sealed(unit), sealed(b"")):
        yield from expect_silence(slave.raw(frame).frame, f"{len(frame)} bytes")


@case("frame: every beginning of a request", "SL 2.5.1.1")
def truncated_frames(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for length in range(1, len(frame)):
        yield from expect_silence(slave.raw(frame[:length]).frame, f"first {length} bytes")
        if not slave.alive():
            yield fail(f"the request after the first {length} bytes was not answered")


@case("frame: 256 bytes", "SL 2.5.1.1")
def longest_frame(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 8)
    pdu = b"\x08" + word(0) + bytes(range(250))
    assert len(slave.frame(pdu)) == FRAME_MAX
    answer = slave.request(pdu)
    if answer.silent:
        yield deviation("FC08/00 with 125 data fields: no answer")
    elif not answer.exception:
        yield from expect_answer(answer, pdu)


@case("frame: longer than 256 bytes", "SL 2.5.1.1")
def too_long_frames(slave: Slave, found: Found) -> Iterator[Finding]:
    for length in (FRAME_MAX + 1, FRAME_MAX + 2, 300, 512):
        frame = sealed(bytes([slave.unit]) + slave.baseline + bytes(length - 3 - 5))
        assert len(frame) == length
        if slave.raw(frame).frame:
            yield deviation(f"{length} bytes: answered")
        if not slave.alive():
            yield fail(f"the request after {length} bytes was not answered")


@case("frame: in two pieces without a pause", "SL 2.5.1.1")
def two_pieces(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for cut in (1, 3, len(frame) - 1):
        received = slave.line.exchange([frame[:cut], frame[cut:]], 0, slave.timeout_s)
        if not slave.judge(received.frame, slave.baseline[0]).pdu:
            yield fail(f"cut after {cut} bytes: no answer")


@case("pause: under 1.5 characters inside a frame", "SL 2.5.1.1", low=0.4, high=1.4)
@case("pause: 1.5 to 3.5 characters inside a frame", "SL 2.5.1.1", low=1.8, high=3.2)
def short_pause(slave: Slave, found: Found, low: float, high: float) -> Iterator[Finding]:
    character_s = slave.line.character_s
    if character_s == 0:
        raise NotApplicableError("a pseudo terminal has no character times")
    frame = slave.frame(slave.baseline)
    # The standard fixes both times above 19200 baud: 750 us and 1750 us.
    unit_s = max(character_s, 0.0005)
    for _ in range(PAUSE_TRIES):
        received = slave.raw(frame[:4], frame[4:], pause_s=low * unit_s)
        if low * unit_s <= received.pause_s <= high * unit_s:
            break
    else:
        raise NotApplicableError(
            f"this computer cannot make a pause of {low * unit_s * 1e6:.0f} "
            f"to {high * unit_s * 1e6:.0f} us"
        )
    answered = bool(received.frame)
    if low < 1.5 and not answered:
        yield fail(f"no answer after a pause of {received.pause_s * 1e6:.0f} us")
    if low > 1.5 and answered:
        yield deviation(f"answered after a pause of {received.pause_s * 1e6:.0f} us")


@case("pause: a long one cuts a frame in two", "SL 2.5.1.1")
def long_pause(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for cut in (1, 4, len(frame) - 1):
        received = slave.raw(frame[:cut], frame[cut:], pause_s=slave.silence_s)
        if received.frame:
            yield deviation(f"{slave.silence_s * 1000:.0f} ms after {cut} bytes: answered")


@case("pause: half a frame, then a whole one", "SL 2.5.1.1")
def half_then_whole(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for cut in (1, 4, len(frame) - 1):
        received = slave.raw(frame[:cut], frame, pause_s=slave.silence_s)
        if not slave.judge(received.frame, slave.baseline[0]).pdu:
            yield fail(f"the request after {cut} bytes and a pause was not answered")


@case("noise: a request after it", "SL 2.5.1.1")
def request_after_noise(slave: Slave, found: Found) -> Iterator[Finding]:
    for name, noise in NOISE.items():
        yield from expect_silence(slave.raw(noise).frame, f"noise {name}")
        if not slave.alive():
            yield fail(f"the request after noise {name} was not answered")


@case("noise: joined to a request", "SL 2.5.1.1")
def noise_joined(slave: Slave, found: Found) -> Iterator[Finding]:
    frame = slave.frame(slave.baseline)
    for name, noisy in (
        ("before", b"\xff" + frame),
        ("behind", frame + b"\xff"),
        ("two requests", frame + frame),
    ):
        if slave.raw(noisy).frame:
            yield deviation(f"{name}: answered")
        if not slave.alive():
            yield fail(f"the request after noise {name} was not answered")


@case("answer: 50 in a row", "SL 2.4.2")
def many_in_a_row(slave: Slave, found: Found) -> Iterator[Finding]:
    answered = sum(slave.alive() for _ in range(50))
    if answered < 50:
        yield fail(f"{50 - answered} of 50 were not answered")
