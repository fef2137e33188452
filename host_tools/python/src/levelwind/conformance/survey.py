# SPDX-License-Identifier: Apache-2.0
"""What a slave has: functions, addresses, and what may be written. Found by asking."""

from dataclasses import dataclass, field

from levelwind.conformance.slave import Slave, word
from levelwind.errors import ToolError

READ_MAX = {1: 2000, 2: 2000, 3: 125, 4: 125}
SPACES = {1: "coils", 2: "discrete inputs", 3: "holding registers", 4: "input registers"}
ADDRESS_MAX = 0xFFFF
WRITE_TRIES = 40
# Where machines commonly begin, most likely first.
USUAL_BEGINNINGS = (
    *range(10),
    *range(10, 100, 10),
    *range(100, 1000, 100),
    *range(1000, 10_000, 1000),
    *range(0x1000, 0x10000, 0x1000),
    *(10_000, 20_000, 30_000, 40_000, 50_000, 10_001, 30_001, 40_001, ADDRESS_MAX),
)
# A request that every slave with this function answers, if only by exception 02 or 03.
PROBES = {
    5: word(ADDRESS_MAX, 0),
    6: word(ADDRESS_MAX, 0),
    7: b"",
    8: word(0, 0xA55A),
    11: b"",
    12: b"",
    15: word(ADDRESS_MAX, 0) + b"\x00",
    16: word(ADDRESS_MAX, 0) + b"\x00",
    17: b"",
    20: b"\x07\x06" + word(ADDRESS_MAX, ADDRESS_MAX, 1),
    21: b"\x09\x06" + word(ADDRESS_MAX, ADDRESS_MAX, 1, 0),
    22: word(ADDRESS_MAX, 0xFFFF, 0),
    23: word(ADDRESS_MAX, 0, ADDRESS_MAX, 0) + b"\x00",
    24: word(ADDRESS_MAX),
    43: b"\x0e\x01\x00",
}


@dataclass(frozen=True)
class Area:
    """Addresses without a hole."""

    first: int
    count: int  # not more than one request can read

    @property
    def end(self) -> int:
        """First address behind it."""
        return self.first + self.count


@dataclass
class Found:
    """The slave as far as it is known."""

    areas: dict[int, Area] = field(default_factory=dict)  # by the function that reads it
    unknown: dict[int, int] = field(default_factory=dict)  # an address that does not exist
    functions: set[int] = field(default_factory=set)  # answered, by whatever but exception 01
    silent_functions: set[int] = field(default_factory=set)
    register: int | None = None  # a holding register that takes the value that it has
    coil: int | None = None
    may_write: bool = True
    scratch: int | None = None  # a holding register that may be changed
    scratch_value: bytes = b""  # what it held


def survey(
    slave: Slave, hints: dict[int, int], may_write: bool = True, scratch: int | None = None
) -> Found:
    """Ask. `hints` says for a reading function where to look first."""
    found = Found(may_write=may_write, scratch=scratch)
    for function in READ_MAX:
        _find_area(slave, found, function, hints.get(function))
    if not slave.baseline:
        raise ToolError(
            "No coil, input or register was found at the usual addresses: name one with "
            "--coil, --discrete-input, --holding-register or --input-register."
        )
    for function, data in PROBES.items():
        answer = slave.patiently(bytes([function]) + data)
        if answer.silent:
            found.silent_functions.add(function)
        elif answer.exception != 1:
            found.functions.add(function)
    if scratch is not None:
        found.scratch_value = slave.patiently(b"\x03" + word(scratch, 1)).pdu[2:]
        if not found.scratch_value:
            raise ToolError(
                f"Holding register {scratch} cannot be read: it cannot be the scratch one."
            )
    if may_write:
        found.register = _find_register(slave, found)
        found.coil = _find_coil(slave, found)
    return found


def _find_area(slave: Slave, found: Found, function: int, hint: int | None) -> None:
    def readable(address: int, count: int) -> bool:
        return bool(slave.request(bytes([function]) + word(address, count)).pdu)

    first = None
    for address in USUAL_BEGINNINGS if hint is None else (hint,):
        answer = slave.patiently(bytes([function]) + word(address, 1))
        if answer.silent and not slave.latencies_s:
            raise ToolError(
                "No answer at all. Check power and wiring (A/B swapped?), --unit, --baud, --line.\n"
                "A slave in listen only mode (FC08/04) is mute until it is switched off and on."
            )
        if answer.malformed and not slave.understood:
            raise ToolError(
                f"Bytes came, no answer: {answer}.\n"
                "Check --unit, --baud, --line and the wiring; does something else send?"
            )
        if answer.silent:
            found.silent_functions.add(function)
            return
        if answer.exception == 1:
            return
        found.functions.add(function)
        if answer.pdu:
            first = address
            break
        found.unknown.setdefault(function, address)
    if first is None:
        return
    good, bad = 1, min(READ_MAX[function], ADDRESS_MAX + 1 - first) + 1
    while bad - good > 1:
        middle = (good + bad) // 2
        good, bad = (middle, bad) if readable(first, middle) else (good, middle)
    found.areas[function] = Area(first, good)
    slave.baseline = slave.baseline or bytes([function]) + word(first, 1)
    for address in (first + good, ADDRESS_MAX, 0x8001, 0x7531):
        if function in found.unknown or address > ADDRESS_MAX:
            continue
        if slave.request(bytes([function]) + word(address, 1)).exception:
            found.unknown[function] = address


def _find_register(slave: Slave, found: Found) -> int | None:
    if found.scratch is not None:
        return found.scratch
    area = found.areas.get(3)
    if area is None or 6 not in found.functions:
        return None
    for address in range(area.first, min(area.end, area.first + WRITE_TRIES)):
        present = slave.request(b"\x03" + word(address, 1)).pdu[2:]
        if present and slave.request(b"\x06" + word(address) + present).pdu:
            return address
    return None


def _find_coil(slave: Slave, found: Found) -> int | None:
    area = found.areas.get(1)
    if area is None or 5 not in found.functions:
        return None
    for address in range(area.first, min(area.end, area.first + WRITE_TRIES)):
        state = slave.request(b"\x01" + word(address, 1)).pdu[2:]
        if state:
            value = 0xFF00 if state[0] & 1 else 0
            if slave.request(b"\x05" + word(address, value)).pdu:
                return address
    return None
