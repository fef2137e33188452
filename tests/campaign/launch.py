# SPDX-License-Identifier: Apache-2.0
"""Playing a scenario in the compiled campaign library (launch.h), through ctypes."""

import ctypes
import functools
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from levelwind.core import layout, native

from .scenario import ActionKind, Scenario

LIBRARY = "liblw_campaign.so"
TRACE_STRIDE_MS = 5
TRACE_SIZE = 40_000
HANG_S = 60  # of real time


class Invariant(IntEnum):
    """enum lw_invariant."""

    FLANGE = 0
    OVERTRAVEL = 1
    SILENT = 2
    PERMIT = 3
    BURST = 4
    UNASKED = 5
    PATTERN = 6
    ODOMETER = 7
    RECOVERY = 8
    FALSE_ALARM = 9
    STANDING = 10
    LINE = 11


class Ending(IntEnum):
    """enum lw_ending."""

    PLAYED = 0
    CRASHED = 1
    HUNG = 2


class _Action(ctypes.Structure):
    _fields_ = (
        ("delay_ms", ctypes.c_uint32),
        ("kind", ctypes.c_int32),
        ("a", ctypes.c_int32),
        ("b", ctypes.c_int32),
        ("c", ctypes.c_int32),
        ("d", ctypes.c_int32),
    )


class _Launch(ctypes.Structure):
    _fields_ = (
        ("seed", ctypes.c_uint64),
        ("carriage_um", ctypes.c_int32),
        ("harmless", ctypes.c_int32),
        ("actions", ctypes.POINTER(_Action)),
        ("action_count", ctypes.c_size_t),
        ("requests", ctypes.c_char_p),
    )


class _Verdict(ctypes.Structure):
    _fields_ = (
        ("broken", ctypes.c_int32),
        ("broken_ms", ctypes.c_uint32),
        ("found", ctypes.c_double),
        ("limit", ctypes.c_double),
        ("duration_ms", ctypes.c_uint32),
        ("tracking_ms", ctypes.c_uint32),
        ("permit_ms", ctypes.c_uint32),
        ("state", ctypes.c_int32),
        ("fault", ctypes.c_int32),
        ("flags", ctypes.c_uint32),
        ("los_seen", ctypes.c_uint32),
        ("recoveries", ctypes.c_int32),
        ("pole_slips", ctypes.c_uint64),
        ("pin_edges", ctypes.c_int64),
        ("error_usteps", ctypes.c_double),
        ("silent_edges", ctypes.c_int64),
        ("slow_turns", ctypes.c_double),
        ("recovered_edges", ctypes.c_int64),
        ("hidden_edges", ctypes.c_int64),
    )


class _Sample(ctypes.Structure):
    _fields_ = (
        ("time_ms", ctypes.c_uint32),
        ("flags", ctypes.c_uint32),
        ("state", ctypes.c_int32),
        ("following", ctypes.c_int32),
        ("carriage_usteps", ctypes.c_float),
        ("told_usteps", ctypes.c_float),
        ("ideal_usteps", ctypes.c_float),
        ("drum_edges_per_s", ctypes.c_float),
    )


@dataclass(frozen=True, slots=True)
class Verdict:
    """struct lw_verdict."""

    broken: Invariant | None
    broken_ms: int
    found: float
    limit: float
    duration_ms: int
    tracking_ms: int
    permit_ms: int
    state: int
    fault: int
    flags: int
    los_seen: int
    recoveries: int
    pole_slips: int
    pin_edges: int
    error_usteps: float
    silent_edges: int
    slow_turns: float
    recovered_edges: int
    hidden_edges: int


class Sample(NamedTuple):
    """struct lw_trace_sample."""

    time_ms: int
    flags: int
    state: int
    following: int
    carriage_usteps: float
    told_usteps: float
    ideal_usteps: float
    drum_edges_per_s: float


@functools.cache
def _library(path: Path) -> ctypes.CDLL:
    library = ctypes.CDLL(str(path))
    layout.check(
        library,
        "lw_layout_campaign",
        {
            "struct lw_action": _Action,
            "struct lw_launch": _Launch,
            "struct lw_verdict": _Verdict,
            "struct lw_trace_sample": _Sample,
            "enum lw_action_kind": ActionKind,
            "enum lw_invariant": Invariant,
            "enum lw_ending": Ending,
        },
    )
    library.lw_campaign_part.restype = ctypes.c_char_p
    library.lw_campaign_play_apart.argtypes = (
        ctypes.POINTER(_Launch),
        ctypes.POINTER(_Verdict),
        ctypes.c_uint32,
    )
    library.lw_campaign_play.argtypes = (
        ctypes.POINTER(_Launch),
        ctypes.POINTER(_Verdict),
        ctypes.POINTER(_Sample),
        ctypes.c_int32,
        ctypes.c_uint32,
    )
    return library


def _launch(scenario: Scenario) -> _Launch:
    actions = (_Action * len(scenario.actions))(*(_Action(*a) for a in scenario.actions))
    return _Launch(
        scenario.seed,
        scenario.carriage_um,
        scenario.harmless,
        actions,
        len(actions),
        bytes(scenario.requests),
    )


def _verdict(out: _Verdict) -> Verdict:
    values = {name: getattr(out, name) for name, _ in _Verdict._fields_}
    values["broken"] = None if out.broken < 0 else Invariant(out.broken)
    return Verdict(**values)


def play(
    scenario: Scenario, traced: bool = False, library: Path | None = None
) -> tuple[Verdict, list[Sample]]:
    """Play a launch; its verdict, and a trace if wanted."""
    launch = _launch(scenario)
    out = _Verdict()
    trace = (_Sample * TRACE_SIZE)() if traced else None
    samples = _library(library or native.find(LIBRARY)).lw_campaign_play(
        ctypes.byref(launch), ctypes.byref(out), trace, TRACE_SIZE, TRACE_STRIDE_MS
    )
    if samples < 0:
        raise RuntimeError(f"launch {scenario.seed}: errno {-samples}: {scenario.story}")
    names = [name for name, _ in _Sample._fields_]
    rows = trace[:samples] if trace is not None else []
    return _verdict(out), [Sample(*(getattr(row, name) for name in names)) for row in rows]


def memory_bits(library: Path | None = None) -> int:
    """Bits of the controller's memory."""
    return _library(library or native.find(LIBRARY)).lw_campaign_bits()


def memory_part(bit: int, library: Path | None = None) -> str:
    """What a bit of the controller's memory belongs to."""
    return _library(library or native.find(LIBRARY)).lw_campaign_part(bit).decode()


def play_apart(scenario: Scenario, library: Path | None = None) -> tuple[Ending, Verdict | None]:
    """Play a launch in a process of its own: how it ended, and its verdict if it was played."""
    launch = _launch(scenario)
    out = _Verdict()
    ending = _library(library or native.find(LIBRARY)).lw_campaign_play_apart(
        ctypes.byref(launch), ctypes.byref(out), HANG_S
    )
    if ending < 0:
        raise RuntimeError(f"launch {scenario.seed}: errno {-ending}: {scenario.story}")
    return Ending(ending), _verdict(out) if ending == Ending.PLAYED else None
