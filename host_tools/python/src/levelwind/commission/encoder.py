# SPDX-License-Identifier: Apache-2.0
"""Step 3: the encoder, by turns of the drum by hand."""

from collections.abc import Iterable
from fractions import Fraction

from levelwind.commission.bench import Bench, wrong
from levelwind.commission.session import Finding, Result
from levelwind.line.points import enum_text
from levelwind.map_table import POINTS, EncoderFault

USUAL_PULSES = (
    *(50, 100, 128, 180, 200, 250, 256, 300, 360, 400, 500, 512, 600, 720, 800, 900, 1000),
    *(1024, 1200, 1250, 1440, 1500, 1800, 2000, 2048, 2500, 3000, 3600, 4000, 4096, 5000),
)
HAND_PART = 0.015  # how exactly a turn is made by hand
RATIO_PART = 0.0075
TRANSITIONS = 4  # of a pulse
DEAD_TRANSITIONS = 16
NOTHING_TRANSITIONS = 2
RATIO_TERMS = 60
COUNTERS = ("net_edges", "illegal_transitions", "encoder_index_pulses", "encoder_doubts",
            "encoder_fault_count", "missed_edges")  # fmt: skip
CHANNEL_FAULTS = (
    *(EncoderFault.A_STILL, EncoderFault.B_STILL),
    *(EncoderFault.A_FLICKERS, EncoderFault.B_FLICKERS),
)
CABLE = "Look at the encoder's cable, its screen and plug, and at its supply."
# What shows a dead or loose channel also to a hand that turns slowly.
SLOW = {
    "encoder_edges_per_pulse": 4,
    "encoder_watch_transitions_per_s": 100,
    "encoder_watch_ms": 50,
}


def run(bench: Bench, result: Result) -> None:
    """One turn each way counts; a second pair checks what came of it."""
    human = bench.human
    bench.current_off()
    known = {name: value for name, value in bench.session.values.items() if name in POINTS}
    with bench.for_now(bench.provisional({**known, **SLOW})):
        forward = _turn(bench, "encoder.forward", "the way that HAULS ROPE IN")
        back = _turn(bench, "encoder.back", "back to the mark, the other way")
    _check(forward, back)
    counted = abs(forward["net_edges"])
    result.measured["transitions of a drum turn, in and out"] = (
        f"{forward['net_edges']} and {back['net_edges']}"
    )
    result.measured["index pulses of a drum turn"] = forward["encoder_index_pulses"]
    pulses = round(
        human.number(
            "encoder.pulses", "Pulses per revolution on the encoder's nameplate; 0: not known", 0
        )
    )
    told = human.number(
        "encoder.ratio", "Encoder revolutions for one of the drum; 0: let it be measured", 0
    )
    index = forward["encoder_index_pulses"]
    if not pulses:
        pulses = _pulses(counted, told or index)
        result.findings.append(
            Finding(
                "encoder.pulses_by_count",
                f"The nameplate is not known: taken for {pulses} pulses per revolution.",
                "Only pulses times ratio counts for the lay; the index check needs both.",
                wrong=False,
            )
        )
    measured = counted / TRANSITIONS / pulses
    result.measured["encoder revolutions per drum revolution"] = round(measured, 4)
    if told and abs(measured / told - 1) > 2 * HAND_PART:
        raise wrong(
            "encoder.ratio",
            f"By {pulses} pulses the encoder makes {measured:.3f} revolutions for one of the drum, "
            f"not {told:g}.",
            "The nameplate or the ratio is another one, or the turn was not a whole one.",
        )
    if index and abs(index - measured) > 1 + HAND_PART * measured:
        raise wrong(
            "encoder.pulses",
            f"The index came {index} times in a drum turn; by {pulses} pulses per revolution it "
            f"should have come {measured:.1f} times.",
            "The encoder has another number of pulses than that: read its nameplate again.",
        )
    ratio = Fraction(told).limit_denominator(1000) if told else _ratio(measured)
    values = {
        "encoder_pulses_per_rev": pulses,
        "encoder_ratio_numerator": ratio.numerator,
        "encoder_ratio_denominator": ratio.denominator,
    }
    if forward["net_edges"] < 0:
        values["drum_direction_invert"] = 1 - bench.active()["drum_direction_invert"]
        result.findings.append(
            Finding(
                "encoder.backward",
                "The drum counts backward: A and B are exchanged, or one of them is inverted.",
                "Taken right by drum_direction_invert; the wires may stay as they are.",
                wrong=False,
            )
        )
    else:
        values["drum_direction_invert"] = bench.active()["drum_direction_invert"]
    if not index:
        result.findings.append(
            Finding(
                "encoder.no_index",
                "No index pulse was seen.",
                "Wire Z, if the encoder has it: it finds edges that get lost.",
                wrong=False,
            )
        )
    bench.apply(bench.provisional({**known, **values}))
    _confirm(bench, result)
    result.proposed.update(values)


def _turn(bench: Bench, name: str, way: str) -> dict[str, int]:
    """By how much the counters have grown in one turn."""
    before = bench.device.read_names(*COUNTERS)
    bench.human.when_done(
        name, f"Mark the drum. Turn it by hand exactly ONE revolution, {way}; let it rest."
    )
    after = bench.device.read_names(*COUNTERS)
    grown = {counter: after[counter] - before[counter] for counter in COUNTERS}
    kind = bench.device.value("encoder_fault_kind") if grown["encoder_fault_count"] else 0
    return {**grown, "channel": kind if kind in CHANNEL_FAULTS else 0}


def _either(turns: Iterable[dict[str, int]], counter: str) -> int:
    return sum(turn[counter] for turn in turns)


def _check(forward: dict[str, int], back: dict[str, int]) -> None:
    """Is what came the picture of a turn?"""
    turns = (forward, back)
    counted = abs(forward["net_edges"])
    if _either(turns, "encoder_doubts") or turns[-1]["channel"]:
        kind = turns[-1]["channel"]
        what = enum_text(EncoderFault, kind) if kind else "One channel changes without the other"
        raise wrong("encoder.channel", f"{what}.", CABLE)
    if counted < DEAD_TRANSITIONS:
        if counted <= NOTHING_TRANSITIONS:
            raise wrong(
                "encoder.channel",
                f"A turn of the drum gave {counted} transitions: at least one channel is dead.",
                f"{CABLE} Does the encoder's shaft turn with the drum?",
            )
        raise wrong("encoder.few", f"A turn of the drum gave {counted} transitions only.",
                    "Does the encoder's coupling slip?")  # fmt: skip
    if illegal := _either(turns, "illegal_transitions"):
        raise wrong(
            "encoder.illegal",
            f"Both channels changed at once {illegal} times: edges are lost.",
            CABLE,
        )
    if abs(_either(turns, "net_edges")) > max(DEAD_TRANSITIONS, 2 * HAND_PART * counted):
        raise wrong(
            "encoder.lost",
            f"A turn in counted {forward['net_edges']} transitions, the turn back "
            f"{back['net_edges']}.",
            f"Back at the mark both must be alike: edges are lost, or the coupling slips. {CABLE}",
        )


def _pulses(counted: int, revolutions: float) -> int:
    """A usual number of pulses, by the encoder's revolutions in a drum turn, if these are known."""
    about = counted / TRANSITIONS / (revolutions or 1)
    nearest = min(USUAL_PULSES, key=lambda usual: abs(usual / about - 1))
    near = abs(nearest / about - 1) < (0.5 if revolutions else HAND_PART)
    return nearest if near else min(max(1, round(about)), 10_000)


def _ratio(measured: float) -> Fraction:
    """The simplest fraction that a hand's turn cannot tell from the measured ratio."""
    for denominator in range(1, RATIO_TERMS):
        numerator = round(measured * denominator)
        if 1 <= numerator <= 100 and abs(numerator / denominator / measured - 1) < RATIO_PART:
            return Fraction(numerator, denominator)
    return Fraction(measured).limit_denominator(100)


def _confirm(bench: Bench, result: Result) -> None:
    """The values by a turn of their own: direction, count, index."""
    edges = bench.device.value("edges_per_1000_drum_revs") / 1000
    forward = _turn(bench, "encoder.forward", "the way that HAULS ROPE IN, once more")
    back = _turn(bench, "encoder.back", "back to the mark")
    _check(forward, back)
    part = forward["net_edges"] / edges
    result.measured["drum turns by the values"] = round(part, 4)
    if abs(part - 1) > 2 * HAND_PART:
        raise wrong(
            "encoder.turn",
            f"By the values it was {part:.3f} turns, not one.",
            "The ratio is another one, or the turns were not whole ones: turn to a mark.",
        )
    if missed := _either((forward, back), "missed_edges"):
        raise wrong(
            "encoder.pulses",
            f"Between index pulses {missed} edges are missing, or too many.",
            "The encoder has another number of pulses than its nameplate was read to have.",
        )
