# SPDX-License-Identifier: Apache-2.0
"""The laptop tool's table: host_tools/python/src/levelwind/map_table.py."""

import json

from map_model import FLAG, LAUNCH_INHIBIT, Block, Coil, Map, Point, Value

COLUMNS = 100
PREAMBLE = '''# SPDX-License-Identifier: Apache-2.0
"""The Modbus map: every point, enumeration, limit and default.

Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
Do not edit.
"""
# ruff: noqa: E501

import builtins
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal

Space = Literal["coil", "discrete", "holding", "input"]
PointType = Literal["bit", "u16", "i16", "u32", "i32", "i64"]


class MapEnum(IntEnum):
    """An enumeration of the map. Members know their name in the map and their text."""

    label: str
    text: str

    def __new__(cls, value: int, label: str = "", text: str = "") -> "MapEnum":
        member = int.__new__(cls, value)
        member._value_ = value
        member.label = label
        member.text = text
        return member


'''
CLASSES = '''@dataclass(frozen=True)
class Point:
    """One value, array of values, or bit. Registers carry the high word first."""

    name: str
    address: int
    space: Space
    type: PointType
    text: str
    block: str
    words: int = 1  # registers of one element
    count: int = 1  # elements
    min: int | None = None  # what a write may carry; None where nothing can be written
    max: int | None = None
    allowed: tuple[int, ...] = ()  # the only values that a write may carry, if not empty
    default: int | None = None
    unit: str = ""
    scope: Literal["", "motion", "line"] = ""
    writable: bool = False
    command: bool = False  # writing a value other than 0 runs a command
    reindex: bool = False  # a change makes the index invalid
    secret: bool = False  # reads max if it is not 0; writing max keeps it
    enum: "builtins.type[MapEnum] | None" = None  # names of the values
    bits: "builtins.type[MapEnum] | None" = None  # names of the bits, by bit number
    bits_from: int = 0  # which of them bit 0 is
    mirrors: dict[str, int] = field(default_factory=dict)  # input register addresses by copy


'''


def _string(text: str) -> str:
    """As ruff formats it: double quotes, unless that needs more escapes."""
    return repr(text) if '"' in text else json.dumps(text)


def _call(head: str, items: list[str], depth: int, close: str = ")") -> str:
    """`head` + items on one line if it fits, else one item to a line, as ruff formats it."""
    indent = "    " * depth
    line = f"{indent}{head}{', '.join(items)}{close}"
    # An opening without a bracket (an enum member) becomes bracketed only when it is split.
    if len(line) <= COLUMNS:
        return line + "\n"
    if not head.endswith(("(", "{", "[")):
        head, close = head + "(", ")" + close
    body = "".join(f"{indent}    {item},\n" for item in items)
    return f"{indent}{head}\n{body}{indent}{close}\n"


def class_name(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def member_name(enum_name: str, value_name: str) -> str:
    """A name that begins with a digit gets the last word of its enum's name in front."""
    prefix = f"{enum_name.rpartition('_')[2]}_" if value_name[0].isdigit() else ""
    return f"{prefix}{value_name}".upper()


def _enum(name: str, text: str, values: list[Value]) -> str:
    body = "".join(
        _call(
            f"{member_name(name, value.name)} = ",
            [str(value.value), _string(value.name), _string(value.text)],
            1,
            "",
        )
        for value in values
    )
    return f'class {class_name(name)}(MapEnum):\n    """{text}."""\n\n{body}\n\n'


def _fields(point: Point, block: Block) -> list[str]:
    fields = [
        f"name={_string(point.name)}",
        f"address={point.address}",
        f'space="{block.space}"',
        f'type="{point.type}"',
        f"text={_string(point.text)}",
        f'block="{block.name}"',
    ]
    if point.words > 1:
        fields.append(f"words={point.words}")
    if point.count > 1:
        fields.append(f"count={point.count}")
    if point.writable:
        fields += [f"min={point.min}", f"max={point.max}"]
        if point.allowed:
            trailing = "," if len(point.allowed) == 1 else ""
            fields.append(f"allowed=({', '.join(map(str, point.allowed))}{trailing})")
        fields.append(f"default={point.default}")
    if point.unit:
        fields.append(f"unit={_string(point.unit)}")
    if point.scope:
        fields.append(f'scope="{point.scope}"')
    fields += [
        f"{flag}=True"
        for flag in ("writable", "command", "reindex", "secret")
        if getattr(point, flag)
    ]
    if point.enum:
        fields.append(f"enum={class_name(point.enum)}")
    if point.bits:
        fields.append(f"bits={class_name(point.bits)}")
    if point.bits_from:
        fields.append(f"bits_from={point.bits_from}")
    if block.mirrors:
        mirrors = [f'"{m.name}": {point.address + m.address_offset}' for m in block.mirrors]
        fields.append(f"mirrors={{{', '.join(mirrors)}}}")
    return fields


def _bit_fields(name: str, address: int, text: str, space: str) -> list[str]:
    return [
        f"name={_string(name)}",
        f"address={address}",
        f'space="{space}"',
        'type="bit"',
        f"text={_string(text)}",
        f'block="{space}s"',
    ]


def _coil_fields(coil: Coil) -> list[str]:
    fields = [*_bit_fields(coil.name, coil.address, coil.text, "coil"), "min=0", "max=1"]
    fields += ["default=0", "writable=True"]
    return [*fields, "command=True"] if coil.command else fields


def map_table(map_: Map) -> str:
    parts = [PREAMBLE]
    parts += [_enum(enum.name, enum.text, enum.values) for enum in map_.enums.values()]
    parts.append(
        _enum(FLAG, "Discrete inputs; bit n of the point flags is n, of flags_2 32 + n", map_.flags)
    )
    parts.append(
        _enum(LAUNCH_INHIBIT, "Bit numbers of the point launch_inhibit", map_.launch_inhibit)
    )
    details = [
        f"    {class_name(e.name)}.{member_name(e.name, value.name)}: {class_name(value.detail)},\n"
        for e in map_.enums.values()
        for value in e.values
        if value.detail
    ]
    parts.append(
        "# What names the detail of an event; the details of the others are plain numbers.\n"
        f"DETAIL_ENUMS: dict[MapEnum, type[MapEnum]] = {{\n{''.join(details)}}}\n\n\n"
    )
    parts.append(CLASSES)
    product = map_.product
    parts.append(
        f"MAP_VERSION = {map_.version}\n"
        f"SELF_TEST = 0x{map_.self_test:08X}\n"
        f"VENDOR = {_string(product['vendor'])}\n"
        f"PRODUCT_CODE = {_string(product['code'])}\n"
        f"PRODUCT_NAME = {_string(product['name'])}\n"
        f"PRODUCT_URL = {_string(product['url'])}\n"
        f'PRODUCT_VERSION = "{map_.product_version}"\n\n'
        "# Every point of the map by its name, in the order of the map.\n"
        "POINTS: dict[str, Point] = {\n    point.name: point\n    for point in (\n"
    )
    rows = [_coil_fields(coil) for coil in map_.coils]
    rows += [_bit_fields(f.name, f.value, f.text, "discrete") for f in map_.flags]
    rows += [_fields(point, block) for block in map_.blocks for point in block.points]
    parts += [_call("Point(", row, 2, "),") for row in rows]
    parts.append("    )\n}\n")
    return "".join(parts)
