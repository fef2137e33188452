# SPDX-License-Identifier: Apache-2.0
"""Cases about diagnostics, identification, files, and functions that nobody has."""

from collections.abc import Iterator

from levelwind.conformance.slave import BROADCAST, Answer, Slave, word, words
from levelwind.conformance.suite import (
    RECOVERY_ATTEMPTS,
    Finding,
    NotApplicableError,
    case,
    deviation,
    expect_answer,
    expect_exception,
    expect_refusal,
    fail,
    need_function,
)
from levelwind.conformance.survey import Found

PUBLIC_FUNCTIONS = {1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 15, 16, 17, 20, 21, 22, 23, 24, 43}
SILENT_MAX = 6
FILES = range(1, 11)
REFERENCE_TYPE = 6


# ---- functions that nobody has -------------------------------------------------------------------


@case("unknown functions", "AP 7", data=b"\x00\x00\x00\x01")
@case("unknown functions without data", "AP 7", data=b"")
@case("unknown functions with 252 bytes of data", "AP 7", data=bytes(252))
def unknown_functions(slave: Slave, found: Found, data: bytes) -> Iterator[Finding]:
    silent = []
    refused = 0
    wanted = sorted(set(range(1, 128)) - PUBLIC_FUNCTIONS)
    for function in wanted if len(data) < 252 else wanted[:3]:
        answer = slave.optional(bytes([function]) + data)
        if answer.silent:
            silent.append(function)
        elif answer.malformed:
            yield fail(f"FC{function:02d}: {answer}")
        elif answer.exception not in (0, 1):
            yield deviation(f"FC{function:02d}: {answer}, not exception 01")
        refused += bool(answer.exception)
        if len(silent) == SILENT_MAX and not refused:
            break
    if silent:
        shown = ", ".join(f"{function:02d}" for function in silent[:SILENT_MAX])
        yield deviation(f"no answer to FC{shown}{' ...' if len(silent) >= SILENT_MAX else ''}")


@case("unsupported public functions", "AP 7")
def unsupported_functions(slave: Slave, found: Found) -> Iterator[Finding]:
    if found.functions >= PUBLIC_FUNCTIONS:
        raise NotApplicableError("all are supported")
    for function in sorted(found.silent_functions):
        yield deviation(f"no answer to FC{function:02d}, exception 01 expected")


@case("function codes 0 and above 127", "AP 4.1")
def invalid_codes(slave: Slave, found: Found) -> Iterator[Finding]:
    for function in (0x00, 0x80, 0x81, 0x83, 0xFF):
        answer = slave.optional(bytes([function]) + word(0, 1))
        # An exception cannot be told from a normal answer here: the top bit is set already.
        refusal = answer.exception == 1 or answer.pdu == bytes([function | 0x80, 1])
        if not (answer.silent or refusal):
            yield fail(f"{function:02x}: {answer}")


@case("FC07, FC11, FC12: the form", "AP 6.7, 6.9, 6.10")
def small_functions(slave: Slave, found: Found) -> Iterator[Finding]:
    sizes = {7: 2, 11: 5}
    present = sorted(found.functions & {7, 11, 12})
    if not present:
        raise NotApplicableError("none is supported")
    for function in present:
        answer = slave.request(bytes([function]))
        size = sizes.get(function) or (2 + answer.pdu[1] if len(answer.pdu) > 1 else 0)
        if len(answer.pdu) != size:
            yield fail(f"FC{function:02d}: {answer}")


# ---- FC08, diagnostics ---------------------------------------------------------------------------


def _need_sub(slave: Slave, found: Found, *subs: int) -> None:
    need_function(found, 8)
    for sub in subs:
        if not slave.request(b"\x08" + word(sub, 0)).pdu:
            raise NotApplicableError(f"FC08/{sub:02d} is not supported")


def _counter(slave: Slave, sub: int) -> int:
    answer = slave.request(b"\x08" + word(sub, 0))
    return words(answer.pdu[1:])[1] if len(answer.pdu) == 5 else -1


@case("FC08/00: echo", "AP 6.8")
def echo(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 8)
    for data in (0x0000, 0xA537, 0xFFFF):
        pdu = b"\x08" + word(0, data)
        yield from expect_answer(slave.request(pdu), pdu, f"{data:04x}")


@case("FC08: unknown sub-functions", "AP 6.8")
def unknown_sub_functions(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 8)
    for sub in (5, 9, 22, 0x00FF, 0x7FFF, 0xFFFF):
        yield from expect_exception(slave.optional(b"\x08" + word(sub, 0)), 1, f"{sub}")


@case("FC08: wrong data field", "AP 6.8")
def wrong_data_field(slave: Slave, found: Found) -> Iterator[Finding]:
    _need_sub(slave, found, 11)
    yield from expect_exception(slave.optional(b"\x08" + word(11, 1)), 3, "sub-function 11")


@case("FC08: wrong lengths", "AP 7")
def wrong_diagnostics_length(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 8)
    for pdu, what in (
        (b"\x08", "function code only"),
        (b"\x08\x00", "half of the sub-function"),
        (b"\x08" + word(0) + b"\x00", "half a data field"),
    ):
        yield from expect_exception(slave.optional(pdu), 3, what)


@case("FC08: counters", "AP 6.8")
def counters(slave: Slave, found: Found) -> Iterator[Finding]:
    _need_sub(slave, found, 10, 11, 12, 13, 14, 15)
    clear = b"\x08" + word(10, 0)
    yield from expect_answer(slave.request(clear), clear)
    for sub in (12, 13, 15):
        if _counter(slave, sub) != 0:
            yield fail(f"sub-function {sub}: not 0 after clearing")
    messages, served = _counter(slave, 11), _counter(slave, 14)
    if _counter(slave, 11) - messages != 2:
        yield fail("sub-function 11 has not counted the messages on the bus")
    if _counter(slave, 14) - served != 2:
        yield fail("sub-function 14 has not counted the messages to this slave")
    broken = bytearray(slave.frame(slave.baseline))
    broken[-1] ^= 1
    slave.raw(bytes(broken))
    if _counter(slave, 12) != 1:
        yield fail("sub-function 12 has not counted the wrong CRC")
    slave.request(b"\x63")
    if _counter(slave, 13) != 1:
        yield fail("sub-function 13 has not counted the exception")
    slave.raw(slave.frame(b"\x10" + word(0xFFFF, 1) + b"\x02\x00\x00", unit=BROADCAST))
    if _counter(slave, 15) != 1:
        yield fail("sub-function 15 has not counted the broadcast")


@case("FC08/04: listen only mode, ended by 01", "AP 6.8")
def listen_only(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 8)
    restart = b"\x08" + word(1, 0)
    if slave.request(restart).pdu != restart:
        raise NotApplicableError("FC08/01 is not answered: the slave would not come back")
    try:
        answer = slave.optional(b"\x08" + word(4, 0))
        if answer.exception == 1:
            raise NotApplicableError("FC08/04 is not supported")
        if not answer.silent:
            yield fail(f"FC08/04: {answer}, no answer expected")
        answer = slave.optional(slave.baseline)
        if not answer.silent:
            yield fail("a request was answered in listen only mode")
    finally:  # also after Ctrl-C: it would stay mute for everybody
        for _ in range(RECOVERY_ATTEMPTS):
            slave.optional(restart)  # not answered in this mode
            if slave.alive():
                break


# ---- FC17, report server id ----------------------------------------------------------------------


@case("FC17: the form", "AP 6.13")
def server_id(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 17)
    answer = slave.request(b"\x11")
    pdu = answer.pdu
    if not pdu or len(pdu) != 2 + pdu[1]:
        yield fail(f"{answer}: the byte count does not fit")
    elif not {0x00, 0xFF} & set(pdu[3:]):
        yield deviation("no run indicator (00 or ff) behind the id")


@case("FC17: with data", "AP 7")
def server_id_length(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 17)
    yield from expect_exception(slave.optional(b"\x11\x00"), 3)


# ---- FC20, FC21, files ---------------------------------------------------------------------------


def _reference(file: int, record: int, length: int, kind: int = REFERENCE_TYPE) -> bytes:
    return bytes([kind]) + word(file, record, length)


def _read_file(slave: Slave, *references: bytes) -> Answer:
    data = b"".join(references)
    return slave.request(b"\x14" + bytes([len(data)]) + data)


def _a_file(slave: Slave, found: Found) -> int:
    need_function(found, 20)
    for file in FILES:
        if _read_file(slave, _reference(file, 0, 1)).pdu:
            return file
    raise NotApplicableError(f"none of the files 1 to {FILES[-1]} can be read")


@case("FC20: the form", "AP 6.14")
def read_file(slave: Slave, found: Found) -> Iterator[Finding]:
    reference = _reference(_a_file(slave, found), 0, 1)
    for count in (1, 2, 3):
        pdu = _read_file(slave, *[reference] * count).pdu
        one = b"\x03\x06"
        form = pdu[:2] == bytes([20, 4 * count]) and len(pdu) == 2 + 4 * count
        if not form or any(pdu[2 + 4 * i : 4 + 4 * i] != one for i in range(count)):
            yield fail(f"{count} sub-requests: {pdu[:16].hex(' ') or 'no answer'}")


@case("FC20: byte count", "AP 6.14")
def read_file_byte_count(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 20)
    good = _reference(1, 0, 1)
    for size, data, what in (
        (0, b"", "0"),
        (6, good[:6], "6"),
        (8, good + b"\x06", "8"),
        (7, good[:6], "one byte more than there is"),
        (7, good + b"\x00", "one byte less than there is"),
        (0xF5 + 7, good * 35, "above f5"),
    ):
        answer = slave.optional(b"\x14" + bytes([size]) + data)
        yield from expect_refusal(answer, 3, what)


@case("FC20: reference type, file and record", "AP 6.14")
def read_file_reference(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 20)
    for reference, what in (
        (_reference(1, 0, 1, kind=5), "reference type 5"),
        (_reference(0, 0, 1), "file 0"),
        (_reference(0xFFFF, 0, 1), "file 65535"),
        (_reference(1, 0x2710, 1), "record 10000"),
        (_reference(1, 0xFFFF, 2), "beyond record 65535"),
    ):
        yield from expect_refusal(_read_file(slave, reference), 2, what)


@case("FC20: an answer that does not fit", "AP 6.14")
def read_file_too_long(slave: Slave, found: Found) -> Iterator[Finding]:
    file = _a_file(slave, found)
    for length in (126, 0x7FFF, 0xFFFF):
        answer = _read_file(slave, _reference(file, 0, length))
        if answer.exception not in (2, 3):
            yield fail(f"length {length}: {answer}, exception 02 or 03 expected")


@case("FC21: byte count", "AP 6.15")
def write_file_byte_count(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 21)
    good = _reference(0xFFFF, 0, 1) + word(0)
    for size, data, what in (
        (0, b"", "0"),
        (8, good[:8], "8"),
        (9, good[:8], "one byte more than there is"),
        (9, good + b"\x00", "one byte less than there is"),
    ):
        answer = slave.optional(b"\x15" + bytes([size]) + data)
        yield from expect_refusal(answer, 3, what)


@case("FC21: reference type, file and record", "AP 6.15")
def write_file_reference(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 21)
    for reference, what in (
        (_reference(1, 0, 1, kind=5), "reference type 5"),
        (_reference(0, 0, 1), "file 0"),
        (_reference(0xFFFF, 0, 1), "file 65535"),
        (_reference(0xFFFF, 0x2710, 1), "record 10000"),
    ):
        answer = slave.request(b"\x15\x09" + reference + word(0))
        yield from expect_refusal(answer, 2, what)


# ---- FC43/14, device identification --------------------------------------------------------------


def _identification(pdu: bytes) -> dict[int, bytes] | None:
    """The objects of an answer; None if its form is wrong."""
    objects = {}
    at = 7
    for _ in range(pdu[6] if len(pdu) > 6 else 0):
        if at + 2 > len(pdu):
            return None
        size = pdu[at + 1]
        objects[pdu[at]] = pdu[at + 2 : at + 2 + size]
        at += 2 + size
    return objects if at == len(pdu) else None


def _stream(slave: Slave, code: int, first: int = 0) -> tuple[dict[int, bytes], list[Finding]]:
    """All objects of a category, over as many requests as it takes."""
    objects: dict[int, bytes] = {}
    at = first
    while True:
        answer = slave.request(bytes([43, 14, code, at]))
        pdu = answer.pdu
        part = _identification(pdu)
        if part is None or pdu[:3] != bytes([43, 14, code]):
            return objects, [fail(f"code {code}, object {at}: {answer}")]
        if pdu[3] not in (1, 2, 3, 0x81, 0x82, 0x83):
            return objects, [fail(f"{pdu[3]:02x} is no conformity level")]
        objects |= part
        if pdu[4] == 0:
            return objects, [] if pdu[5] == 0 else [deviation(f"next object {pdu[5]}, not 0")]
        if pdu[4] != 0xFF or pdu[5] <= at:
            return objects, [fail(f"more follows {pdu[4]:02x}, next object {pdu[5]}")]
        at = pdu[5]


@case("FC43/14: basic objects", "AP 6.21")
def identification_basic(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 43)
    objects, findings = _stream(slave, 1)
    yield from findings
    if not findings and set(objects) != {0, 1, 2}:
        yield fail(f"objects {sorted(objects)}, not 0, 1, 2")


@case("FC43/14: regular and extended objects", "AP 6.21")
def identification_more(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 43)
    level = slave.request(b"\x2b\x0e\x01\x00").pdu[3] & 0x7F
    for code in (2, 3):
        objects, findings = _stream(slave, code)
        yield from findings
        # A category above the slave's conformity level is answered at that level.
        if not findings and level >= code and not {0, 1, 2} <= set(objects):
            yield fail(f"code {code}: the basic objects are missing")


@case("FC43/14: one object", "AP 6.21")
def identification_individual(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 43)
    if not slave.request(b"\x2b\x0e\x01\x00").pdu[3] & 0x80:
        raise NotApplicableError("the conformity level says: stream access only")
    together, _ = _stream(slave, 1)
    for number, value in together.items():
        answer = slave.request(bytes([43, 14, 4, number]))
        if _identification(answer.pdu) != {number: value}:
            yield fail(f"object {number}: {answer}")
    yield from expect_exception(slave.request(b"\x2b\x0e\x04\x7f"), 2, "object 127")


@case("FC43/14: a stream from an unknown object begins anew", "AP 6.21")
def identification_restart(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 43)
    objects = _identification(slave.request(b"\x2b\x0e\x01\x7f").pdu)
    if not objects or 0 not in objects:
        yield deviation("does not begin with object 0")


@case("FC43: wrong codes and lengths", "AP 6.19, 6.21")
def identification_wrong(slave: Slave, found: Found) -> Iterator[Finding]:
    need_function(found, 43)
    yield from expect_exception(slave.optional(b"\x2b\x00\x00\x00"), 1, "MEI type 0")
    yield from expect_exception(slave.optional(b"\x2b\xff\x00\x00"), 1, "MEI type 255")
    for code in (0, 5, 255):
        answer = slave.request(bytes([43, 14, code, 0]))
        yield from expect_exception(answer, 3, f"code {code}")
    yield from expect_exception(slave.optional(b"\x2b\x0e\x01"), 3, "too short")
    yield from expect_exception(slave.optional(b"\x2b\x0e\x01\x00\x00"), 3, "too long")
