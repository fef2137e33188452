# SPDX-License-Identifier: Apache-2.0
"""Step 5: the way between the switches, and the pattern that fits between the flanges."""

from collections.abc import Mapping

from levelwind.commission.bench import CALM_MM_PER_S, Bench, WrongError, wrong
from levelwind.commission.session import Finding, Result
from levelwind.core import native
from levelwind.errors import RefusedError
from levelwind.lay import wind
from levelwind.line.live import flag
from levelwind.map_table import POINTS, Flag, Reason

SLOW_MM_PER_S = 4.0
INDEX_MM_PER_S = 40.0
# How the room from a switch to the flange is used: reversal point, overshoot; the rest: trims.
REVERSAL_PART, OVERSHOOT_PART, TOLERANCE_PART = 0.35, 0.5, 0.3
TOLERANCE_UM, SPAN_TOLERANCE_UM = 1000, 2000
ALIKE_UM = 600  # how different the same way may look from both sides
TURNS = 300.0  # of rope, for ribbons
PITCH_STEPS = 40
WARNING_PART, TRIP_PART = 1.1, 1.25


def run(bench: Bench, result: Result) -> None:
    """To both switches, from both sides; then index by what was found."""
    human = bench.human
    bench.current_on()
    known = dict(bench.session.values)
    told = bench.session.told
    human.say("    Keep hands away: the carriage runs to both switches, slowly.")
    human.when_done("geometry.free", "Is the carriage free to move over its whole way?")
    bench.apply(bench.provisional(known))
    apart_um, hysteresis_um = _both_ways(bench, result)

    rooms = {
        side: human.number(
            f"geometry.room_{side}_mm",
            f"How far may the carriage go beyond the {side.upper()} switch's point, mm? (to where "
            "the rope touches the flange, and before the overtravel switch)",
            4.0,
        )
        for side in ("plus", "minus")
    }
    rope_mm = human.number("geometry.rope_mm", "Diameter of the rope, mm", 5.0)
    pitch_mm = human.number(
        "geometry.pitch_mm", "Carriage travel for one drum revolution that you want, mm",
        round(2.4 * rope_mm, 1),
    )  # fmt: skip
    told["rope_m_per_rev"] = human.number(
        "geometry.rope_m_per_rev", "Rope for one revolution of the bare drum, m", 2.4
    )
    told["rope_m_per_s"] = human.number("geometry.rope_m_per_s", "Fastest rope speed, m/s", 30.0)
    asked = {
        "apart_um": apart_um,
        "hysteresis_um": hysteresis_um,
        "plus_um": 1000 * rooms["plus"],
        "minus_um": 1000 * rooms["minus"],
        "pitch_um": round(1000 * pitch_mm),
        "rope_um": round(1000 * rope_mm),
    }
    values = pattern(bench, known, asked)
    bench.apply(values)
    values["index_rate_edges_per_s"] = bench.rate_for(INDEX_MM_PER_S)
    bench.apply({"index_rate_edges_per_s": bench.rate_for(CALM_MM_PER_S)})
    span_um = _first_index(bench)
    asked["apart_um"] += span_um  # of the minus switch: found further out, where negative
    if abs(span_um) > SPAN_TOLERANCE_UM:
        raise wrong("geometry.span", f"The switches are {span_um / 1000:+.2f} mm apart from what "
                    "the runs said.", "The carriage has slipped: repeat the step.")  # fmt: skip
    rate = values["index_rate_edges_per_s"]
    values = {**pattern(bench, known, asked), "index_rate_edges_per_s": rate}
    bench.apply(values)
    again_um = bench.index("geometry").span_um
    result.measured["between the switches, by indexing, mm"] = round(asked["apart_um"] / 1000, 3)
    result.measured["indexed again, the other switch off by, mm"] = round(again_um / 1000, 3)
    if abs(again_um) > values["span_tolerance_um"] / 2:
        result.findings.append(
            Finding(
                "geometry.speed",
                f"At {INDEX_MM_PER_S:g} mm/s the other switch is {again_um / 1000:+.2f} mm off.",
                "The next step says whether that is the switches' delay or something loose.",
                wrong=False,
            )
        )
    ribbon = wind.warning({**bench.active(), **values}, TURNS)
    result.measured["lay"] = "a ribbon" if ribbon else "no ribbon"
    if ribbon:
        result.findings.append(
            Finding(
                "geometry.ribbon",
                ribbon,
                "No pitch nearby is free of it on a drum so narrow for its rope.",
                wrong=False,
            )
        )
    if values["pitch_um"] != round(1000 * pitch_mm):
        result.findings.append(
            Finding(
                "geometry.pitch",
                f"A pitch of {pitch_mm:g} mm makes a ribbon; {values['pitch_um'] / 1000:g} mm "
                "does not.",
                "`levelwind lay` draws both.",
                wrong=False,
            )
        )
    result.proposed.update(values)


def _both_ways(bench: Bench, result: Result) -> tuple[float, float]:
    """The way between the switches, and how far inside of its point one releases; um."""
    rate = bench.rate_for(CALM_MM_PER_S)
    with bench.for_now({"jog_rate_edges_per_s": rate}):
        _to_switch(bench, -1)
        out_um = abs(_to_switch(bench, 1))
        back_um = abs(_to_switch(bench, -1))
        _to_switch(bench, 1)
        hysteresis_um = _hysteresis(bench)
    stop_um = bench.device.value("overshoot_actual_um")
    apart_um = out_um - 2 * stop_um
    result.measured["between the switches, first look, mm"] = round(apart_um / 1000, 2)
    result.measured["run to plus and back, mm"] = f"{out_um / 1000:.2f} and {back_um / 1000:.2f}"
    if abs(out_um - back_um) > ALIKE_UM:
        raise wrong(
            "geometry.runs",
            f"The run to plus was {out_um / 1000:.2f} mm, the one back {back_um / 1000:.2f} mm.",
            "The carriage has slipped, or a switch is loose: look at the coupling, the switches "
            "and what presses them.",
        )
    result.measured["a switch releases inside its point by, mm"] = round(hysteresis_um / 1000, 2)
    return apart_um, hysteresis_um


def _to_switch(bench: Bench, direction: int) -> int:
    """Jog until that side's switch ends it; the way by its steps, um.

    Not by the position: a slow line lets a jog end, and the next one counts from 0 again.
    """
    side, other = ("plus", "minus") if direction > 0 else ("minus", "plus")
    mine, theirs = Flag[f"SWITCH_{side.upper()}"], Flag[f"SWITCH_{other.upper()}"]
    beyond = Flag[f"OVERTRAVEL_{side.upper()}"]
    left = not bench.flags(theirs)[0]
    stopped_by = ""

    def end(live: dict[str, int]) -> bool:
        nonlocal left, stopped_by
        left = left or not flag(live, theirs)
        if flag(live, beyond):
            stopped_by = "overtravel"
        elif left and flag(live, theirs):
            stopped_by = "other"
        return bool(stopped_by) or flag(live, mine)

    travel_mm = bench.active()["travel_um"] / 1000
    before = bench.device.value("steps")
    try:
        live = bench.jog(direction, 1.2 * travel_mm / CALM_MM_PER_S, end)
    except RefusedError as refused:
        if refused.reason == Reason.LIMIT_SWITCH:
            return 0  # it stands there
        raise
    if stopped_by == "other":
        raise wrong(
            "geometry.other_switch",
            f"On the way to {side} the {other} switch was actuated.",
            "The stepper runs the other way, or the switches are swapped: do the steps 2 and 4 "
            "again.",
        )
    if stopped_by == "overtravel":
        raise wrong(
            "geometry.overtravel",
            f"The {side} overtravel switch came before the limit switch.",
            "Move the overtravel switch outward, or the limit switch inward.",
        )
    if not flag(live, mine):
        raise wrong(
            "geometry.no_switch",
            f"No {side} switch within {travel_mm:.0f} mm.",
            "Is the carriage free, does the stepper turn the screw, does the coupling hold?",
        )
    return round(bench.steps_since(before) * bench.um_per_ustep())


def _hysteresis(bench: Bench) -> float:
    """From rest past the plus switch, slowly inward until it releases; um inside its point."""
    stop_um = bench.device.value("overshoot_actual_um")
    released_um: list[int] = []

    def end(live: dict[str, int]) -> bool:
        if not flag(live, Flag.SWITCH_PLUS):
            released_um.append(abs(live["position_um"]))
            return True
        return False

    with bench.for_now({"jog_rate_edges_per_s": bench.rate_for(SLOW_MM_PER_S)}):
        bench.jog(-1, 30_000 / 1000 / SLOW_MM_PER_S, end)
    if not released_um:
        raise wrong(
            "geometry.no_release",
            "The plus switch does not release 30 mm inside of its point.",
            "It is stuck, or the stepper does not move the carriage.",
        )
    return max(0.0, released_um[0] - stop_um)


def _first_index(bench: Bench) -> int:
    """Index where the switches are known to a millimetre or so; how far the other one is off."""
    try:
        return -bench.index("geometry").span_um
    except WrongError as error:
        if error.finding.code != "geometry.index_span":
            raise
        span_um = -bench.device.value("span_error_um")
    bench.human.say("    The first look was too rough: once more.")
    return span_um


def pattern(bench: Bench, known: Mapping[str, int], asked: Mapping[str, float]) -> dict[str, int]:
    """The parameters of the pattern, such that the core takes them; WrongError says why not."""
    half_um = asked["apart_um"] / 2
    room_um = {"plus": asked["plus_um"], "minus": asked["minus_um"]}
    least_um = min(room_um.values())
    edges_per_rev = wind.edges_per_drum_rev({**bench.active(), **known})
    fastest = bench.session.told["rope_m_per_s"] / bench.session.told["rope_m_per_rev"]
    values = {
        **known,
        "overshoot_um": round(OVERSHOOT_PART * least_um),
        "slope_tolerance_ppm": 500,
        "switch_tolerance_um": max(10, min(TOLERANCE_UM, round(TOLERANCE_PART * least_um))),
        "span_tolerance_um": SPAN_TOLERANCE_UM,
        "switch_hysteresis_um": max(500, round(1.5 * asked["hysteresis_um"] + 300)),
        "park_at": 0,
        "park_position_um": 0,
        "centre_position_um": 0,
        "rope_diameter_um": round(asked["rope_um"]),
        "rope_per_drum_rev_um": round(1e6 * bench.session.told["rope_m_per_rev"]),
        "travel_um": round(1.1 * (asked["apart_um"] + room_um["plus"] + room_um["minus"])),
    }
    for side, sign in (("plus", 1), ("minus", -1)):
        values[f"switch_{side}_um"] = round(sign * half_um)
        values[f"reversal_{side}_um"] = round(sign * (half_um + REVERSAL_PART * room_um[side]))
        values[f"flange_{side}_um"] = round(sign * (half_um + room_um[side]))
    refused: RefusedError | None = None
    for edges in (2, 4):
        fastest_edges = fastest * edges_per_rev * edges / known.get("encoder_edges_per_pulse", 2)
        values["encoder_edges_per_pulse"] = edges
        values["overspeed_warning_edges_per_s"] = _limited(
            "overspeed_warning_edges_per_s", WARNING_PART * fastest_edges
        )
        values["overspeed_trip_edges_per_s"] = _limited(
            "overspeed_trip_edges_per_s", TRIP_PART * fastest_edges
        )
        values["pitch_um"] = round(asked["pitch_um"])
        try:
            return {**values, "pitch_um": _without_ribbon({**bench.active(), **values})}
        except RefusedError as error:
            refused = error
            if error.reason != Reason.SLOPE_ABOVE_ONE_STEP:
                break
    assert refused is not None
    raise wrong(
        "geometry.set",
        f"The pattern does not fit this machine: {refused}",
        "`levelwind plan` tries numbers without the winch. Finer microsteps and a coarse encoder "
        "ask for a smaller pitch; little room beyond a switch for a switch further inside.",
    )


def _limited(name: str, value: float) -> int:
    point = POINTS[name]
    assert point.min is not None
    assert point.max is not None
    return min(max(round(value), point.min), point.max)


def _without_ribbon(values: Mapping[str, int]) -> int:
    """The nearest pitch that lays no ribbon; the one asked for where none nearby does not."""
    asked_um = values["pitch_um"]
    native.derive(values)
    for step in range(PITCH_STEPS + 1):
        for sign in (1, -1):
            pitch_um = round(asked_um * (1 + sign * step / 200))
            try:
                if wind.warning({**values, "pitch_um": pitch_um}, TURNS) is None:
                    return pitch_um
            except RefusedError:
                continue
    return asked_um
