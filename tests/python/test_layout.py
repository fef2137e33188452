# SPDX-License-Identifier: Apache-2.0
"""What differs between Python's copies and the compiled library is told when it is loaded."""

import ctypes
from enum import IntEnum

import pytest
from levelwind.cam import table
from levelwind.core import layout, native
from levelwind.errors import ToolError

I32 = ctypes.c_int32


def load() -> ctypes.CDLL:
    return ctypes.CDLL(str(native.find(native.LIBRARY)))


def structure(*fields: tuple[str, type]) -> type[ctypes.Structure]:
    return type("Copy", (ctypes.Structure,), {"_fields_": fields})


def test_the_copies_of_the_package_are_right():
    native.library()
    table._library()


@pytest.mark.parametrize(
    ("copy", "said"),
    [
        (structure(("master", I32)), "struct lw_cam_row has slave, which Python's copy lacks"),
        (structure(("master", I32), ("slave", I32), ("third", I32)), "lacks third, which Python"),
        (structure(("slave", I32), ("master", I32)), "has master at byte 0, 4 long; Python's"),
        (structure(("master", I32), ("slave", ctypes.c_int64)), "has slave at byte 4, 4 long"),
    ],
)
def test_a_struct_that_differs_is_named(copy: type[ctypes.Structure], said: str):
    with pytest.raises(ToolError, match=said):
        layout.check(load(), "lw_layout_cam", {"struct lw_cam_row": copy})


FAULTS = [
    *("STALL_MS", "SLIP_USTEPS", "SIDE_LOAD", "BOUNCE_US", "LIMIT_PLUS", "LIMIT_MINUS"),
    *("OVERTRAVEL_PLUS", "OVERTRAVEL_MINUS", "ENCODER_LOSE_PULSES", "ENCODER_ILLEGAL"),
    *("ENCODER_DITHER", "PLACE_CARRIAGE_UM", "CARRIAGE_REVERSED"),
]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (FAULTS, "enum lw_plant_fault has ENCODER_EXTRA_PULSES = 13, where Python's copy has noth"),
        (["SLIP", "STALL"], "has STALL = 0, where Python's copy has SLIP"),
    ],
)
def test_an_enumeration_that_differs_is_named(names: list[str], said: str):
    copy = IntEnum("Copy", [(name, value) for value, name in enumerate(names)])
    with pytest.raises(ToolError, match=said):
        layout.check(load(), "lw_layout_native", {"enum lw_plant_fault": copy})


def test_a_library_of_another_version_is_told():
    with pytest.raises(ToolError, match="struct lw_other is not told"):
        layout.check(load(), "lw_layout_none", {"struct lw_other": structure(("a", I32))})


def test_a_member_that_the_librarys_list_forgets_leaves_a_gap():
    compiled = {"": (0, 12), "a": (0, 4), "c": (8, 4)}
    said = layout._struct_difference(compiled, dict(compiled))
    assert said == "has bytes 4 to 7 that its list of members does not name"
    padded = {"": (0, 16), "a": (0, 1), "b": (8, 8)}
    assert layout._struct_difference(padded, dict(padded)) == ""


def test_an_enumerations_list_that_forgets_a_value_is_told():
    compiled = {"LW_X_A": (0, 0), "LW_X_B": (1, 0), "LW_X_COUNT": (3, 0)}
    copy = IntEnum("Copy", {"A": 0, "B": 1})
    said = layout._enum_difference(compiled, copy)
    assert said == "has 3 values, of which its list names 2"
    assert layout._enum_difference(compiled | {"LW_X_COUNT": (2, 0)}, copy) == ""
