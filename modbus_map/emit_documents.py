# SPDX-License-Identifier: Apache-2.0
"""For integrators: doc/registers.md and the tag list modbus_map/tags.csv."""

import csv
import io

from map_model import FLAG, LAUNCH_INHIBIT, Block, Map, Point, Value

REFERENCE_BASES = {"coil": 0, "discrete": 1, "input": 3, "holding": 4}
SPACE_TITLES = {"holding": "Holding registers", "input": "Input registers"}
INTRODUCTION = """\
# Registers

<!-- Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py. Do not edit. -->

Map version {version}, {name} {product_version}. Addresses are 0-based protocol addresses; *ref* is
the same place in the 40001 form that many PLC tools ask for. A value of two or four registers
(`u32`, `i32`, `i64`) carries its high word first and must be written whole. Access: `r` read, `w`
write. The rules behind the tables are in [integration.md](integration.md).

| | read | write |
| --- | --- | --- |
| Coils | FC01 | FC05, FC15 |
| Discrete inputs | FC02 | |
| Holding registers | FC03, FC23 | FC06, FC22 (one register); FC16, FC23 |
| Input registers | FC04 | |
"""


def reference(space: str, address: int) -> str:
    """The address in the 40001 form; six digits beyond 9999."""
    digits = 4 if address < 9999 else 5
    return f"{REFERENCE_BASES[space]}{address + 1:0{digits}}"


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |\n" for line in lines
    )


def _limits(point: Point) -> str:
    if not point.writable:
        return ""
    if point.allowed:
        return ", ".join(str(value) for value in point.allowed)
    return f"{point.min} to {point.max}"


def _meaning(point: Point) -> str:
    if point.enum:
        return f"{point.text}: [{point.enum}](#{point.enum})"
    if point.bits:
        return f"{point.text}: [{point.bits}](#{point.bits})"
    return point.text


def _type(point: Point) -> str:
    return f"{point.type}[{point.count}]" if point.count > 1 else point.type


def _block(block: Block) -> str:
    parts = [f"\n## {SPACE_TITLES[block.space]}: {block.name}\n\n{block.text}.\n\n"]
    for mirror in block.mirrors:
        example = block.points[0]
        address = example.address + mirror.address_offset
        parts.append(
            f"- To read {mirror.text}: input registers, address + {mirror.address_offset} "
            f"(`{mirror.name}_{example.name}`: {address}, ref {reference('input', address)}).\n"
        )
    writable = any(point.writable for point in block.points)
    parameters = bool(block.mirrors)
    if parameters:
        parts.append(
            "- *Re-index*: a change of this value makes the position unknown; index again.\n\n"
        )
    head = ["address", "ref", "name", "type"]
    head += ["access", "unit", "limits", "default"] if writable else ["unit"]
    head += ["re-index"] if parameters else []
    rows = []
    for point in block.points:
        row = [
            str(point.address),
            reference(block.space, point.address),
            f"`{point.name}`",
            _type(point),
        ]
        if writable:
            row += ["rw" if point.writable else "r", point.unit, _limits(point)]
            row.append(str(point.default) if point.writable else "")
        else:
            row.append(point.unit)
        row += ["yes" if point.reindex else ""] if parameters else []
        rows.append([*row, _meaning(point)])
    parts.append(_table([*head, "meaning"], rows))
    return "".join(parts)


def _value_meaning(value: Value) -> str:
    detail = f". Detail: [{value.detail}](#{value.detail})" if value.detail else ""
    return value.text + detail


def _values(name: str, text: str, values: list[Value], column: str) -> str:
    rows = [[str(value.value), f"`{value.name}`", _value_meaning(value)] for value in values]
    return f"\n### {name}\n\n{text}.\n\n" + _table([column, "name", "meaning"], rows)


def registers_md(map_: Map) -> str:
    parts = [
        INTRODUCTION.format(
            version=map_.version,
            name=map_.product["name"],
            product_version=map_.product_version,
        )
    ]
    parts.append("\n## Coils\n\nMomentary commands. Writing 0 does nothing (jog: releases).\n\n")
    rows = [
        [str(coil.address), reference("coil", coil.address), f"`{coil.name}`", coil.text]
        for coil in map_.coils
    ]
    parts.append(_table(["address", "ref", "name", "meaning"], rows))
    parts.append(
        f"\n## Discrete inputs\n\n### {FLAG}\n\n"
        "The same bits stand in the input registers `flags`, bit number = address, and `flags_2`, "
        "bit number = address - 32.\n\n"
    )
    rows = [
        [str(flag.value), reference("discrete", flag.value), f"`{flag.name}`", flag.text]
        for flag in map_.flags
    ]
    parts.append(_table(["address", "ref", "name", "meaning"], rows))
    parts += [_block(block) for block in map_.blocks if not block.bench]
    parts.append("\n## Values\n")
    bench_blocks = [block for block in map_.blocks if block.bench]
    bench_enums = {point.enum for block in bench_blocks for point in block.points}
    for enum in map_.enums.values():
        if enum.name not in bench_enums:
            parts.append(_values(enum.name, enum.text, enum.values, "value"))
    text = "Why a launch is not permitted; all 0 is the launch permit"
    parts.append(_values(LAUNCH_INHIBIT, text, map_.launch_inhibit, "bit"))
    parts += [_block(block) for block in bench_blocks]
    for enum in map_.enums.values():
        if enum.name in bench_enums:
            parts.append(_values(enum.name, enum.text, enum.values, "value"))
    return "".join(parts)


def _tag(space: str, address: int, name: str, **fields: object) -> dict:
    place = {"space": space, "address0": address, "reference": reference(space, address)}
    return {"name": name, **place, **fields}


def _point_tags(block: Block, point: Point) -> list[dict]:
    """The point and its mirrors."""
    common = {
        "type": point.type,
        "words": point.words,
        "unit": point.unit,
        "text": point.text,
    }
    tag = _tag(block.space, point.address, point.name, access="r", **common)
    tag["function_codes"] = "4" if block.space == "input" else "3"
    if point.writable:
        codes = "3/6/16" if point.words == 1 else "3/16"
        tag |= {"function_codes": codes, "access": "rw"}
        tag |= {"min": point.min, "max": point.max, "default": point.default}
    mirrors = [
        _tag(
            "input",
            point.address + mirror.address_offset,
            f"{mirror.name}_{point.name}",
            function_codes="4",
            access="r",
            **common,
        )
        for mirror in block.mirrors
    ]
    return [tag, *mirrors]


def tags_csv(map_: Map) -> str:
    """Without the bench: hardware does not have its registers."""
    bit = {"type": "bit", "words": ""}
    tags = [
        _tag(
            "coil",
            c.address,
            c.name,
            **bit,
            function_codes="1/5/15",
            access="rw",
            min=0,
            max=1,
            default=0,
            text=c.text,
        )
        for c in map_.coils
    ]
    tags += [
        _tag("discrete", f.value, f.name, **bit, function_codes="2", access="r", text=f.text)
        for f in map_.flags
    ]
    for block in map_.blocks:
        if not block.bench:
            tags += [tag for point in block.points for tag in _point_tags(block, point)]
    columns = ["name", "space", "function_codes", "address0", "reference", "type", "words"]
    columns += ["unit", "min", "max", "default", "access", "text"]
    output = io.StringIO()
    writer = csv.DictWriter(output, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(tags)
    return output.getvalue()
