# SPDX-License-Identifier: Apache-2.0
"""Step 4: stepper and screw, by small jogs to a mark."""

from levelwind.commission.bench import CALM_MM_PER_S, Bench, wrong
from levelwind.commission.session import Finding, Result
from levelwind.errors import RefusedError
from levelwind.map_table import POINTS

USUAL_MICROSTEPS = (
    *(200, 400, 500, 800, 1000, 1600, 2000, 2400, 2500, 3200, 4000, 5000, 6400, 8000, 10000),
    *(12800, 16000, 20000, 25000, 25600, 32000, 40000, 50000, 51200),
)
RATES = (400, 2000, 10_000, 50_000)
"""Edges per second, from nearly nothing on: how far a step goes is not known yet."""
JOG_S = 1.0
SEEN_MM = 1.0
TAKE_UP_S = 0.2
FAR_MM = 25.0
"""A way that a ruler reads to a percent."""
RULER_PART = 0.03
POWER = "Power of the driver, its enable input, the motor's cable, step and direction wires."


def run(bench: Bench, result: Result) -> None:
    """Slowly, until it is seen to move; then far enough for a ruler."""
    human = bench.human
    bench.current_on()
    known = dict(bench.session.values)
    lead_mm = human.number(
        "stepper.lead_mm", "Carriage travel for one motor revolution (the screw's lead), mm", 20.0
    )
    told = round(
        human.number(
            "stepper.microsteps",
            "Microsteps per motor revolution set at the driver; 0: let it be measured",
            0,
        )
    )
    values = {
        "screw_lead_um": round(lead_mm * 1000),
        "microsteps_per_rev": told or 2000,
        "carriage_direction_invert": 0,
    }
    bench.apply(bench.provisional({**known, **values}))
    steps, way_mm = _until_seen(bench)
    if way_mm < 0:
        values["carriage_direction_invert"] = 1
        result.findings.append(
            Finding(
                "stepper.reversed",
                "The carriage went to minus for plus: direction or a winding is reversed.",
                "Taken right by carriage_direction_invert; the wires may stay as they are.",
                wrong=False,
            )
        )
    per_mm = steps / abs(way_mm)
    values["microsteps_per_rev"] = _within(per_mm * lead_mm)
    bench.apply(bench.provisional({**known, **values}))
    rate = bench.rate_for(CALM_MM_PER_S)
    seconds = FAR_MM / bench.speed_mm_per_s(rate)
    with bench.for_now({"jog_rate_edges_per_s": rate}):
        bench.human.say("    A short jog toward minus first: it takes up the play of the screw.")
        bench.jog(-1, TAKE_UP_S)
        steps, way_mm = _measured(bench, -1, seconds, "back, toward minus")
    if way_mm >= 0:
        raise wrong(
            "stepper.direction",
            f"It went {way_mm:+.1f} mm for a jog toward minus.",
            "The motor turns one way only: the direction wire is broken or not connected.",
        )
    per_mm = steps / abs(way_mm)
    measured = per_mm * lead_mm
    result.measured["step pulses per mm"] = round(per_mm, 2)
    result.measured["microsteps per revolution, by the lead"] = round(measured)
    if told and abs(measured / told - 1) > RULER_PART:
        raise wrong(
            "stepper.microsteps",
            f"Measured are {measured:.0f} microsteps per revolution of {lead_mm:g} mm, not {told}.",
            "The driver is set to another number, the lead is another one, or the motor slips "
            "(a short way): look at the driver's switches and the screw.",
        )
    nearest = min(USUAL_MICROSTEPS, key=lambda usual: abs(usual / measured - 1))
    if told:
        nearest = told
    elif abs(nearest / measured - 1) > RULER_PART:
        raise wrong(
            "stepper.unusual",
            f"{measured:.0f} microsteps per revolution of {lead_mm:g} mm: no driver is set so.",
            "The lead is another one, or the motor slips: measure the screw, then repeat with "
            "the driver's number told.",
        )
    values["microsteps_per_rev"] = nearest
    bench.apply(bench.provisional({**known, **values}))
    result.proposed.update(values)


def _within(microsteps: float) -> int:
    point = POINTS["microsteps_per_rev"]
    assert point.min is not None
    assert point.max is not None
    return min(max(round(microsteps), point.min), point.max)


def _until_seen(bench: Bench) -> tuple[int, float]:
    """Jog toward plus, faster each time, until somebody has seen it move."""
    for rate in RATES:
        with bench.for_now({"jog_rate_edges_per_s": rate}):
            steps, way_mm = _measured(bench, 1, JOG_S, "toward plus")
        if abs(way_mm) >= SEEN_MM:
            return steps, way_mm
        bench.human.say("    Too little to be measured: faster.")
    raise wrong(
        "stepper.still",
        f"{steps} step pulses were given, and the carriage has not moved.",
        f"The motor has no current, or does not get the steps: {POWER}",
    )


def _measured(bench: Bench, direction: int, seconds: float, way: str) -> tuple[int, float]:
    """A jog: step pulses given, millimetres that a ruler shows, plus positive."""
    bench.human.when_done(
        "stepper.mark", f"Mark the carriage's place. It will jog {way} for {seconds:.0f} s."
    )
    before = bench.device.value("steps")
    try:
        bench.jog(direction, seconds)
    except RefusedError as refused:
        raise wrong(
            "stepper.refused",
            f"The controller lets nothing move {way}: {refused}",
            "Is it at that switch? Push it to the middle by hand, in `levelwind mode off`.",
        ) from None
    steps = bench.steps_since(before)
    if not steps:
        raise wrong("stepper.no_steps", "No step pulse was given.", "`levelwind status` says why.")
    way_mm = bench.human.number(
        "stepper.way", "How far did it go, mm? Toward plus positive, minus negative, 0: not seen", 0
    )
    return steps, way_mm
