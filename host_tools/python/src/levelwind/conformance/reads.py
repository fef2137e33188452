# SPDX-License-Identifier: Apache-2.0
"""Cases about the functions that read bits and registers."""

from collections.abc import Iterator

from levelwind.conformance.slave import Slave, word
from levelwind.conformance.suite import (
    Finding,
    NotApplicableError,
    deviation,
    each,
    expect_exception,
    expect_refusal,
    fail,
    need_function,
    need_unknown,
)
from levelwind.conformance.survey import ADDRESS_MAX, READ_MAX, SPACES, Area, Found

BITS = (1, 2)


def _need_area(found: Found, function: int) -> Area:
    need_function(found, function)
    if function not in found.areas:
        raise NotApplicableError(f"no {SPACES[function]} found")
    return found.areas[function]


def _size(function: int, count: int) -> int:
    return (count + 7) // 8 if function in BITS else 2 * count


def check_data(pdu: bytes, function: int, count: int) -> Iterator[Finding]:
    """The form of a normal answer: byte count, data, padding."""
    size = _size(function, count)
    if pdu[1:2] != bytes([size]) or len(pdu) != 2 + size:
        yield fail(f"count {count}: byte count {pdu[1]} and {len(pdu) - 2} bytes, not {size}")
    elif function in BITS and count % 8 and pdu[-1] >> count % 8:
        yield deviation(f"count {count}: the unused bits are not 0 ({pdu[-1]:02x})")


@each(READ_MAX, "every count that fits")
def every_count(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    counts = {1, 2, 7, 8, 9, 15, 16, 17, 64, 123, 124, 125, 126, 1968, 1999, 2000, area.count}
    for count in sorted(c for c in counts if c <= area.count):
        answer = slave.request(bytes([function]) + word(area.first, count))
        if answer.pdu:
            yield from check_data(answer.pdu, function, count)
        else:
            yield fail(f"count {count}: {answer}")


@each(READ_MAX, "one by one is the same as together")
def one_by_one(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    count = min(area.count, 10)

    def together() -> list[bytes]:
        data = slave.request(bytes([function]) + word(area.first, count)).pdu[2:]
        if function in BITS:
            return [bytes([data[i // 8] >> i % 8 & 1]) for i in range(count)]
        return [data[2 * i : 2 * i + 2] for i in range(count)]

    before = together()
    single = [
        slave.request(bytes([function]) + word(area.first + i, 1)).pdu[2:] for i in range(count)
    ]
    after = together()
    for i in range(count):
        # What changes by itself is left out.
        if before[i] == after[i] and single[i] != before[i]:
            yield fail(f"{area.first + i}: {single[i].hex()} alone, {before[i].hex()} in a row")


@each(READ_MAX, "count 0")
def count_zero(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    answer = slave.request(bytes([function]) + word(area.first, 0))
    yield from expect_exception(answer, 3)


@each(READ_MAX, "count at the limit")
def count_at_limit(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    limit = READ_MAX[function]
    answer = slave.request(bytes([function]) + word(area.first, limit))
    if answer.pdu:
        yield from check_data(answer.pdu, function, limit)
    elif area.count < limit:
        yield from expect_exception(answer, 2, f"count {limit}, only {area.count} exist")
    else:
        yield fail(f"count {limit}: {answer}")


@each(READ_MAX, "count above the limit")
def count_above_limit(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    limit = READ_MAX[function]
    for count in (limit + 1, 0x0800, 0x8000, 0xFFFF):
        if count > limit:
            answer = slave.request(bytes([function]) + word(area.first, count))
            yield from expect_exception(answer, 3, f"count {count}")


@each(READ_MAX, "unknown address")
def unknown_address(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    need_function(found, function)
    address = need_unknown(found, function)
    answer = slave.request(bytes([function]) + word(address, 1))
    yield from expect_refusal(answer, 2, f"address {address}")


@each(READ_MAX, "a range that leaves what exists")
def range_leaves(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    if area.count == READ_MAX[function] or area.end > ADDRESS_MAX:
        raise NotApplicableError("all that one request can read exists")
    answer = slave.request(bytes([function]) + word(area.first, area.count + 1))
    yield from expect_refusal(answer, 2, f"{area.first}, count {area.count + 1}")
    answer = slave.request(bytes([function]) + word(area.end - 1, 2))
    yield from expect_refusal(answer, 2, f"{area.end - 1}, count 2")


@each(READ_MAX, "addresses beyond 65535")
def address_wrap(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    need_function(found, function)
    limit = READ_MAX[function]
    for address, count in ((ADDRESS_MAX, 2), (ADDRESS_MAX, limit), (0x10001 - limit, limit)):
        answer = slave.request(bytes([function]) + word(address, count))
        yield from expect_refusal(answer, 2, f"{address}, count {count}")


@each(READ_MAX, "one byte too few and too many", "AP 7")
def wrong_length(slave: Slave, found: Found, function: int) -> Iterator[Finding]:
    area = _need_area(found, function)
    good = bytes([function]) + word(area.first, 1)
    for pdu, what in (
        (good[:1], "function code only"),
        (good[:-1], "too few"),
        (good + b"\x00", "too many"),
    ):
        yield from expect_exception(slave.optional(pdu), 3, what)
