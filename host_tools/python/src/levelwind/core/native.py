# SPDX-License-Identifier: Apache-2.0
"""The compiled core: where it is, and its functions that need no device, through ctypes."""

import ctypes
import errno
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from levelwind.core import layout
from levelwind.errors import ToolError
from levelwind.line.points import PARAMETERS, refusal

LIBRARY = {"win32": "liblw_native.dll", "darwin": "liblw_native.dylib"}.get(
    sys.platform, "liblw_native.so"
)
SIMULATOR = "lw_sim.exe" if sys.platform == "win32" else "lw_sim"
I32 = ctypes.c_int32
I64 = ctypes.c_int64
U32 = ctypes.c_uint32


class _ReplaySetup(ctypes.Structure):
    _fields_ = (
        ("ka", I32),
        ("nr", I32),
        ("lplus_usteps", I32),
        ("lminus_usteps", I32),
        ("m", I32),
        ("u", I32),
        ("dwell_plus_edges", I32),
        ("dwell_minus_edges", I32),
        ("breaker_edges", I32),
        ("breaker_cycles", I32),
    )


class _ReplayResult(ctypes.Structure):
    _fields_ = (
        ("m", I32),
        ("u", I32),
        ("dwell", I32),
        ("cycle_plus", I32),
        ("cycle_minus", I32),
        ("min_pos", I32),
        ("max_pos", I32),
        ("steps", I64),
        ("pulses", I64),
        ("edges", I64),
        ("trace_count", ctypes.c_uint64),
    )


class _Derived(ctypes.Structure):
    _fields_ = (
        ("ka", I32),
        ("nr", I32),
        ("ks", I32),
        ("reversal_plus_usteps", I32),
        ("reversal_minus_usteps", I32),
        ("slope_error_ppm", I32),
        ("overshoot_error_um", I32),
        ("overshoot_um", I32),
        ("edges_per_1000_drum_revs", U32),
        ("dwell_plus_edges", U32),
        ("dwell_minus_edges", U32),
        ("breaker_edges", U32),
        ("breaker_cycles", U32),
    )


class Refusal(ctypes.Structure):
    """struct lw_refusal."""

    _fields_ = (
        ("reason", ctypes.c_uint16),
        ("address", ctypes.c_uint16),
        ("value", I32),
        ("limit", I32),
    )


def find(name: str) -> Path:
    """The path of a compiled file."""
    folders = [Path(__file__).parents[1] / "_native", *_source_builds()]
    named = os.environ.get("LEVELWIND_NATIVE_DIR")
    if named:
        folders.insert(0, Path(named))
    for folder in folders:
        if (folder / name).is_file():
            return folder / name
    raise ToolError(
        f"{name} is not built (looked in {', '.join(map(str, folders))}).\n"
        "Run `./dev sim` once in the source tree, or name its folder in LEVELWIND_NATIVE_DIR."
    )


def _source_builds() -> list[Path]:
    """build/host of the source tree that this file stands in, if it does."""
    parents = Path(__file__).resolve().parents
    return [
        p / "build" / "host" for p in parents if (p / "modbus_map" / "registers.yaml").is_file()
    ]


@cache
def library() -> ctypes.CDLL:
    """The compiled core, host and all."""
    path = find(LIBRARY)
    try:
        loaded = ctypes.CDLL(str(path))
    except OSError as error:
        raise ToolError(f"{path} cannot be loaded: {error}.") from error
    layout.check(
        loaded,
        "lw_layout_native",
        {
            "struct lw_native_replay_setup": _ReplaySetup,
            "struct lw_native_replay_result": _ReplayResult,
            "struct lw_native_derived": _Derived,
            "struct lw_refusal": Refusal,
        },
    )
    loaded.lw_native_replay.argtypes = (
        ctypes.POINTER(_ReplaySetup),
        ctypes.POINTER(I32),
        ctypes.c_size_t,
        ctypes.POINTER(_ReplayResult),
        ctypes.POINTER(I32),
        ctypes.c_size_t,
        ctypes.c_size_t,
    )
    loaded.lw_native_derive.argtypes = (
        ctypes.POINTER(I32),
        ctypes.POINTER(_Derived),
        ctypes.POINTER(Refusal),
    )
    return loaded


@dataclass(frozen=True)
class Derived:
    """What the core derives from a parameter set."""

    ka: int
    nr: int
    ks: int
    reversal_plus_usteps: int
    reversal_minus_usteps: int
    slope_error_ppm: int
    overshoot_error_um: int
    overshoot_um: int
    edges_per_1000_drum_revs: int
    dwell_plus_edges: int
    dwell_minus_edges: int
    breaker_edges: int
    breaker_cycles: int


def derive(parameters: Mapping[str, int]) -> Derived:
    """Check a whole parameter set and derive Ka, Nr and the rest; RefusedError says why not."""
    ordered = [parameters[point.name] for point in PARAMETERS]
    values = (I32 * len(ordered))(*ordered)
    out, why = _Derived(), Refusal()
    if library().lw_native_derive(values, ctypes.byref(out), ctypes.byref(why)) != 0:
        raise refusal(why.reason, why.address, why.value, why.limit)
    return Derived(**{name: getattr(out, name) for name, _ in _Derived._fields_})


@dataclass(frozen=True)
class Replay:
    """Where the law ended, and on the way."""

    m: int
    u: int
    dwell_edges: int
    cycle_plus: int
    cycle_minus: int
    pos: int
    steps: int
    pulses: int
    min_pos: int
    max_pos: int
    edges: int


def replay(
    setup: Mapping[str, int], runs: Sequence[int], trace_points: int = 0
) -> tuple[Replay, list[int], int]:
    """Run the compiled law over runs of edges, negative for backward.

    Returns the result, the position at every n-th edge (empty without trace_points), and n.
    """
    total = sum(map(abs, runs))
    stride = max(1, -(-total // trace_points)) if trace_points else 0
    capacity = total // stride + 1 if stride else 0
    trace = (I32 * max(1, capacity))()
    result = _ReplayResult()
    status = library().lw_native_replay(
        ctypes.byref(_ReplaySetup(**setup)),
        (I32 * max(1, len(runs)))(*runs),
        len(runs),
        ctypes.byref(result),
        trace if capacity else None,
        stride,
        capacity,
    )
    if status != 0:
        raise ToolError(f"The core refused the replay: {os.strerror(-status or errno.EINVAL)}.")
    return (
        Replay(
            m=result.m,
            u=result.u,
            dwell_edges=result.dwell,
            cycle_plus=result.cycle_plus,
            cycle_minus=result.cycle_minus,
            pos=result.m >> 16,
            steps=result.steps,
            pulses=result.pulses,
            min_pos=result.min_pos,
            max_pos=result.max_pos,
            edges=result.edges,
        ),
        list(trace[: result.trace_count]),
        stride,
    )
