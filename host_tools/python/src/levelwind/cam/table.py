# SPDX-License-Identifier: Apache-2.0
"""Cam tables: the rows, the compiled core's check of them, and the compiled cam replayed."""

import ctypes
import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from levelwind.core import layout
from levelwind.core.native import I32, I64, LIBRARY, U32, find
from levelwind.errors import RefusedError, ToolError
from levelwind.map_table import CamInterpolation, Reason

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ROWS_MAX = 256
NAME_SIZE = 16
I32_MIN, I32_MAX = -(2**31), 2**31 - 1
U16 = ctypes.c_uint16


class Row(ctypes.Structure):
    """struct lw_cam_row."""

    _fields_ = (("master", I32), ("slave", I32))


class NativeTable(ctypes.Structure):
    """struct lw_cam_table."""

    _fields_ = (
        ("name", ctypes.c_char * NAME_SIZE),
        ("version", U32),
        ("interpolation", U16),
        ("row_count", U16),
        ("advance", I32),
        ("rows", Row * ROWS_MAX),
    )


class _Scale(ctypes.Structure):
    _fields_ = (
        ("edges", I32),
        ("master_units", I32),
        ("usteps", I32),
        ("slave_units", I32),
        ("ramp_divisor", I32),
    )


class _Limits(ctypes.Structure):
    _fields_ = (("top_edges_per_s", U32), ("steps_per_s_max", U32))


class _Refusal(ctypes.Structure):
    _fields_ = (("reason", U16), ("row", U16), ("value", I32), ("limit", I32))


class _Statistics(ctypes.Structure):
    _fields_ = (
        ("cycle_edges", U32),
        ("min_usteps", I32),
        ("max_usteps", I32),
        ("slope_max_permille", U32),
        ("slope_max_row", U16),
    )


class _Numbers(ctypes.Structure):
    _fields_ = (
        ("remainder", U32),
        ("slope", U32),
        ("whole", I32),
        ("remainder_high", U32),
        ("slope_high", U32),
    )


class _Point(ctypes.Structure):
    _fields_ = (("numbers", _Numbers), ("left", U32), ("pos_usteps", U32))


class _Piece(ctypes.Structure):
    _fields_ = (
        ("den", I64),
        ("curve", I64),
        ("first_at", U32),
        ("edges", U32),
        ("cycles", I32),
        ("row", U16),
        ("whole_curve", ctypes.c_int8),
        ("kind", ctypes.c_uint8),
    )


class _State(ctypes.Structure):
    """struct lw_cam."""

    _fields_ = (
        ("point", _Point),
        ("piece", _Piece),
        ("offset", I64),
        ("was_pos", I64),
        ("serial", U32),
        ("stride", U32),
        ("table", ctypes.c_void_p),
        ("scale", _Scale),
    )


class _Result(ctypes.Structure):
    _fields_ = (
        ("pos", I64),
        ("min_pos", I64),
        ("max_pos", I64),
        ("pulses", I64),
        ("edges", I64),
        ("row", I32),
        ("cycles", I32),
        ("step_max", I32),
        ("trace_count", ctypes.c_uint64),
    )


@dataclass(frozen=True)
class Scale:
    """From table units to the machine's, and the ramps of trapezoid rows."""

    edges: int = 1
    master_units: int = 1
    usteps: int = 1
    slave_units: int = 1
    ramp_divisor: int = 10

    @property
    def native(self) -> _Scale:
        """For the core."""
        return _Scale(
            self.edges, self.master_units, self.usteps, self.slave_units, self.ramp_divisor
        )


@dataclass(frozen=True)
class Limits:
    """What the machine can follow."""

    top_edges_per_s: int
    steps_per_s_max: int


@dataclass(frozen=True)
class Table:
    """Rows of (master, slave) and how to go through them."""

    rows: tuple[tuple[int, int], ...]
    interpolation: CamInterpolation = CamInterpolation.LINEAR
    advance: int = 0
    name: str = ""
    version: int = 0

    def native(self) -> NativeTable:
        """For the core, which says itself what is wrong with too many rows."""
        table = NativeTable(
            name=self.name.encode("ascii", "replace")[:NAME_SIZE],
            version=self.version,
            interpolation=self.interpolation,
            row_count=min(len(self.rows), 2**16 - 1),
            advance=self.advance,
        )
        for at, (master, slave) in enumerate(self.rows[:ROWS_MAX]):
            for value in (master, slave):
                if not I32_MIN <= value <= I32_MAX:
                    raise ToolError(
                        f"Row {at + 1}: {value} is beyond 32 bits, limits {I32_MIN} to {I32_MAX}."
                    )
            table.rows[at] = Row(master, slave)
        return table


def words(table: Table) -> list[int]:
    """A table as the 16-bit words of a bank: head with CRC-32, rows (lw/cam/cam_banks.h)."""
    name = table.name.encode("ascii", "replace")[:NAME_SIZE].ljust(NAME_SIZE, b"\0")
    head = struct.pack(
        ">16sIHHi", name, table.version, table.interpolation, len(table.rows), table.advance
    )
    rows = b"".join(struct.pack(">ii", master, slave) for master, slave in table.rows)
    crc = struct.pack(">I", zlib.crc32(head + rows))
    return list(struct.unpack(f">{len(head + crc + rows) // 2}H", head + crc + rows))


def from_words(words: Sequence[int]) -> Table:
    """The table in the words of a bank; ToolError if its CRC is wrong."""
    data = struct.pack(f">{len(words)}H", *words)
    name, version, interpolation, count, advance, crc = struct.unpack(">16sIHHiI", data[:32])
    rows = data[32 : 32 + 8 * count]
    if len(rows) != 8 * count or zlib.crc32(data[:28] + rows) != crc:
        raise ToolError("The bank holds no whole cam table: its CRC is wrong.")
    return Table(
        tuple(struct.iter_unpack(">ii", rows)),
        CamInterpolation(interpolation),
        advance,
        name.rstrip(b"\0").decode("ascii", "replace"),
        version,
    )


@dataclass(frozen=True)
class Statistics:
    """Numbers about an accepted table."""

    cycle_edges: int
    min_usteps: int
    max_usteps: int
    slope_max_permille: int
    slope_max_row: int


@dataclass(frozen=True)
class Replay:
    """Where the cam ended, and on the way."""

    pos: int
    min_pos: int
    max_pos: int
    pulses: int
    edges: int
    row: int
    cycles: int
    step_max: int


class CamRefusedError(RefusedError):
    """The core refused a table."""

    def __init__(self, reason: Reason, row: int, value: int, limit: int) -> None:
        where = f"Row {row}: " if row else ""
        super().__init__(
            f"{where}{reason.text}: {value}, limit {limit}.", reason, None, value, limit
        )
        self.row = row


@cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(find(LIBRARY)))
    pointer = ctypes.POINTER
    layout.check(
        library,
        "lw_layout_cam",
        {
            "struct lw_cam_row": Row,
            "struct lw_cam_table": NativeTable,
            "struct lw_cam_scale": _Scale,
            "struct lw_cam_limits": _Limits,
            "struct lw_cam_refusal": _Refusal,
            "struct lw_cam_statistics": _Statistics,
            "struct lw_cam_numbers": _Numbers,
            "struct lw_cam_point": _Point,
            "struct lw_cam_piece": _Piece,
            "struct lw_cam": _State,
            "struct lw_native_cam_result": _Result,
        },
    )
    library.lw_native_cam_check.argtypes = (
        pointer(NativeTable),
        pointer(_Scale),
        pointer(_Limits),
        pointer(_Statistics),
        pointer(_Refusal),
    )
    library.lw_native_cam_start.restype = None
    library.lw_native_cam_start.argtypes = (
        pointer(_State),
        pointer(NativeTable),
        pointer(_Scale),
        I64,
    )
    library.lw_native_cam_run.restype = None
    library.lw_native_cam_run.argtypes = (
        pointer(_State),
        pointer(I32),
        ctypes.c_size_t,
        pointer(NativeTable),
        pointer(_Result),
        pointer(I64),
        ctypes.c_size_t,
        ctypes.c_size_t,
    )
    return library


def check(table: Table, scale: Scale, limits: Limits) -> Statistics:
    """The core's check of a whole table; CamRefusedError names row, value and limit."""
    out, why = _Statistics(), _Refusal()
    status = _library().lw_native_cam_check(
        table.native(), scale.native, _Limits(limits.top_edges_per_s, limits.steps_per_s_max),
        out, why,
    )  # fmt: skip
    if status != 0:
        raise CamRefusedError(Reason(why.reason), why.row, why.value, why.limit)
    return Statistics(*(getattr(out, name) for name, _ in _Statistics._fields_))


class Cam:
    """The compiled cam on a checked table."""

    def __init__(self, table: Table, scale: Scale, start_edges: int = 0) -> None:
        library = _library()
        self._state = _State()
        self._tables = [table.native()]  # the state points to them
        library.lw_native_cam_start(self._state, self._tables[0], scale.native, start_edges)

    def run(
        self, runs: Sequence[int], trace_points: int = 0, next_table: Table | None = None
    ) -> tuple[Replay, "NDArray[np.int64]", int]:
        """Take runs of edges, negative for backward.

        Returns the result, the position before every n-th edge (empty without trace_points), and n.
        """
        import numpy as np  # noqa: PLC0415 - a tenth of a second that tables do not need

        total = sum(map(abs, runs))
        stride = max(1, -(-total // trace_points)) if trace_points else 1
        capacity = total // stride + 1 if trace_points else 0
        trace = (I64 * max(1, capacity))()
        result = _Result()
        if next_table is not None:
            self._tables.append(next_table.native())
        _library().lw_native_cam_run(
            self._state,
            (I32 * max(1, len(runs)))(*runs),
            len(runs),
            self._tables[-1] if next_table is not None else None,
            result,
            trace,
            stride,
            capacity,
        )
        names = [name for name, _ in _Result._fields_ if name != "trace_count"]
        values = Replay(*(getattr(result, name) for name in names))
        return values, np.ctypeslib.as_array(trace)[: result.trace_count], stride

    def state(self) -> dict[str, int]:
        """What of the core's state is a function of net edges."""
        point, piece = self._state.point, self._state.piece
        return {
            name: getattr(part, name)
            for part in (point.numbers, point, piece)
            for name, *_ in part._fields_
            if name != "numbers"
        }
