# SPDX-License-Identifier: Apache-2.0
"""Every register and bit of the map, over the line, from the running slave."""

from collections.abc import Iterator

import pytest
from levelwind.map_table import POINTS, Flag, Point
from slave import RawLine, Slave

READ = {"coil": 1, "discrete": 2, "holding": 3, "input": 4}
SPACES = tuple(READ)


def word(*values: int) -> bytes:
    return b"".join(value.to_bytes(2, "big") for value in values)


def places(space: str) -> Iterator[tuple[int, Point]]:
    """Every point of a space and its copies, by address."""
    for point in POINTS.values():
        if point.space == space:
            yield point.address, point
        if space == "input":
            for address in point.mirrors.values():
                yield address, point


def registers(point: Point) -> int:
    return point.words * point.count


@pytest.mark.parametrize("space", SPACES)
def test_every_point_can_be_read_alone(raw: RawLine, space: str) -> None:
    for address, point in places(space):
        answer = raw.request(bytes([READ[space]]) + word(address, registers(point)))
        assert answer[0] == READ[space], f"{point.name}: {answer.hex(' ')}"
        size = 1 if point.type == "bit" else 2 * registers(point)
        assert (answer[1], len(answer)) == (size, 2 + size), point.name
        if point.enum and point.words == 1:
            assert int.from_bytes(answer[2:], "big") in list(point.enum), point.name


@pytest.mark.parametrize("space", SPACES)
def test_what_lies_between_the_blocks_is_refused(raw: RawLine, space: str) -> None:
    """Both neighbours of every run, and a sample of everywhere else."""
    known = {a + i for a, p in places(space) for i in range(registers(p))}
    outside = {a + d for a in known for d in (-1, 1)} | set(range(0, 0x10000, 641)) | {0xFFFF}
    for address in sorted(a for a in outside - known if 0 <= a <= 0xFFFF):
        answer = raw.request(bytes([READ[space]]) + word(address, 1))
        assert answer == bytes([READ[space] | 0x80, 2]), address


def test_what_cannot_be_written_is_refused(raw: RawLine) -> None:
    for address, point in places("holding"):
        if point.writable and point.words == 1:
            continue  # written by test_parameters, with values that make sense
        answer = raw.request(b"\x06" + word(address, 0))
        assert answer == b"\x86\x02", point.name


def test_no_parameter_takes_a_value_beyond_its_limits(slave: Slave, raw: RawLine) -> None:
    for address, point in places("holding"):
        if not point.writable:
            continue
        bits = 16 * point.words
        signed = point.type.startswith("i")
        lowest = -(1 << bits - 1) if signed else 0
        highest = lowest + (1 << bits) - 1
        head = b"\x10" + word(address, point.words) + bytes([2 * point.words])
        for value in (point.min - 1, point.max + 1):
            if lowest <= value <= highest:
                data = (value & (1 << bits) - 1).to_bytes(2 * point.words, "big")
                assert raw.request(head + data) == b"\x90\x03", f"{point.name} {value}"


def test_flags_stand_in_two_places(slave: Slave, raw: RawLine) -> None:
    pairs = slave.read("flags") | slave.read("flags_2") << 32
    answer = raw.request(b"\x02" + word(0, len(Flag)))
    assert int.from_bytes(answer[2:], "little") == pairs
