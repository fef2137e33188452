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


class _Figure(ctypes.Structure):
    """struct lw_plant_figure."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("min", ctypes.c_double),
        ("max", ctypes.c_double),
        ("words", ctypes.POINTER(ctypes.c_char_p)),
        ("whole", ctypes.c_bool),
    )


class _Misfit(ctypes.Structure):
    """struct lw_plant_misfit."""

    _fields_ = (
        ("figure", ctypes.c_char_p),
        ("must_be", ctypes.c_char_p),
        ("other", ctypes.c_char_p),
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
            "struct lw_plant_figure": _Figure,
            "struct lw_plant_misfit": _Misfit,
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
    loaded.lw_native_machine_default.argtypes = (ctypes.c_char_p,)
    loaded.lw_native_machine_default.restype = ctypes.c_double
    loaded.lw_native_machine_of_params.argtypes = (ctypes.POINTER(I32), ctypes.c_char_p)
    loaded.lw_native_machine_of_params.restype = ctypes.c_double
    loaded.lw_native_machine_check.argtypes = (
        ctypes.POINTER(ctypes.c_char_p),
        ctypes.POINTER(ctypes.c_double),
        ctypes.c_size_t,
        ctypes.POINTER(ctypes.c_size_t),
        ctypes.POINTER(_Misfit),
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


@dataclass(frozen=True)
class Figure:
    """A figure of the simulated machine (lw/plant_figures.h)."""

    name: str
    min: float
    max: float
    words: tuple[str, ...]
    """What 0, 1, ... are called, where it is no number."""
    whole: bool
    default: float


@cache
def machine_figures() -> Mapping[str, Figure]:
    """All figures of the simulated machine, by name."""
    figures: dict[str, Figure] = {}
    table = ctypes.cast(
        ctypes.addressof(_Figure.in_dll(library(), "lw_plant_figures")), ctypes.POINTER(_Figure)
    )
    while (entry := table[len(figures)]).name is not None:
        words: list[str] = []
        while entry.words and entry.words[len(words)] is not None:
            words.append(entry.words[len(words)].decode())
        figures[entry.name.decode()] = Figure(
            entry.name.decode(),
            entry.min,
            entry.max,
            tuple(words),
            entry.whole,
            library().lw_native_machine_default(entry.name),
        )
    return figures


def machine_of(parameters: Mapping[str, int]) -> dict[str, float]:
    """The figures of the machine that a whole parameter set describes."""
    ordered = [parameters[point.name] for point in PARAMETERS]
    values = (I32 * len(ordered))(*ordered)
    return {
        name: library().lw_native_machine_of_params(values, name.encode())
        for name in machine_figures()
    }


class MisfitError(ToolError):
    """Figures that each are right, and are no machine together: `figure` is to blame."""

    def __init__(self, figure: str, text: str) -> None:
        super().__init__(text)
        self.figure = figure


def check_machine(figures: Mapping[str, float]) -> None:
    """Check figures against each other and the default's; MisfitError says what does not fit."""
    known = machine_figures()
    names = (ctypes.c_char_p * max(1, len(figures)))(*(name.encode() for name in figures))
    values = (ctypes.c_double * max(1, len(figures)))(*figures.values())
    wrong, why = ctypes.c_size_t(), _Misfit()
    status = library().lw_native_machine_check(
        names, values, len(figures), ctypes.byref(wrong), ctypes.byref(why)
    )
    if status == -errno.EINVAL:
        blamed, other = why.figure.decode(), why.other.decode()
        value = figures.get(blamed, known[blamed].default)
        limit = f" {figures.get(other, known[other].default):g}" if other in known else ""
        raise MisfitError(
            blamed, f"{blamed}: {value:g} must be {why.must_be.decode()} {other}{limit}."
        )
    if status != 0:
        name = list(figures)[wrong.value]
        raise MisfitError(name, f"{name}: {figures[name]:g}: {os.strerror(-status)}.")
