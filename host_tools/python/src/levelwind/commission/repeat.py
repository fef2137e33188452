# SPDX-License-Identifier: Apache-2.0
"""Step 6: how well a switch is found again, and how late it tells.

An indexing counts step pulses from where the carriage stands: one that needs more than the last
one from the same place has found the indexing switch further out. The other switch is told by
the span error. So what is loose shows apart: one switch alone, or both together (a coupling).
"""

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from levelwind.commission.bench import USTEP, Bench, Index, wrong
from levelwind.commission.session import Result
from levelwind.errors import RefusedError
from levelwind.line import switch_delay
from levelwind.map_table import POINTS, Side

COUNT = 10
RATES = (0.5, 1.0, 2.0)
LOOSE_UM = 100.0  # standard deviation of a good switch is a tenth of that
DRIFT_UM = 150.0  # over all indexings
ROUNDING_USTEPS = 3.5  # of an indexing, by which its steps are not known
TOLERANCE_SIGMAS, TOLERANCE_MIN_UM = 8.0, 300
DELAY_MIN_US = 100
STRAIGHT_UM = 150.0


@dataclass(frozen=True)
class Places:
    """Where both switches were, um, each indexing against the first."""

    index: list[float]
    other: list[float]


def places(taken: Sequence[Index], usual: int, um_per_ustep: float) -> Places:
    """From indexings that each began where the one before has parked.

    One that took more steps than `usual` has found the indexing switch so much further out than
    the one before; everything is counted from there. `usual` is known to a few microsteps only, as
    the law turns on whole edges: within these the span error says whether it was this switch that
    has moved, or the other one.
    """
    span_um = statistics.linear_regression(range(len(taken)), [t.span_um for t in taken]).slope
    mean = statistics.fmean(one.steps for one in taken)
    each = mean - usual
    nearest = min((0.0, -span_um / um_per_ustep), key=lambda told: abs(told - each))
    if abs(nearest - each) < ROUNDING_USTEPS:
        each = nearest
    index: list[float] = []
    at = 0.0
    for one in taken:
        at += (one.steps - mean + each) * um_per_ustep
        index.append(at)
    other = [at + one.span_um for at, one in zip(index, taken, strict=True)]
    return Places([at - index[0] for at in index], [at - other[0] for at in other])


def usual_steps(bench: Bench) -> int:
    """Of an indexing from the parking place back to it: a double traverse of the law."""
    law = bench.device.read_names("ks", "nr", "reversal_plus_usteps", "reversal_minus_usteps")
    overshoot = law["ks"] * (law["nr"] - 1) / 2 / USTEP
    traverse = law["reversal_plus_usteps"] - law["reversal_minus_usteps"] + 2 * overshoot
    return round(2 * traverse) - 2  # a reversal begins on the edge behind its point


def drift(at: Sequence[float]) -> float:
    """How far the straight line through the places goes from the first to the last."""
    slope = statistics.linear_regression(range(len(at)), at).slope
    return slope * (len(at) - 1)


def scatter(at: Sequence[float]) -> float:
    """Standard deviation about that line."""
    line = statistics.linear_regression(range(len(at)), at)
    return statistics.pstdev(y - line.slope * x - line.intercept for x, y in enumerate(at))


def run(bench: Bench, result: Result) -> None:
    """Index again and again; then at several rates."""
    count = round(
        bench.human.number("repeat.count", "How many indexings (10 are usual, 3 at least)?", COUNT)
    )
    if count < 3:
        raise wrong("repeat.count", f"{count} indexings tell nothing.", "Take 3 at least.")
    bench.current_on()
    active = bench.active()
    plus_first = active["index_switch"] == Side.PLUS
    names = ("plus", "minus") if plus_first else ("minus", "plus")
    parked = {"park_at": 1, "park_position_um": 0}
    um_per_ustep = bench.um_per_ustep()
    with bench.for_now(parked):
        bench.index("repeat")
        taken = []
        for number in range(count):
            bench.human.say(f"    Indexing {number + 1} of {count}.")
            bench.rest()
            taken.append(bench.index("repeat"))
    sign = 1 if plus_first else -1
    found = places(taken, usual_steps(bench), um_per_ustep)
    sides = {names[0]: [sign * at for at in found.index], names[1]: found.other}
    if not plus_first:
        sides[names[1]] = [at - 2 * i for at, i in zip(found.other, found.index, strict=True)]
    for side in ("plus", "minus"):
        at = sides[side]
        result.series[f"{side}_um"] = [round(x, 1) for x in at]
        result.measured[f"{side} switch, {count} indexings, um"] = (
            f"standard deviation {scatter(at):.0f}, range {max(at) - min(at):.0f}, "
            f"drift {drift(at):+.0f}"
        )
    judge(sides)
    worst_um = max(scatter(at) for at in sides.values())
    values = _delays(bench, result)
    room_um = min(
        active[f"flange_{s}_um"] * g - active[f"switch_{s}_um"] * g
        for s, g in (("plus", 1), ("minus", -1))
    )
    tolerance = round(TOLERANCE_MIN_UM + TOLERANCE_SIGMAS * worst_um)
    values["switch_tolerance_um"] = max(10, min(tolerance, round(0.3 * room_um)))
    values["span_tolerance_um"] = tolerance
    try:
        bench.apply(values)
    except RefusedError as refused:
        raise wrong(
            "repeat.delay",
            f"The switches tell {values['switch_delay_us']} us late, more than fits: {refused}",
            "A slow input filter or relay before the controller, or a coupling that slips at the "
            "higher rates. More room between a switch and its reversal point allows more.",
        ) from None
    last = bench.index("repeat")
    result.measured["with these values the other switch is off by, um"] = last.span_um
    result.proposed.update(values)


def judge(sides: dict[str, list[float]]) -> None:
    """What is loose, if anything is."""
    wide = {side: scatter(at) > LOOSE_UM for side, at in sides.items()}
    gone = {side: drift(at) for side, at in sides.items()}
    moved = {side: abs(um) > DRIFT_UM and abs(um) > 3 * scatter(sides[side])
             for side, um in gone.items()}  # fmt: skip
    together = all(moved.values()) and gone["plus"] * gone["minus"] > 0
    if together or all(wide.values()):
        how = f"drift by {gone['plus']:+.0f} um" if together else "scatter"
        raise wrong(
            "repeat.coupling",
            f"Both switches {how} together: it is the carriage that is counted wrong.",
            "A coupling slips, the screw's nut is loose, or the motor loses steps: tighten the "
            "coupling; less index rate, or more current, where it goes on.",
        )
    for side, at in sides.items():
        if wide[side]:
            raise wrong(
                f"repeat.{side}_loose",
                f"The {side} switch is found {scatter(at):.0f} um to and fro (standard "
                f"deviation), the other one is not.",
                f"The {side} switch, or what presses it, is loose: fasten it, repeat the step.",
            )
        if moved[side]:
            raise wrong(
                f"repeat.{side}_drift",
                f"The {side} switch wanders: {gone[side]:+.0f} um over {len(at)} indexings.",
                f"Its holder gives way, or it wears: fasten the {side} switch, repeat the step.",
            )


def _delays(bench: Bench, result: Result) -> dict[str, int]:
    """How late the switches tell, by the speed; and where they are at no speed."""
    active = bench.active()
    calm = active["index_rate_edges_per_s"]
    limit = POINTS["index_rate_edges_per_s"].max or calm
    rates = sorted({min(limit, max(100, round(calm * part))) for part in RATES})
    bench.human.say(f"    Indexing at {', '.join(map(str, rates))} edges/s.")
    try:
        samples, in_force_us = switch_delay.measure(bench.device, rates)
    except RefusedError as refused:
        raise bench.fault("repeat", refused) from None
    fitted = switch_delay.fit(samples)
    if fitted.residual_um > STRAIGHT_UM:
        raise wrong(
            "repeat.speed",
            "What the switches tell does not grow straight with the speed: "
            f"{fitted.residual_um:.0f} um off at worst.",
            "At the higher rates a coupling slips, or the motor loses steps: tighten the coupling, "
            "more current.",
        )
    delay_us = switch_delay.proposal_us(in_force_us, fitted)
    delay_us = delay_us if delay_us >= DELAY_MIN_US else 0
    result.series["speed_mm_per_s"] = [round(s.speed_um_per_s / 1000, 2) for s in samples]
    result.series["apart_um"] = [float(s.apart_um) for s in samples]
    result.measured["the switches tell late by, us"] = delay_us
    result.measured["worst distance from that line, um"] = round(fitted.residual_um)
    apart_um = fitted.apart_um
    return {
        "switch_delay_us": delay_us,
        "switch_plus_um": round(active["switch_plus_um"] + apart_um / 2),
        "switch_minus_um": round(active["switch_minus_um"] - apart_um / 2),
    }
