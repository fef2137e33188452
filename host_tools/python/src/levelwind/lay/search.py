# SPDX-License-Identifier: Apache-2.0
"""Better settings: pitch and dwell in a band, and ribbon breakers, each laid and judged."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from math import sqrt

from levelwind.core.ideal_screw import USTEP
from levelwind.errors import RefusedError
from levelwind.lay import field
from levelwind.lay.wind import Wind, edges_per_drum_rev, wind

BEST = 3
"""So many settings without a breaker are recommended."""
BREAKER_CYCLES = (3, 4, 6, 8, 12, 16)
BREAKER_PARTS = (1 / 4, 1 / 3, 1 / 2, 2 / 3, 5 / 6, 1)
"""Of the longest dwell in the band."""
BREAKER_OFF = {"breaker_millirev": 0, "breaker_cycles": 0}
UM_PER_STEP = 10
"""Pitches that are tried are whole multiples of this."""

Changes = dict[str, int]


@dataclass(frozen=True)
class Band:
    """What may be changed, and how many settings are tried."""

    pitch_um: tuple[int, int]
    dwell_millirev: tuple[int, int]
    patterns: int


@dataclass(frozen=True)
class Recommendation:
    """A setting, what it makes of the rope, and how to set it."""

    changes: Changes
    wind: Wind
    ribbons: list[int]
    evenness: field.Evenness
    near_std_mm: float
    """Worst standard deviation of the settings beside it: what a small trim may make of it."""

    @property
    def command(self) -> str:
        """For the shell."""
        return "levelwind set " + " ".join(f"{n}={v}" for n, v in self.changes.items())


def with_pitch(parameters: Mapping[str, int], pitch_um: int) -> Changes:
    """What sets a pitch. In expert mode Nr does, with Ka as it is."""
    if not parameters["expert_mode"]:
        return {"pitch_um": pitch_um}
    um_per_ustep = parameters["screw_lead_um"] / parameters["microsteps_per_rev"]
    ks = pitch_um / um_per_ustep / float(edges_per_drum_rev(parameters)) * USTEP
    return {"raw_nr": max(1, round(ks / parameters["raw_ka"]))}


def grid(parameters: Mapping[str, int], band: Band) -> list[list[Changes]]:
    """Settings without a breaker: a row for each pitch, with its dwells in order."""
    low, high = band.pitch_um
    dwell_low, dwell_high = band.dwell_millirev
    columns = min(max(1, round(sqrt(band.patterns))), dwell_high - dwell_low + 1)
    rows = max(1, band.patterns // columns)
    pitches: list[Changes] = []
    for pitch_um in _spread(low, high, rows, UM_PER_STEP):
        changes = with_pitch(parameters, pitch_um)
        if changes not in pitches:
            pitches.append(changes)
    dwells = [
        {"dwell_plus_millirev": dwell, "dwell_minus_millirev": dwell}
        for dwell in _spread(dwell_low, dwell_high, columns, 1)
    ]
    return [[pitch | dwell | BREAKER_OFF for dwell in dwells] for pitch in pitches]


def breakers(band: Band) -> list[list[Changes]]:
    """Ribbon breakers: a row for each number of cycles, with its amplitudes in order."""
    amplitudes = sorted({round(band.dwell_millirev[1] * part) for part in BREAKER_PARTS} - {0})
    return [
        [{"breaker_millirev": amplitude, "breaker_cycles": cycles} for amplitude in amplitudes]
        for cycles in BREAKER_CYCLES
    ]


def _spread(low: int, high: int, count: int, step: int) -> list[int]:
    """So many values from low to high, both among them, whole multiples of step between."""
    if count < 2 or high == low:
        return [low]
    values = [low + (high - low) * i / (count - 1) for i in range(count)]
    inner = [round(value / step) * step for value in values[1:-1]]
    return sorted({low, high, *(v for v in inner if low < v < high)})


def judge_all(
    parameters: Mapping[str, int],
    candidates: Sequence[Changes],
    rope_um: int,
    turns: float,
    progress: Callable[[int], None] = lambda _: None,
) -> list[field.Evenness | None]:
    """Lay every one, on all processors; None where the core refuses the set."""

    def judge(changes: Changes) -> field.Evenness | None:
        try:
            return field.evenness({**parameters, **changes}, rope_um, turns)
        except RefusedError:
            return None

    found = []
    executor = ThreadPoolExecutor(len(os.sched_getaffinity(0)))
    try:
        for evenness in executor.map(judge, candidates):
            found.append(evenness)
            progress(len(found))
    finally:
        executor.shutdown(cancel_futures=True)
    return found


def recommend(
    parameters: Mapping[str, int],
    band: Band,
    rope_um: int,
    turns: float,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[Recommendation]:
    """The best few, the most even first, and the best breaker for the pitch that is."""
    settings, broken = grid(parameters, band), breakers(band)
    candidates = [changes for row in [*settings, *broken] for changes in row]
    found = judge_all(
        parameters, candidates, rope_um, turns, lambda done: progress(done, len(candidates))
    )
    count = sum(map(len, settings))
    width = len(settings[0])
    chosen: list[tuple[float, int]] = []
    for near_mm, i in _by_evenness(found[:count], width):
        if len(chosen) < BEST and not any(_beside(i, j, width, len(settings)) for _, j in chosen):
            chosen.append((near_mm, i))
    if broken[0]:
        best = _by_evenness(found[count:], len(broken[0]))[:1]
        chosen += [(near_mm, count + i) for near_mm, i in best]
    return [
        _recommendation(parameters, candidates[i], evenness, near_mm, rope_um, turns)
        for near_mm, i in chosen
        if (evenness := found[i]) is not None
    ]


def _by_evenness(found: Sequence[field.Evenness | None], width: int) -> list[tuple[float, int]]:
    """The settings that the core takes, the most even first, with the worst beside each."""
    return sorted(
        (_near(found, i, width), i) for i, evenness in enumerate(found) if evenness is not None
    )


def _near(found: Sequence[field.Evenness | None], i: int, width: int) -> float:
    """The worst of a setting and of those with a little more and less dwell, or breaker.

    That shifts the wind ratio as a trim of the reversal points by hand does.
    """
    beside = [found[j] for j in (i - 1, i, i + 1) if j // width == i // width and j < len(found)]
    return max(evenness.std_mm for evenness in beside if evenness is not None)


def _beside(i: int, j: int, width: int, rows: int) -> bool:
    """Two settings of nearly the same pitch are no choice."""
    return abs(i // width - j // width) < max(2, rows // 8)


def _recommendation(
    parameters: Mapping[str, int],
    candidate: Changes,
    evenness: field.Evenness,
    near_mm: float,
    rope_um: int,
    turns: float,
) -> Recommendation:
    changes = {n: v for n, v in candidate.items() if parameters[n] != v}
    found = wind({**parameters, **candidate})
    return Recommendation(changes, found, found.ribbons(rope_um, turns), evenness, near_mm)


def over_pitch(
    parameters: Mapping[str, int],
    pitches_um: Iterable[int],
    rope_um: int,
    turns: float,
    progress: Callable[[int], None] = lambda _: None,
) -> list[tuple[Wind, field.Evenness]]:
    """Evenness by pitch, with all else as it is; pitches that the core refuses are left out."""
    candidates: list[Changes] = []
    for pitch_um in pitches_um:
        changes = with_pitch(parameters, pitch_um)
        if changes not in candidates:
            candidates.append(changes)
    found = judge_all(parameters, candidates, rope_um, turns, progress)
    return [
        (wind({**parameters, **changes}), evenness)
        for changes, evenness in zip(candidates, found, strict=True)
        if evenness is not None
    ]
