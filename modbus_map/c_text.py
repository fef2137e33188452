# SPDX-License-Identifier: Apache-2.0
"""Pieces of C source that the core's and the client's generated files share."""

import json
import textwrap

from map_model import FLAG, LAUNCH_INHIBIT, Point, Value

COLUMNS = 100
TAB = 8
# The type in memory of a value that has this type on the wire.
MEMBER_TYPES = {
    "u16": "int32_t",
    "i16": "int32_t",
    "u32": "uint32_t",
    "i32": "int32_t",
    "i64": "int64_t",
}
# The C enumerations of the bit fields' bit numbers.
BIT_ENUMS = {FLAG: "flag", LAUNCH_INHIBIT: "launch_inhibit_bit"}


def header_comment(purpose: str) -> str:
    return (
        "/* SPDX-License-Identifier: Apache-2.0 */\n"
        "/*\n"
        f" * {purpose}\n"
        " * Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py\n"
        " * Do not edit.\n"
        " */\n"
    )


def string(text: str) -> str:
    return json.dumps(text)


def comment(text: str, tabs: int = 0) -> str:
    """A doc comment of its own line or lines."""
    indent = "\t" * tabs
    if tabs * TAB + len(text) + len("/**  */") <= COLUMNS:
        return f"{indent}/** {text} */\n"
    lines = textwrap.wrap(text, COLUMNS - tabs * TAB - len(" * "))
    return f"{indent}/**\n" + "".join(f"{indent} * {line}\n" for line in lines) + f"{indent} */\n"


def defines(pairs: list[tuple[str, str]]) -> str:
    width = max(len(name) for name, _ in pairs)
    return "".join(f"#define {name:<{width}} {value}\n" for name, value in pairs)


def enum(name: str, text: str, values: list[Value]) -> str:
    """Members are the enum's name in capitals, then the value's."""
    prefix = name.removesuffix("_bit").upper()
    body = "".join(
        comment(value.text, 1) + f"\t{prefix}_{value.name.upper()} = {value.value},\n"
        for value in values
    )
    return f"{comment(text)}enum {name} {{\n{body}}};\n"


def member_text(point: Point, enum_prefix: str) -> str:
    """The doc comment of a point: unit in brackets, or the enum to read it with."""
    if point.enum:
        return f"{point.text} (enum {enum_prefix}{point.enum})"
    if point.bits:
        return f"{point.text} (bits: enum {enum_prefix}{BIT_ENUMS[point.bits]})"
    return f"{point.text} [{point.unit}]" if point.unit else point.text


def struct(name: str, text: str, points: list[Point], enum_prefix: str) -> str:
    body = ""
    for point in points:
        size = f"[{point.count}]" if point.count > 1 else ""
        body += comment(member_text(point, enum_prefix), 1)
        body += f"\t{MEMBER_TYPES[point.type]} {point.name}{size};\n"
    return f"{comment(text)}struct {name} {{\n{body}}};\n"


def fill(items: list[str], tabs: int) -> str:
    """Comma-separated items, as many to a line as fit."""
    glued = ", ".join(item.replace(" ", "\0") for item in items) + ","
    lines = textwrap.wrap(
        glued, COLUMNS - tabs * TAB, break_long_words=False, break_on_hyphens=False
    )
    indent = "\t" * tabs
    return "".join(f"{indent}{line}\n" for line in lines).replace("\0", " ")


def initializer(fields: list[str]) -> str:
    """One element of an array of structs, on one line if it fits."""
    line = f"{{{', '.join(fields)}}},"
    if TAB + len(line) <= COLUMNS:
        return f"\t{line}\n"
    return f"\t{{\n{fill(fields, 2)}\t}},\n"


def allowed_array(point: Point) -> str:
    """The array of the only values that may be written, if the point has one."""
    if not point.allowed:
        return ""
    values = ", ".join(str(value) for value in point.allowed)
    return f"static const int32_t allowed_{point.name}[] = {{{values}}};\n"


def allowed_fields(point: Point) -> list[str]:
    if not point.allowed:
        return []
    return [f".allowed = allowed_{point.name}", f".allowed_count = {len(point.allowed)}"]
