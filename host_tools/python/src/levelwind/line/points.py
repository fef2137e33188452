# SPDX-License-Identifier: Apache-2.0
"""Values of the Modbus map: names, text forms, limits, and their registers on the wire."""

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from levelwind.errors import RefusedError, ToolError
from levelwind.map_table import POINTS, Flag, MapEnum, Point, Reason

PARAMETERS = [point for point in POINTS.values() if point.block == "parameters"]
REGISTERS_PER_READ = 125
REGISTERS_PER_WRITE = 123
NO_ADDRESS = 0xFFFF
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WHOLE = re.compile(r"[+-]?(?:0[xX][0-9a-fA-F]+|[0-9]+)")
# Their limit is the first value that is refused; that of the others the last one that is taken.
INSIDE_REASONS = (
    Reason.SWITCH_PLUS_OUTSIDE,
    Reason.SWITCH_MINUS_OUTSIDE,
    Reason.CENTRE_OUTSIDE,
)
SET_REASONS = range(30, 50)  # why APPLY refuses a set: the value of one parameter is to blame


def lookup(name: str) -> Point:
    """The point of this name. A copy's name ("active.pitch_um") gives the point at its address."""
    copy, _, plain = name.rpartition(".")
    point = POINTS.get(plain)
    if point is None:
        near = difflib.get_close_matches(plain, POINTS, n=3)
        hint = f" Did you mean {', '.join(near)}?" if near else " `levelwind map` lists all."
        raise ToolError(f"There is no register {name!r}.{hint}")
    if not copy:
        return point
    if copy not in point.mirrors:
        raise ToolError(f"{name}: only parameters have the copies active and stored.")
    return replace(mirror(point, copy), name=name)


def mirror(point: Point, copy: str) -> Point:
    """The read-only copy ("active" or "stored") of a parameter."""
    return replace(point, address=point.mirrors[copy], space="input", writable=False)


def at_address(address: int) -> Point | None:
    """The holding register value that covers an address."""
    for point in POINTS.values():
        if point.space == "holding" and 0 <= address - point.address < point.words * point.count:
            return point
    return None


def encode(point: Point, value: int) -> list[int]:
    """One value as registers, high word first."""
    bits = value & ((1 << 16 * point.words) - 1)
    return [bits >> 16 * (point.words - 1 - i) & 0xFFFF for i in range(point.words)]


def decode(point: Point, registers: list[int]) -> int:
    """The value in the registers of one element."""
    bits = 0
    for register in registers[: point.words]:
        bits = bits << 16 | register
    if point.type.startswith("i") and bits >> (16 * point.words - 1):
        bits -= 1 << 16 * point.words
    return bits


def format_value(point: Point, value: int) -> str:
    """A value as a user reads and writes it: enum names instead of numbers."""
    if point.enum is not None:
        return enum_label(point.enum, value)
    if point.bits is not None:
        return ", ".join(set_bits(point.bits, value)) or "none"
    return str(value)


def enum_label(enum: type[MapEnum], value: int) -> str:
    """The name of an enumeration's value; the number where the map has no name for it."""
    try:
        return enum(value).label
    except ValueError:
        return str(value)


def enum_text(enum: type[MapEnum], value: int) -> str:
    """The sentence that explains an enumeration's value."""
    try:
        return enum(value).text
    except ValueError:
        return f"unknown value {value}: the controller's map is newer than this tool's"


def set_bits(bits: type[MapEnum], value: int) -> list[str]:
    """Names of the bits that are 1."""
    return [bit.label for bit in bits if value >> bit & 1]


def parse_whole(given: object) -> int:
    """A whole number as people write it: 12000, -5, 0x2EE0; leading zeros mean nothing.

    ValueError if it is none.
    """
    if isinstance(given, int) and not isinstance(given, bool):
        return given
    if isinstance(given, str) and _WHOLE.fullmatch(given):
        return int(given, 16 if "x" in given.lower() else 10)
    raise ValueError


def parse_number(given: object) -> float:
    """A number as people write it: 20, -78.4, 3e4. ValueError if it is none."""
    if isinstance(given, str) and _NUMBER.fullmatch(given):
        return float(given)
    raise ValueError


def parse_value(point: Point, given: object) -> int:
    """A number or an enum name, as given on the command line or in YAML, within its limits."""
    if isinstance(given, str) and point.enum is not None:
        for member in point.enum:
            if member.label == given:
                return check_limits(point, int(member))
    try:
        value = parse_whole(given)
    except ValueError:
        kind = f"one of {limits_text(point)}" if point.enum else "a whole number"
        raise ToolError(f"{point.name}={given}: give {kind}. {point.text}.") from None
    return check_limits(point, value)


def check_limits(point: Point, value: int) -> int:
    """Return the value if a write may carry it."""
    if not point.writable or point.min is None or point.max is None:
        raise ToolError(f"{point.name} can only be read.")
    allowed = point.allowed or (tuple(point.enum) if point.enum else ())
    if not point.min <= value <= point.max or (allowed and value not in allowed):
        raise ToolError(
            f"{point.name}={value} is outside its limits: {limits_text(point)}. {point.text}."
        )
    return value


def limits_text(point: Point) -> str:
    """What a write may carry."""
    if point.enum is not None:
        return ", ".join(member.label for member in point.enum)
    if point.allowed:
        return ", ".join(map(str, point.allowed))
    if point.min is None:
        return ""
    return f"{point.min} to {point.max}{' ' + point.unit if point.unit else ''}"


def parse_assignments(assignments: Iterable[str]) -> dict[str, int]:
    """NAME=VALUE arguments as checked values."""
    values = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise ToolError(f"{assignment!r}: give NAME=VALUE, for example pitch_um=12000.")
        values[name.strip()] = parse_value(lookup(name.strip()), text.strip())
    return values


@dataclass(frozen=True)
class Run:
    """Points whose registers (or bits) follow each other without a hole."""

    points: tuple[Point, ...]

    @property
    def address(self) -> int:
        """First address."""
        return self.points[0].address

    @property
    def count(self) -> int:
        """Registers, or bits."""
        last = self.points[-1]
        return last.address + last.words * last.count - self.address


def runs(points: Iterable[Point], limit: int) -> list[Run]:
    """Points of one space in as few contiguous requests as possible."""
    grouped: list[list[Point]] = []
    for point in sorted(points, key=lambda p: p.address):
        if grouped:
            run = Run(tuple(grouped[-1]))
            end = run.address + run.count
            if point.address < end:
                continue
            if point.address == end and run.count + point.words * point.count <= limit:
                grouped[-1].append(point)
                continue
        grouped.append([point])
    return [Run(tuple(group)) for group in grouped]


def flag_names(flags: int) -> list[str]:
    """Names of the discrete inputs that are 1 in these bits, bit number = address."""
    return set_bits(Flag, flags)


def refusal(reason: int, address: int, value: int, limit: int, before: str = "") -> RefusedError:
    """A refusal of the controller, with its parts; `before` begins its text."""
    point = at_address(address)
    text = f"{before}{refusal_text(reason, address, value, limit)}"
    if reason != Reason.OUT_OF_RANGE and reason not in SET_REASONS:
        return RefusedError(text, reason)  # no value is to blame
    return RefusedError(text, reason, point.name if point else None, value, limit)


def refusal_text(reason: int, address: int, value: int, limit: int) -> str:
    """A refusal of the controller in words: why, and which value broke which limit."""
    text = enum_text(Reason, reason)
    point = at_address(address)
    if reason != Reason.OUT_OF_RANGE and reason not in SET_REASONS:
        return text  # no value is to blame
    if point is None:
        return text if address == NO_ADDRESS else f"{text}\naddress {address}"
    unit = f" {point.unit}" if point.unit else ""
    too_low = limit > value or (limit == value and reason == Reason.SWITCH_MINUS_OUTSIDE)
    if reason in INSIDE_REASONS:
        bound = "more than" if too_low else "less than"
    else:
        bound = "at least" if too_low else "at most"
    shown = f"{point.name} = {format_value(point, value)}{unit}, must be {bound} {limit}{unit}"
    return f"{text}\n{shown} (holding register {address})"
