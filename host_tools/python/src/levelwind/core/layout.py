# SPDX-License-Identifier: Apache-2.0
"""The layout of what Python and a compiled library hand each other: compared when it is loaded."""

import ctypes
import itertools
from collections.abc import Mapping
from enum import IntEnum
from typing import Any

from levelwind.errors import ToolError


class _Entry(ctypes.Structure):
    """struct lw_layout (lw/bytes/layout.h)."""

    _fields_ = (
        ("type", ctypes.c_char_p),
        ("name", ctypes.c_char_p),
        ("offset", ctypes.c_uint32),
        ("size", ctypes.c_uint32),
    )


Members = dict[str, tuple[int, int]]
"""Offset and size of each member of a struct, of "" the struct itself; of an enumeration its values
and 0."""


def exported(library: ctypes.CDLL, table: str) -> dict[str, Members]:
    """What a library says of its structs and enumerations."""
    found: dict[str, Members] = {}
    entries = ctypes.cast(ctypes.addressof(_Entry.in_dll(library, table)), ctypes.POINTER(_Entry))
    index = 0
    while entries[index].type is not None:
        entry = entries[index]
        found.setdefault(entry.type.decode(), {})[entry.name.decode()] = (entry.offset, entry.size)
        index += 1
    return found


def check(library: ctypes.CDLL, table: str, copies: Mapping[str, Any]) -> None:
    """Compare Python's copies with what the library was built from.

    `copies`: by the type's name in C a ctypes.Structure, a numpy.dtype or an IntEnum, whose names
    may have a unit that C's lack. ToolError says what differs.
    """
    try:
        types = exported(library, table)
    except ValueError:
        types = {}
    for name, copy in copies.items():
        difference = (
            (
                _enum_difference(types[name], copy)
                if isinstance(copy, type) and issubclass(copy, IntEnum)
                else _struct_difference(types[name], _members(copy))
            )
            if name in types
            else "is not told"
        )
        if difference:
            raise ToolError(
                f"{library._name}: {name} {difference}. The library and this tool are not of one "
                "version: build it again (./dev sim)."
            )


def _members(copy: Any) -> Members:
    if isinstance(copy, type) and issubclass(copy, ctypes.Structure):
        fields = ((field[0], getattr(copy, field[0])) for field in copy._fields_)
        return {name: (at.offset, at.size) for name, at in fields} | {"": (0, ctypes.sizeof(copy))}
    return {name: (at[1], at[0].itemsize) for name, at in copy.fields.items()} | {
        "": (0, copy.itemsize)
    }


def _struct_difference(compiled: Members, copy: Members) -> str:
    for name in [*(name for name in compiled if name), *(name for name in copy if name)]:
        if name not in copy:
            return f"has {name}, which Python's copy lacks"
        if name not in compiled:
            return f"lacks {name}, which Python's copy has"
        if compiled[name] != copy[name]:
            return (
                f"has {name} at byte {compiled[name][0]}, {compiled[name][1]} long; Python's copy "
                f"at {copy[name][0]}, {copy[name][1]} long"
            )
    if compiled[""] != copy[""]:
        return f"has {compiled[''][1]} bytes, Python's copy {copy[''][1]}"
    return _untold(compiled)


def _untold(compiled: Members) -> str:
    """A member that the library's own list has forgotten leaves a gap wider than an alignment."""
    end = 0
    widest = 1
    rows = sorted(place for name, place in compiled.items() if name)
    for offset, size in [*rows, (compiled[""][1], 0)]:
        alignment = (size & -size) if size else widest
        widest = max(widest, min(alignment, 8))
        if offset - end >= min(alignment, 8):
            return f"has bytes {end} to {offset - 1} that its list of members does not name"
        end = offset + size
    return ""


def _enum_difference(compiled: Members, copy: type[IntEnum]) -> str:
    words = [name.split("_") for name in compiled]
    same = itertools.takewhile(lambda column: len(set(column)) == 1, zip(*words, strict=False))
    prefix = "_".join(column[0] for column in same) + "_"
    counts = {value for name, (value, _) in compiled.items() if name.endswith("_COUNT")}
    values = {
        value: name.removeprefix(prefix)
        for name, (value, _) in compiled.items()
        if not name.endswith("_COUNT")
    }
    for count in counts - {len(values)}:
        return f"has {count} values, of which its list names {len(values)}"
    for value in sorted(values.keys() | {int(member) for member in copy}):
        ours = copy(value).name if value in {int(member) for member in copy} else None
        if value not in values:
            return f"lacks {value}, which is {ours} in Python's copy"
        if ours is None or not ours.startswith(values[value]):
            return f"has {values[value]} = {value}, where Python's copy has {ours or 'nothing'}"
    return ""
