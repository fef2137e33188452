# SPDX-License-Identifier: Apache-2.0
"""The Modbus map as Python objects: reads registers.yaml and refuses what is inconsistent."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import jsonschema
import yaml

FOLDER = Path(__file__).resolve().parent
WORDS = {"u16": 1, "i16": 1, "u32": 2, "i32": 2, "i64": 4}
INT32_MAX = 2**31 - 1
# What a write may carry. A u32 stops at INT32_MAX: limits are int32_t in the controller.
WRITE_RANGE = {
    "u16": (0, 65535),
    "i16": (-32768, 32767),
    "u32": (0, INT32_MAX),
    "i32": (-INT32_MAX, INT32_MAX),
}
LAUNCH_INHIBIT = "launch_inhibit"
FLAG = "flag"
FLAGS_EACH = 32  # in a register pair of flags


class MapError(Exception):
    """The map is wrong; each argument is one line that says what to correct."""


@dataclass(frozen=True)
class Value:
    """One value of an enumeration, or one bit of a bit field."""

    value: int
    name: str
    text: str
    detail: str | None = None  # the enum that names an event's detail


@dataclass(frozen=True)
class Enum:
    name: str
    text: str
    values: list[Value]


@dataclass(frozen=True)
class Coil:
    address: int
    name: str
    text: str
    command: str | None = None
    jog: int = 0


@dataclass(frozen=True)
class Point:
    """One value, or an array of values, in one or more registers."""

    address: int
    name: str
    type: str
    text: str
    writable: bool
    count: int = 1
    command: bool = False
    min: int = 0
    max: int = 0
    allowed: list[int] = field(default_factory=list)
    default: int = 0
    enum: str | None = None
    bits: str | None = None  # FLAG or LAUNCH_INHIBIT
    bits_from: int = 0  # which of them bit 0 is
    unit: str = ""
    scope: str = ""
    reindex: bool = False
    secret: bool = False

    @property
    def words(self) -> int:
        """Registers that one element takes."""
        return WORDS[self.type]

    @property
    def end(self) -> int:
        """First address behind the point."""
        return self.address + self.words * self.count


@dataclass(frozen=True)
class Mirror:
    """A read-only copy of a block's points among the input registers."""

    name: str
    address_offset: int
    text: str


@dataclass(frozen=True)
class Block:
    name: str
    space: str
    struct: str
    text: str
    points: list[Point]
    mirrors: list[Mirror]
    bench: bool

    @property
    def short_name(self) -> str:
        """The name in C: that of the struct without its prefix."""
        return self.struct.removeprefix("lw_")


@dataclass(frozen=True)
class Map:
    version: int
    self_test: int
    product: dict
    enums: dict[str, Enum]
    coils: list[Coil]
    flags: list[Value]
    launch_inhibit: list[Value]
    blocks: list[Block]

    @property
    def product_version(self) -> str:
        return "{major}.{minor}.{patch}".format(**self.product["version"])

    def values(self, point: Point) -> list[Value]:
        """The named values, or named bits, of a point; empty for a number."""
        if point.enum:
            return self.enums[point.enum].values
        bits = {FLAG: self.flags, LAUNCH_INHIBIT: self.launch_inhibit}.get(point.bits or "", [])
        return [
            replace(bit, value=bit.value - point.bits_from)
            for bit in bits
            if point.bits != FLAG or point.bits_from <= bit.value < point.bits_from + FLAGS_EACH
        ]


def _limits(raw: dict, enums: dict[str, Enum]) -> tuple[int, int]:
    if "min" in raw:
        return raw["min"], raw["max"]
    if "allowed" in raw:
        return min(raw["allowed"]), max(raw["allowed"])
    if "enum" in raw:
        values = [value.value for value in enums[raw["enum"]].values]
        return min(values), max(values)
    raise MapError(f"{raw['name']}: a writable point needs min and max, allowed, or enum")


def _point(raw: dict, space: str, enums: dict[str, Enum]) -> Point:
    if raw.get("enum", next(iter(enums))) not in enums:
        raise MapError(f"{raw['name']}: there is no enum {raw['enum']}")
    fields = dict(raw)
    fields.pop("access", None)
    fields["writable"] = space == "holding" and raw.get("access") != "r"
    if "bits" in raw:
        fields["bits"] = FLAG if raw["bits"] == "discrete" else LAUNCH_INHIBIT
    if fields["writable"]:
        if "default" not in raw:
            raise MapError(f"{raw['name']}: a writable point needs a default")
        fields["min"], fields["max"] = _limits(raw, enums)
        if "enum" in raw and not raw.keys() & {"min", "allowed"}:
            values = sorted(value.value for value in enums[raw["enum"]].values)
            if values != list(range(values[0], values[-1] + 1)):
                fields["allowed"] = values  # its numbers have gaps
    elif raw.keys() & {"min", "max", "allowed", "default", "scope", "reindex", "command", "secret"}:
        raise MapError(f"{raw['name']}: cannot be written, so it has no limits, default or scope")
    return Point(**fields)


def _parse(raw: dict) -> Map:
    enums = {
        name: Enum(name, e["text"], [Value(name=n, **v) for n, v in e["values"].items()])
        for name, e in raw["enums"].items()
    }
    blocks = [
        Block(
            name=block["block"],
            space=block["space"],
            struct=block["struct"],
            text=block["text"],
            points=[_point(point, block["space"], enums) for point in block["points"]],
            mirrors=[Mirror(**mirror) for mirror in block.get("mirrors", [])],
            bench=block.get("bench", False),
        )
        for block in raw["registers"]
    ]
    return Map(
        version=raw["map_version"],
        self_test=raw["self_test"],
        product=raw["product"],
        enums=enums,
        coils=[Coil(**coil) for coil in raw["bits"]["coil"]],
        flags=[Value(b["address"], b["name"], b["text"]) for b in raw["bits"]["discrete"]],
        launch_inhibit=[Value(b["bit"], b["name"], b["text"]) for b in raw["launch_inhibit"]],
        blocks=blocks,
    )


def _duplicates(names: list) -> list:
    return sorted({name for name in names if names.count(name) > 1})


def _name_errors(map_: Map) -> Iterator[str]:
    points = [point.name for block in map_.blocks for point in block.points]
    mirrors = [
        f"{mirror.name}_{point.name}"
        for block in map_.blocks
        for mirror in block.mirrors
        for point in block.points
    ]
    bits = [coil.name for coil in map_.coils] + [flag.name for flag in map_.flags]
    for name in _duplicates(points + mirrors + bits):
        yield f"{name}: the name is used more than once"
    for name in _duplicates([value.name for value in map_.launch_inhibit]):
        yield f"launch_inhibit: the bit name {name} is used more than once"
    for enum in map_.enums.values():
        for value in _duplicates([value.value for value in enum.values]):
            yield f"enum {enum.name}: the value {value} is used more than once"
        for name in _duplicates([value.name.upper() for value in enum.values]):
            yield f"enum {enum.name}: the name {name} is used more than once"
        for value in enum.values:
            if value.detail is not None and value.detail not in map_.enums:
                yield f"enum {enum.name}: the detail of {value.name}: no enum {value.detail}"
    for what in ("name", "struct"):
        for name in _duplicates([getattr(block, what) for block in map_.blocks]):
            yield f"block {name}: the {what} is used more than once"


def _bit_errors(map_: Map) -> Iterator[str]:
    numbers = {
        "coil": [coil.address for coil in map_.coils],
        "discrete": [flag.value for flag in map_.flags],
        LAUNCH_INHIBIT: [value.value for value in map_.launch_inhibit],
    }
    for name, found in numbers.items():
        if found != list(range(len(found))):
            yield f"{name}: the bits must count 0, 1, 2, ... without a gap, not {found}"
    commands = {value.name for value in map_.enums["command"].values} if map_.coils else set()
    for coil in map_.coils:
        if coil.command is not None and coil.command not in commands:
            yield f"coil {coil.name}: there is no command {coil.command}"


def _flag_errors(map_: Map) -> Iterator[str]:
    pairs = [point for block in map_.blocks for point in block.points if point.bits == FLAG]
    shown = {pair.bits_from + bit.value for pair in pairs for bit in map_.values(pair)}
    for flag in map_.flags:
        if pairs and flag.value not in shown:
            yield f"discrete {flag.name}: stands in no register pair of flags"


def _point_errors(point: Point, map_: Map) -> Iterator[str]:
    if point.bits and len(map_.values(point)) > 16 * point.words:
        yield f"{point.name}: its bits do not fit into a {point.type}"
    if not point.writable:
        return
    if point.type not in WRITE_RANGE:
        yield f"{point.name}: a {point.type} cannot be writable"
        return
    low, high = WRITE_RANGE[point.type]
    if not low <= point.min <= point.max <= high:
        yield (
            f"{point.name}: the limits {point.min} to {point.max} must rise and lie inside "
            f"{low} to {high}, what can be written to a {point.type}"
        )
    for value in [point.default, *point.allowed]:
        if not point.min <= value <= point.max:
            yield f"{point.name}: {value} is outside its limits {point.min} to {point.max}"
    if point.allowed and point.default not in point.allowed:
        yield f"{point.name}: the default {point.default} is not one of {point.allowed}"
    if point.enum:
        values = [value.value for value in map_.enums[point.enum].values]
        if sorted(values) != (point.allowed or list(range(point.min, point.max + 1))):
            yield (
                f"{point.name}: the limits {point.min} to {point.max} let values through "
                f"that the enum {point.enum} does not name"
            )


def _address_errors(map_: Map) -> Iterator[str]:
    spans = []
    for block in map_.blocks:
        addresses = [point.address for point in block.points]
        if addresses != sorted(addresses):
            yield f"block {block.name}: the points are not sorted by address"
        copies = [(block.space, 0), *(("input", m.address_offset) for m in block.mirrors)]
        for space, offset in copies:
            spans += [(space, p.address + offset, p.end + offset, p.name) for p in block.points]
    spans.sort()
    for (space, _, end, name), (next_space, start, _, next_name) in pairwise(spans):
        if space == next_space and start < end:
            yield f"{name} and {next_name}: both hold the {space} register {start}"
    for space, _, end, name in spans:
        if end > 65536:
            yield f"{name}: reaches the {space} register {end - 1}, 65535 is the last"


def check(raw: dict) -> Map:
    """The map from what registers.yaml holds. Raises MapError with every finding."""
    schema = json.loads((FOLDER / "schema.json").read_text(encoding="utf-8"))
    found = [
        f"{'/'.join(str(part) for part in error.absolute_path) or 'top level'}: {error.message}"
        for error in jsonschema.Draft202012Validator(schema).iter_errors(raw)
    ]
    if found:
        raise MapError(*found)
    map_ = _parse(raw)
    found = [*_name_errors(map_), *_bit_errors(map_), *_address_errors(map_), *_flag_errors(map_)]
    for block in map_.blocks:
        for point in block.points:
            found += _point_errors(point, map_)
    if found:
        raise MapError(*found)
    return map_


def load() -> Map:
    """Read and check registers.yaml."""
    return check(yaml.safe_load((FOLDER / "registers.yaml").read_text(encoding="utf-8")))
