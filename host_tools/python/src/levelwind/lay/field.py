# SPDX-License-Identifier: Apache-2.0
"""The compiled law's pattern laid on a drum, and how even it lies: lib/lw_lay through ctypes."""

import ctypes
import errno
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from levelwind.core import layout, native
from levelwind.core.native import I32, U32
from levelwind.errors import ToolError
from levelwind.line.points import PARAMETERS, refusal

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ANGLES = 72
COLUMNS_PER_MM = 4
ROPE_UM_MAX = 50_000
EDGES_MAX = 2_000_000_000
"""More edges than this are not laid: it would take minutes."""
TURNS_MAX = 50_000
"""More drum turns than this are not laid: the path would not fit into the memory."""

_F64 = ctypes.c_double
_F32 = ctypes.c_float
_SIZE = ctypes.c_size_t


class _Grid(ctypes.Structure):
    _fields_ = (("first_column", I32), ("columns", I32), ("first_judged", I32), ("judged", I32))


class _Evenness(ctypes.Structure):
    _fields_ = (("max_mm", _F64), ("mean_mm", _F64), ("std_mm", _F64), ("p5_mm", _F64))


@dataclass(frozen=True)
class Evenness:
    """Of the surface between the far points, in millimetres above the bare drum."""

    max_mm: float
    mean_mm: float
    std_mm: float
    p5_mm: float


@dataclass(frozen=True)
class Field:
    """The surface of a drum with rope on it."""

    height_mm: "NDArray[np.float32]"
    """By angle, then by place across the drum."""
    place_mm: "NDArray[np.float64]"
    """Of the columns, across the drum."""
    position_mm: "NDArray[np.float64]"
    """Of the rope at every angle that it was laid on, in order."""
    centre_mm: "NDArray[np.float64]"
    """Height of the rope's centre there, above the bare drum."""
    rope_mm: float
    judged: slice
    """The columns between the far points, where rope is laid whole."""


@cache
def _library() -> ctypes.CDLL:
    library = native.library()
    layout.check(
        library,
        "lw_layout_lay",
        {"struct lw_native_lay_grid": _Grid, "struct lw_lay_evenness": _Evenness},
    )
    refusal = ctypes.POINTER(native.Refusal)
    values = ctypes.POINTER(I32)
    f64, f32 = ctypes.POINTER(_F64), ctypes.POINTER(_F32)
    library.lw_native_lay_grid.argtypes = (values, U32, ctypes.POINTER(_Grid), refusal)
    library.lw_native_lay.argtypes = (
        *(values, U32, _SIZE, f64, f64, f32, ctypes.POINTER(_Evenness), refusal),
    )
    library.lw_native_lay_path.argtypes = (U32, I32, I32, f64, _SIZE, f64, f32)
    library.lw_native_double_traverses.argtypes = (
        values,
        ctypes.POINTER(ctypes.c_uint64),
        _SIZE,
        refusal,
    )
    return library


def _values(parameters: Mapping[str, int]) -> ctypes.Array[I32]:
    ordered = [parameters[point.name] for point in PARAMETERS]
    return (I32 * len(ordered))(*ordered)


def _check(status: int, why: native.Refusal) -> None:
    if status == -errno.EINVAL:
        raise refusal(why.reason, why.address, why.value, why.limit)
    if status != 0:
        raise ToolError(f"The rope cannot be laid: {os.strerror(-status)}.")


def _f64(array: "NDArray[np.float64]") -> object:
    return array.ctypes.data_as(ctypes.POINTER(_F64))


def _f32(array: "NDArray[np.float32]") -> object:
    return array.ctypes.data_as(ctypes.POINTER(_F32))


def double_traverses(parameters: Mapping[str, int], count: int) -> list[int]:
    """Edges of successive double traverses, from one far point at plus to the next."""
    edges, why = (ctypes.c_uint64 * count)(), native.Refusal()
    values = _values(parameters)
    _check(_library().lw_native_double_traverses(values, edges, count, ctypes.byref(why)), why)
    return list(edges)


def evenness(parameters: Mapping[str, int], rope_um: int, turns: float) -> Evenness:
    """How even so many turns of rope lie. Other threads go on meanwhile."""
    found, why = _Evenness(), native.Refusal()
    status = _library().lw_native_lay(
        _values(parameters), rope_um, _angles(turns), None, None, None,
        ctypes.byref(found), ctypes.byref(why),
    )  # fmt: skip
    _check(status, why)
    return Evenness(found.max_mm, found.mean_mm, found.std_mm, found.p5_mm)


def lay(parameters: Mapping[str, int], rope_um: int, turns: float) -> Field:
    """The surface that so many turns of rope make."""
    import numpy as np  # noqa: PLC0415 - a tenth of a second

    library = _library()
    values, grid, why = _values(parameters), _Grid(), native.Refusal()
    _check(library.lw_native_lay_grid(values, rope_um, ctypes.byref(grid), ctypes.byref(why)), why)
    count = _angles(turns)
    height = np.zeros((ANGLES, grid.columns), dtype=np.float32)
    position, centre = np.zeros(count), np.zeros(count)
    status = library.lw_native_lay(
        values, rope_um, count, _f64(position), _f64(centre), _f32(height),
        ctypes.byref(_Evenness()), ctypes.byref(why),
    )  # fmt: skip
    _check(status, why)
    first = grid.first_judged - grid.first_column
    places = (np.arange(grid.columns) + grid.first_column) / COLUMNS_PER_MM
    judged = slice(first, first + grid.judged)
    return Field(height, places, position, centre, rope_um / 1000, judged)


def lay_path(position_mm: "NDArray[np.float64]", rope_um: int) -> Field:
    """The surface of rope laid along any path, given at every angle of the grid from 0 on."""
    import numpy as np  # noqa: PLC0415

    position = np.ascontiguousarray(position_mm, dtype=np.float64)
    half = rope_um * COLUMNS_PER_MM // 2000
    low, high = (position.min(), position.max()) if len(position) else (0.0, 0.0)
    first = int(np.floor(low * COLUMNS_PER_MM)) - half
    last = int(np.ceil(high * COLUMNS_PER_MM)) + half
    height = np.zeros((ANGLES, last - first + 1), dtype=np.float32)
    centre = np.zeros(len(position))
    status = _library().lw_native_lay_path(
        rope_um, first, last - first + 1, _f64(position), len(position), _f64(centre), _f32(height)
    )
    if status != 0:
        raise ToolError(f"A rope of {rope_um / 1000:g} mm cannot be laid.")
    places = (np.arange(first, last + 1)) / COLUMNS_PER_MM
    return Field(
        height, places, position, centre, rope_um / 1000, slice(half, last - first + 1 - half)
    )


def _angles(turns: float) -> int:
    return max(1, round(turns * ANGLES))
