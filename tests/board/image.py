# SPDX-License-Identifier: Apache-2.0
"""What the image's ELF file says about its variables: where they are, and what is in them."""

import functools
from pathlib import Path
from typing import NamedTuple

from elftools.dwarf.die import DIE
from elftools.elf.elffile import ELFFile

from board.machine import IMAGE

ELF = IMAGE.with_suffix(".elf")


class Leaf(NamedTuple):
    """A member that has no members itself."""

    path: str  # as in C: "motion.law.u", "limit[0].active"
    offset: int
    size: int


@functools.cache
def _symbols(elf: Path) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    with elf.open("rb") as file:
        for symbol in ELFFile(file).get_section_by_name(".symtab").iter_symbols():
            found.setdefault(symbol.name, []).append(symbol["st_value"])
    return found


def symbol(name: str, elf: Path = ELF) -> int:
    """The address of a variable of the image, of whatever file."""
    found = _symbols(elf).get(name, [])
    assert len(found) == 1, f"{name}: {found}"
    return found[0]


def _type(die: DIE) -> DIE | None:
    """Its type, without names, const, volatile and atomic."""
    while "DW_AT_type" in die.attributes:
        die = die.get_DIE_from_attribute("DW_AT_type")
        if die.tag in (
            "DW_TAG_structure_type",
            "DW_TAG_union_type",
            "DW_TAG_array_type",
            "DW_TAG_pointer_type",
            "DW_TAG_base_type",
            "DW_TAG_enumeration_type",
        ):
            return die
    return None


def _attribute(die: DIE, name: str, otherwise: object) -> object:
    return die.attributes[name].value if name in die.attributes else otherwise


def _size(die: DIE) -> int:
    if die.tag == "DW_TAG_array_type":
        size = _size(_type(die))
        for dimension in die.iter_children():
            size *= dimension.attributes["DW_AT_upper_bound"].value + 1
        return size
    return die.attributes["DW_AT_byte_size"].value


def _leaves(die: DIE, path: str, offset: int) -> list[Leaf]:
    if die.tag in ("DW_TAG_structure_type", "DW_TAG_union_type"):
        found = []
        for member in die.iter_children():
            if member.tag == "DW_TAG_member":
                name = _attribute(member, "DW_AT_name", b"").decode()
                at = _attribute(member, "DW_AT_data_member_location", 0)
                where = ".".join(part for part in (path, name) if part)
                found += _leaves(_type(member), where, offset + at)
        return found
    if die.tag == "DW_TAG_array_type":
        element = _type(die)
        size = _size(element)
        found = []
        for i in range(_size(die) // size):
            found += _leaves(element, f"{path}[{i}]", offset + i * size)
        return found
    return [Leaf(path, offset, _size(die))]


def member(structure: str, path: str, elf: Path = ELF) -> Leaf:
    """One member of a struct."""
    return next(leaf for leaf in members(structure, elf)[1] if leaf.path == path)


@functools.cache
def members(structure: str, elf: Path = ELF) -> tuple[int, list[Leaf]]:
    """Size and members of a struct of C, those of its structs and arrays in their place."""
    with elf.open("rb") as file:
        for unit in ELFFile(file).get_dwarf_info().iter_CUs():
            for die in unit.iter_DIEs():
                if (
                    die.tag == "DW_TAG_structure_type"
                    and _attribute(die, "DW_AT_name", b"") == structure.encode()
                    and "DW_AT_byte_size" in die.attributes
                ):
                    return _size(die), _leaves(die, "", 0)
    raise AssertionError(f"no struct {structure} in {elf}")
