# SPDX-License-Identifier: Apache-2.0
"""Every address of the four spaces, by every function that reaches it, against the map."""

import struct
from pathlib import Path

import pytest
from levelwind.map_table import POINTS, Point, Reason
from world import World

READ = {"coil": 1, "discrete": 2, "holding": 3, "input": 4}
ADDRESSES = range(0x10000)


def taken(space: str) -> dict[int, tuple[Point, int]]:
    """Address: its point, and which register of the value it is."""
    found = {}
    for point in POINTS.values():
        bases = [point.address] if point.space == space else []
        if space == "input":
            bases += point.mirrors.values()
        for base in bases:
            for at in range(point.words * point.count):
                found[base + at] = (point, at % point.words)
    return found


def exception(answer: bytes) -> int:
    return answer[1] if answer[0] & 0x80 else 0


@pytest.fixture(scope="module")
def world() -> World:
    return World()


@pytest.mark.parametrize("space", READ)
def test_what_is_in_the_map_can_be_read_and_nothing_else(world: World, space: str) -> None:
    known = taken(space)
    for address in ADDRESSES:
        answer = world.request(struct.pack(">BHH", READ[space], address, 1))
        assert exception(answer) == (0 if address in known else 2), address


@pytest.mark.parametrize("space", READ)
def test_a_range_that_leaves_the_map_is_refused_whole(world: World, space: str) -> None:
    known = taken(space)
    for address in known:
        count = 2
        while address + count - 1 in known:
            count += 1
        if count > (125 if space in ("holding", "input") else 2000):
            continue
        answer = world.request(struct.pack(">BHH", READ[space], address, count))
        assert exception(answer) == 2, address
        assert world.value("last_error_address") == address + count - 1


def test_only_whole_writable_values_can_be_written(world: World) -> None:
    """A value that is no change is written to every holding address, by FC06, FC16 and FC22."""
    known = taken("holding")
    for address in ADDRESSES:
        point, _ = known.get(address, (None, 0))
        expected = 0 if point and point.writable and point.words == 1 else 2
        value = 0
        if expected == 0:
            now = world.request(struct.pack(">BHH", 3, address, 1))
            value = struct.unpack(">H", now[2:])[0]
        for pdu in (
            struct.pack(">BHH", 6, address, value),
            struct.pack(">BHHBH", 16, address, 1, 2, value),
            struct.pack(">BHHH", 22, address, 0xFFFF, 0),
        ):
            if point and point.command and value:
                continue
            assert exception(world.request(pdu)) == expected, (address, pdu.hex())
            if expected:
                reason = Reason(world.value("last_error_reason"))
                if point is None:
                    assert reason == Reason.UNKNOWN_ADDRESS
                elif not point.writable:
                    assert reason == Reason.NOT_WRITABLE
                else:
                    assert reason == Reason.HALF_OF_PAIR
                assert world.value("last_error_address") == address


def test_coils_outside_of_the_map(world: World) -> None:
    known = taken("coil")
    for address in ADDRESSES:
        expected = 0 if address in known else 2
        assert exception(world.request(struct.pack(">BHH", 5, address, 0))) == expected
        assert exception(world.request(struct.pack(">BHHBB", 15, address, 1, 1, 0))) == expected


@pytest.mark.parametrize(
    "point",
    [p for p in POINTS.values() if p.space == "holding" and p.writable],
    ids=lambda point: point.name,
)
def test_a_value_outside_of_its_limits_changes_nothing(world: World, point: Point) -> None:
    bits = 16 * point.words
    signed = point.type.startswith("i")
    lowest, highest = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    allowed = set(point.allowed) or None
    candidates = {point.min - 1, point.max + 1, lowest, highest}
    candidates |= {value + 1 for value in allowed or ()}
    head = struct.pack(">BHHB", 16, point.address, point.words, 2 * point.words)
    read = struct.pack(">BHH", READ["holding"], point.address, point.words)
    for value in candidates:
        inside = value in allowed if allowed else point.min <= value <= point.max
        if inside or not lowest <= value <= highest:
            continue
        before = world.request(read)
        data = (value & (1 << bits) - 1).to_bytes(2 * point.words, "big")
        assert exception(world.request(head + data)) == 3, value
        assert world.value("last_error_reason") == Reason.OUT_OF_RANGE
        assert world.value("last_error_address") == point.address
        assert world.request(read) == before


def acts_by_itself(point: Point) -> bool:
    """Writing it is not just storing a value: it runs something, or needs the right code."""
    return point.command or point.name in ("jog", "unlock", "bench_trigger_fault")


@pytest.mark.parametrize(
    "point",
    [p for p in POINTS.values() if p.space == "holding" and p.writable and not acts_by_itself(p)],
    ids=lambda point: point.name,
)
def test_values_at_the_limits_are_taken(point: Point) -> None:
    world = World()
    size = 2 * point.words
    head = struct.pack(">BHHB", 16, point.address, point.words, size)
    read = struct.pack(">BHH", READ["holding"], point.address, point.words)
    for value in point.allowed or (point.min, point.max):
        data = (value & (1 << 8 * size) - 1).to_bytes(size, "big")
        refused = exception(world.request(head + data))
        if point.name.startswith("trim_") and refused:
            # Within its limits, but the trimmed pattern would not fit the machine.
            assert world.value("last_error_reason") not in (Reason.NONE, Reason.OUT_OF_RANGE)
            continue
        assert refused == 0, value
        if not point.secret:
            assert world.request(read)[2:] == data, value


def test_the_documentation_says_the_same() -> None:
    """doc/registers.md: address, type, access, unit, limits and default of every register."""
    page = (Path(__file__).parents[2] / "doc" / "registers.md").read_text()
    rows = {}
    head: list[str] = []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if line.startswith("| address"):
            head = cells
        elif line.startswith("| ") and len(cells) == len(head) and cells[0].isdigit():
            row = dict(zip(head, cells, strict=True))
            rows[row["name"].strip("`")] = row
    registers = [p for p in POINTS.values() if p.space in ("holding", "input")]
    for point in registers:
        row = rows.pop(point.name)
        array = f"[{point.count}]" if point.count > 1 else ""
        assert row["address"] == str(point.address)
        assert row["type"] == point.type + array
        assert row["unit"] == point.unit
        if "access" not in row:
            assert not point.writable
            continue
        assert row["access"] == ("rw" if point.writable else "r")
        if not point.writable:
            assert row["limits"] == row["default"] == ""
        elif point.allowed:
            assert row["limits"] == ", ".join(map(str, point.allowed))
            assert row["default"] == str(point.default)
        else:
            assert row["limits"] == f"{point.min} to {point.max}"
            assert row["default"] == str(point.default)
    bits = {p.name: str(p.address) for p in POINTS.values() if p.space in ("coil", "discrete")}
    assert {name: row["address"] for name, row in rows.items()} == bits
