# SPDX-License-Identifier: Apache-2.0
"""Step 2: every switch by hand."""

from levelwind.commission.bench import Bench, wrong
from levelwind.commission.session import Result
from levelwind.map_table import Flag, SwitchContacts

SIDES = ("plus", "minus")
OTHER = {"plus": "minus", "minus": "plus"}
SETTLE_S = 0.4  # longer than the longest transit of a contact
WIRINGS = {"pair": SwitchContacts.NO_NC_PAIR, "no": SwitchContacts.SINGLE_NO,
           "nc": SwitchContacts.SINGLE_NC}  # fmt: skip


def run(bench: Bench, result: Result) -> None:
    """Released, pressed, released again; both sides, then the overtravel switches."""
    human = bench.human
    bench.current_off()
    wiring = human.choose(
        "contacts.wiring",
        "How is a limit switch wired: NO and NC contact, NO alone, NC alone?",
        tuple(WIRINGS),
        "pair",
    )
    bench.apply({"switch_contacts": int(WIRINGS[wiring])})
    result.proposed["switch_contacts"] = int(WIRINGS[wiring])
    human.when_done(
        "contacts.middle",
        "The stepper has no current. Push the carriage to the middle by hand: no switch touched.",
    )
    _released(bench, wiring)
    for side in SIDES:
        _press(bench, side, wiring)
        result.measured[f"{side} limit switch"] = "both states seen" + (
            ", both wires" if wiring == "pair" else ""
        )
    if human.choose("contacts.overtravel", "Are there overtravel switches?", "yn", "y") == "y":
        for side in SIDES:
            _overtravel(bench, side)
            result.measured[f"{side} overtravel switch"] = "both states seen"
    human.when_done("contacts.middle", "Push the carriage to the middle again, by hand.")
    bench.forgive()


def _state(bench: Bench, side: str) -> tuple[bool, bool]:
    """Actuated, wiring fault."""
    actuated, faulty = bench.flags(Flag[f"SWITCH_{side.upper()}"], Flag[f"WIRING_{side.upper()}"])
    return actuated, faulty


def _settled(bench: Bench) -> None:
    """Let contacts travel and bounce, then forget what was on the way."""
    bench.see(lambda: False, SETTLE_S)
    bench.forgive()
    bench.see(lambda: False, SETTLE_S)


def _released(bench: Bench, wiring: str) -> None:
    _settled(bench)
    both = [_state(bench, side) for side in SIDES]
    for side, (actuated, faulty) in zip(SIDES, both, strict=True):
        if faulty:
            raise wrong(
                f"contacts.{side}_at_rest",
                f"The {side} limit switch, released, shows neither contact closed, or both.",
                f"The wire of its NC contact is broken, or both contacts are shorted: look at the "
                f"{side} switch, its plug and terminals. One contact only? Answer so.",
            )
        if actuated:
            reversed_ = "Its NO and NC wires are exchanged" if wiring == "pair" else (
                "An NC contact is taken for an NO one, or the other way")  # fmt: skip
            raise wrong(
                f"contacts.{side}_actuated_at_rest",
                f"The {side} limit switch reads actuated though nothing touches it.",
                f"{reversed_}, or the switch is stuck, or its wire is broken or shorted. If the "
                f"{side} switch has been pressed all the time, the carriage is not in the middle.",
            )


def _press(bench: Bench, side: str, wiring: str) -> None:
    """One switch: pressed, then let go."""
    name = f"contacts.{side}"
    bench.human.ask_to(f"{name}.press", f"Press the {side.upper()} limit switch and hold it.")
    other = OTHER[side]
    seen = bench.see(lambda: any(any(_state(bench, s)) for s in SIDES))
    _settled(bench)
    actuated, faulty = _state(bench, side)
    if _state(bench, other)[0] and not actuated and not faulty:
        raise wrong(
            "contacts.swapped",
            f"The {side} switch is pressed, and the {other} one tells it.",
            "Plus and minus are swapped: exchange the cables of the two limit switches.",
        )
    if faulty:
        raise wrong(
            f"{name}_pressed",
            f"The {side} limit switch, pressed, shows neither contact closed, or both.",
            f"The wire of its NO contact is broken, or a contact does not open: look at the {side} "
            "switch, its plug and terminals.",
        )
    if not seen or not actuated:
        single = "" if wiring == "pair" else " or its wire is broken"
        raise wrong(
            f"{name}_dead",
            f"The {side} limit switch was to be pressed, and nothing was seen.",
            f"It does not reach its point{single}, or it is not connected: look at the {side} "
            "switch and its cable.",
        )
    bench.human.ask_to(f"{name}.release", "Let go of it.")
    if not bench.see(lambda: not _state(bench, side)[0]):
        raise wrong(
            f"{name}_stuck",
            f"The {side} limit switch stays actuated.",
            "The switch is stuck, or its NO wire is shorted.",
        )
    _settled(bench)
    if _state(bench, side)[1]:
        raise wrong(
            f"{name}_released",
            f"The {side} limit switch, let go, shows neither contact closed, or both.",
            "The wire of its NC contact is loose: look at its plug and terminals.",
        )


def _overtravel(bench: Bench, side: str) -> None:
    name, bit = f"contacts.overtravel_{side}", Flag[f"OVERTRAVEL_{side.upper()}"]
    other = OTHER[side]
    there, both = bench.flags(bit, Flag[f"OVERTRAVEL_{other.upper()}"])
    if there or both:
        stuck = side if there else other
        raise wrong(
            f"contacts.overtravel_{stuck}_stuck",
            f"The {stuck} overtravel switch reads actuated though nobody presses it.",
            "Its wire is broken (the contact is normally closed), or the switch is stuck.",
        )
    bench.human.ask_to(f"{name}.press", f"Press the {side.upper()} OVERTRAVEL switch and hold it.")
    bench.see(lambda: any(bench.flags(bit, Flag[f"OVERTRAVEL_{other.upper()}"])))
    here, there = bench.flags(bit, Flag[f"OVERTRAVEL_{other.upper()}"])
    if there and not here:
        raise wrong(
            "contacts.overtravel_swapped",
            f"The {side} overtravel switch is pressed, and the {other} one tells it.",
            "Plus and minus are swapped: exchange the cables of the two overtravel switches.",
        )
    if not here:
        raise wrong(
            f"{name}_dead",
            f"The {side} overtravel switch was to be pressed, and nothing was seen.",
            "It does not reach its point, or is not connected. Without overtravel switches answer "
            "so: nothing then keeps the carriage from the end stop but the limit switches.",
        )
    bench.human.ask_to(f"{name}.release", "Let go of it.")
    if not bench.see(lambda: not bench.flags(bit)[0]):
        raise wrong(
            f"contacts.overtravel_{side}_stuck",
            f"The {side} overtravel switch stays actuated.",
            "The switch is stuck, or its wire has broken just now.",
        )
