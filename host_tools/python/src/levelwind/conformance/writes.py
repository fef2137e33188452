# SPDX-License-Identifier: Apache-2.0
"""Cases about the functions that write. What is written is what was read, except to the scratch
register."""

from collections.abc import Iterator

from levelwind.conformance.slave import Answer, Slave, word
from levelwind.conformance.suite import (
    Finding,
    NotApplicableError,
    case,
    expect_answer,
    expect_exception,
    expect_refusal,
    fail,
    need_function,
    need_scratch,
    need_unknown,
)
from levelwind.conformance.survey import ADDRESS_MAX, Found

COILS_MAX = 1968
REGISTERS_MAX = 123
READ_WRITE_MAX = 121
PDU_MAX = 253


def _need_register(found: Found, *functions: int) -> int:
    _need_writing(found)
    need_function(found, *functions)
    if found.register is None:
        raise NotApplicableError("no holding register takes the value that it has")
    return found.register


def _need_coil(found: Found, *functions: int) -> int:
    _need_writing(found)
    need_function(found, *functions)
    if found.coil is None:
        raise NotApplicableError("no coil takes the state that it has")
    return found.coil


def _need_writing(found: Found) -> None:
    if not found.may_write:
        raise NotApplicableError("--read-only")


def _register(slave: Slave, address: int) -> bytes:
    return slave.request(b"\x03" + word(address, 1)).pdu[2:]


def _coil(slave: Slave, address: int) -> int:
    return slave.request(b"\x01" + word(address, 1)).pdu[2] & 1


def _flipped(value: bytes) -> bytes:
    return bytes([value[0], value[1] ^ 1])


# ---- one coil, one register ----------------------------------------------------------------------


@case("FC05: the echo", "AP 6.5")
def coil_echo(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_coil(found, 5)
    state = _coil(slave, address)
    pdu = b"\x05" + word(address, 0xFF00 * state)
    yield from expect_answer(slave.request(pdu), pdu)
    if _coil(slave, address) != state:
        yield fail("the coil has another state than was written")


@case("FC05: a value that is neither on nor off", "AP 6.5")
def coil_value(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_coil(found, 5)
    for value in (0x0001, 0x00FF, 0xFF01, 0xFFFF, 0x0100):
        answer = slave.request(b"\x05" + word(address, value))
        yield from expect_refusal(answer, 3, f"{value:04x}")


@case("FC05: unknown address", "AP 6.5", function=5, space=1)
@case("FC06: unknown address", "AP 6.6", function=6, space=3)
def single_unknown(slave: Slave, found: Found, function: int, space: int) -> Iterator[Finding]:
    _need_writing(found)
    need_function(found, function)
    address = need_unknown(found, space)
    answer = slave.request(bytes([function]) + word(address, 0))
    yield from expect_refusal(answer, 2, f"address {address}")


@case("FC06: the echo", "AP 6.6")
def register_echo(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 6)
    value = _register(slave, address)
    if found.scratch is not None:
        pdu = b"\x06" + word(address) + _flipped(value)
        yield from expect_answer(slave.request(pdu), pdu)
        if _register(slave, address) != _flipped(value):
            yield fail("the register has another value than was written")
    pdu = b"\x06" + word(address) + value
    yield from expect_answer(slave.request(pdu), pdu)
    if _register(slave, address) != value:
        yield fail("the register has another value than was written")


# ---- several -------------------------------------------------------------------------------------


def _coils_pdu(slave: Slave, address: int, count: int = 1) -> bytes:
    return b"\x0f" + word(address, count) + bytes([(count + 7) // 8, _coil(slave, address)])


def _registers_pdu(slave: Slave, address: int) -> bytes:
    return b"\x10" + word(address, 1) + b"\x02" + _register(slave, address)


def _several(slave: Slave, found: Found, function: int) -> bytes:
    """A good request for one element."""
    if function == 15:
        return _coils_pdu(slave, _need_coil(found, 15))
    return _registers_pdu(slave, _need_register(found, 16))


@case("FC15: the answer", "AP 6.11", function=15)
@case("FC16: the answer", "AP 6.12", function=16)
def several_answer(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    pdu = _several(slave, found, function)
    yield from expect_answer(slave.request(pdu), pdu[:5])


@case("FC15: count 0", "AP 6.11", function=15)
@case("FC16: count 0", "AP 6.12", function=16)
def several_zero(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    address = _several(slave, found, function)[1:3]
    answer = slave.request(bytes([function]) + address + b"\x00\x00\x00")
    yield from expect_refusal(answer, 3)


@case("FC15: count above the limit", "AP 6.11", function=15, limit=COILS_MAX)
@case("FC16: count above the limit", "AP 6.12", function=16, limit=REGISTERS_MAX)
def several_above(slave: Slave, found: Found, function: int, limit: int) -> Iterator[Finding]:
    head = _several(slave, found, function)[:3]
    size = {15: (limit + 8) // 8, 16: 2 * (limit + 1)}[function]
    # 124 registers do not fit into a frame: as much of them as does.
    pdu = (head + word(limit + 1) + bytes([size]) + bytes(size))[:PDU_MAX]
    yield from expect_refusal(slave.request(pdu), 3, f"count {limit + 1}")
    pdu = head + b"\xff\xff\x02\x00\x00"
    yield from expect_refusal(slave.request(pdu), 3, "count 65535")


@case("FC15: count at the limit", "AP 6.11")
def coils_at_limit(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_coil(found, 15)
    present = slave.request(b"\x01" + word(address, COILS_MAX))
    size = COILS_MAX // 8
    data = present.pdu[2:] if present.pdu else bytes(size)
    answer = slave.request(b"\x0f" + word(address, COILS_MAX) + bytes([size]) + data)
    yield from _limit_answer(present, answer, 2)


@case("FC16: count at the limit", "AP 6.12")
def registers_at_limit(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 16)
    present = slave.request(b"\x03" + word(address, REGISTERS_MAX))
    size = 2 * REGISTERS_MAX
    data = present.pdu[2:] if present.pdu else bytes(size)
    answer = slave.request(b"\x10" + word(address, REGISTERS_MAX) + bytes([size]) + data)
    yield from _limit_answer(present, answer, 2)


def _limit_answer(present: Answer, answer: Answer, code: int) -> Iterator[Finding]:
    """What exists may still refuse to be written; a count at the limit is no reason."""
    if not present.pdu:
        yield from expect_refusal(answer, code, "not all exist")
    elif answer.exception == 3 or not (answer.pdu or answer.exception):
        yield fail(f"{answer}, but the count is allowed")


@case("FC15: byte count that does not fit", "AP 6.11", function=15)
@case("FC16: byte count that does not fit", "AP 6.12", function=16)
def several_byte_count(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    pdu = _several(slave, found, function)
    size = pdu[5]
    for declared, data, what in (
        (size + 1, pdu[6:] + b"\x00", "one too many"),
        (size - 1, pdu[6:-1], "one too few"),
        (0, b"", "0"),
    ):
        answer = slave.request(pdu[:5] + bytes([declared]) + data)
        yield from expect_refusal(answer, 3, what)


@case("FC15: data shorter and longer than its byte count", "AP 7", function=15)
@case("FC16: data shorter and longer than its byte count", "AP 7", function=16)
def several_length(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    pdu = _several(slave, found, function)
    for wrong, what in ((pdu[:-1], "too short"), (pdu + b"\x00", "too long")):
        yield from expect_refusal(slave.optional(wrong), 3, what)


@case("FC15: unknown address", "AP 6.11", function=15, space=1)
@case("FC16: unknown address", "AP 6.12", function=16, space=3)
def several_unknown(slave: Slave, found: Found, function: int, space: int) -> Iterator[Finding]:
    _need_writing(found)
    need_function(found, function)
    address = need_unknown(found, space)
    size = {15: 1, 16: 2}[function]
    pdu = bytes([function]) + word(address, 1) + bytes([size]) + bytes(size)
    yield from expect_refusal(slave.request(pdu), 2, f"address {address}")


@case("FC15: addresses beyond 65535", "AP 6.11", function=15)
@case("FC16: addresses beyond 65535", "AP 6.12", function=16)
def several_wrap(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    _need_writing(found)
    need_function(found, function)
    size = {15: 1, 16: 4}[function]
    pdu = bytes([function]) + word(ADDRESS_MAX, 2) + bytes([size]) + bytes(size)
    yield from expect_refusal(slave.request(pdu), 2)


@case("FC16: all or nothing", "AP 6.12")
def all_or_nothing(slave: Slave, found: Found) -> Iterator[Finding]:
    address = need_scratch(found)
    need_function(found, 16)
    count = 1
    while count < REGISTERS_MAX and slave.request(b"\x03" + word(address, count + 1)).pdu:
        count += 1
    if count == REGISTERS_MAX:
        raise NotApplicableError("no unknown address within reach of the scratch register")
    before = slave.request(b"\x03" + word(address, count)).pdu[2:]
    data = _flipped(before[:2]) + before[2:] + b"\x00\x00"
    answer = slave.request(b"\x10" + word(address, count + 1) + bytes([len(data)]) + data)
    yield from expect_refusal(answer, 2)
    if _register(slave, address) != before[:2]:
        yield fail("the registers before the unknown one have been written")
        slave.request(b"\x06" + word(address) + before[:2])


# ---- FC22, FC23 ----------------------------------------------------------------------------------


@case("FC22: the echo, nothing changed", "AP 6.16")
def mask_echo(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 22)
    value = _register(slave, address)
    # A bit of the OR mask counts only where the AND mask is 0.
    for masks in (word(0xFFFF, 0), word(0xFFFF, 0xFFFF)):
        pdu = b"\x16" + word(address) + masks
        yield from expect_answer(slave.request(pdu), pdu, masks.hex())
        if _register(slave, address) != value:
            yield fail(f"{masks.hex()}: the register has changed")
            slave.request(b"\x06" + word(address) + value)


@case("FC22: the masks", "AP 6.16")
def mask_formula(slave: Slave, found: Found) -> Iterator[Finding]:
    address = need_scratch(found)
    need_function(found, 22)
    before = _register(slave, address)
    for bit in (before[1] & 1 ^ 1, before[1] & 1):
        pdu = b"\x16" + word(address, 0xFFFE, bit)
        yield from expect_answer(slave.request(pdu), pdu)
        expected = bytes([before[0], before[1] & 0xFE | bit])
        if _register(slave, address) != expected:
            yield fail(f"AND fffe OR {bit:04x} of {before.hex()} is not {expected.hex()}")
    slave.request(b"\x06" + word(address) + before)


@case("FC22: unknown address", "AP 6.16")
def mask_unknown(slave: Slave, found: Found) -> Iterator[Finding]:
    _need_writing(found)
    need_function(found, 22)
    address = need_unknown(found, 3)
    answer = slave.request(b"\x16" + word(address, 0xFFFF, 0))
    yield from expect_refusal(answer, 2, f"address {address}")


@case("FC22: one byte too few and too many", "AP 7")
def mask_length(slave: Slave, found: Found) -> Iterator[Finding]:
    pdu = b"\x16" + word(_need_register(found, 22), 0xFFFF, 0)
    for wrong, what in ((pdu[:-1], "too few"), (pdu + b"\x00", "too many")):
        yield from expect_refusal(slave.optional(wrong), 3, what)


def _read_write(read: int, count: int, write: int, data: bytes) -> bytes:
    return b"\x17" + word(read, count, write, len(data) // 2) + bytes([len(data)]) + data


@case("FC23: the answer", "AP 6.17")
def read_write_answer(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 23)
    value = _register(slave, address)
    answer = slave.request(_read_write(address, 1, address, value))
    yield from expect_answer(answer, b"\x17\x02" + value)


@case("FC23: writes before it reads", "AP 6.17")
def read_write_order(slave: Slave, found: Found) -> Iterator[Finding]:
    address = need_scratch(found)
    need_function(found, 23)
    before = _register(slave, address)
    other = _flipped(before)
    answer = slave.request(_read_write(address, 1, address, other))
    yield from expect_answer(answer, b"\x17\x02" + other)
    slave.request(b"\x06" + word(address) + before)


@case("FC23: counts 0 and above the limit", "AP 6.17")
def read_write_counts(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 23)
    value = _register(slave, address)
    for count in (0, 126, 0xFFFF):
        answer = slave.request(_read_write(address, count, address, value))
        yield from expect_refusal(answer, 3, f"read {count}")
    answer = slave.request(_read_write(address, 1, address, b""))
    yield from expect_refusal(answer, 3, "write 0")
    pdu = _read_write(address, 1, address, bytes(2 * (READ_WRITE_MAX + 1)))[:PDU_MAX]
    yield from expect_refusal(slave.request(pdu), 3, f"write {READ_WRITE_MAX + 1}")


@case("FC23: byte count that does not fit", "AP 6.17")
def read_write_byte_count(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 23)
    head = b"\x17" + word(address, 1, address, 1)
    value = _register(slave, address)
    yield from expect_refusal(slave.request(head + b"\x03" + value + b"\x00"), 3, "one too many")
    yield from expect_refusal(slave.request(head + b"\x01" + value[:1]), 3, "one too few")


@case("FC23: unknown addresses", "AP 6.17")
def read_write_unknown(slave: Slave, found: Found) -> Iterator[Finding]:
    address = _need_register(found, 23)
    unknown = need_unknown(found, 3)
    value = _register(slave, address)
    answer = slave.request(_read_write(unknown, 1, address, value))
    yield from expect_refusal(answer, 2, "read")
    answer = slave.request(_read_write(address, 1, unknown, value))
    yield from expect_refusal(answer, 2, "write")
    answer = slave.request(_read_write(ADDRESS_MAX, 2, address, value))
    yield from expect_refusal(answer, 2, "read beyond 65535")


@case("FC23: a refused reading writes nothing", "AP 6.17")
def read_write_atomic(slave: Slave, found: Found) -> Iterator[Finding]:
    address = need_scratch(found)
    need_function(found, 23)
    unknown = need_unknown(found, 3)
    before = _register(slave, address)
    answer = slave.request(_read_write(unknown, 1, address, _flipped(before)))
    yield from expect_exception(answer, 2)
    if _register(slave, address) != before:
        yield fail("written all the same")
        slave.request(b"\x06" + word(address) + before)
