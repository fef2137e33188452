# SPDX-License-Identifier: Apache-2.0
"""Why a launch is not permitted, and what to do about it in this very state."""

from collections.abc import Callable, Mapping

from levelwind.line.live import flag
from levelwind.map_table import Flag, LaunchInhibit, Mode, State

# What sends somebody to look at the rope comes before what sends him to the key "index".
LOOK_FIRST = (LaunchInhibit.LOS, LaunchInhibit.ROPE_LAID_STANDING)

Words = Callable[[str], str]
"""How an action is asked for where the text is read, by its name on the command line."""


def on_the_command_line(action: str) -> str:
    """As a command of the tool."""
    return f"`levelwind {action}`"


# The others: the map's text. {index} is how to index from here.
REASONS = {
    LaunchInhibit.LOS: "Synchronization was lost: look at the rope first, then {index}",
    LaunchInhibit.ROPE_LAID_STANDING: "Rope was laid while the carriage stood: look at the rope, "
    "pull out what lies badly; then {acknowledge}",
    LaunchInhibit.FAULT: "A fault stands: remove its cause, then {index}",
    LaunchInhibit.WIRING: "A limit switch has a wiring fault: mend it, then {clear_fault}",
    LaunchInhibit.OVERTRAVEL: "An overtravel switch is actuated. Carriage there: {index} moves it "
    "off. Carriage elsewhere: check that switch and its wire",
    LaunchInhibit.OVERSPEED: "The drum tripped the overspeed limit: {index}",
    LaunchInhibit.STEPPER_ALARM: "The stepper driver reports an alarm: look at the driver, "
    "then {index}",
    LaunchInhibit.CAM: "The motion profile is cam and its table cannot be followed: "
    "{cam_reason} says why",
}

# Why the carriage does not follow the drum. The other states: it is indexing.
NOT_TRACKING: dict[int, str] = {
    State.UNINDEXED: "The position is unknown: {index}",
    State.OFF: "The stepper has no current (mode off): {index}",
    State.READY: "{follow}",
    State.CENTRED: "The carriage is held at the centre: for a launch, {track}",
    State.CENTRING: "The carriage moves to the centre, to where the rope goes on, or back into the "
    "sweep: wait; in mode centre, {track} for a launch",
    State.REACQUIRING: "It takes up the turning drum: wait for the first limit switch",
    State.JOGGING: "The carriage is moved by hand: end the jog",
    State.TRACKING: "The position is unknown: {index}",
    State.FAULT: "A fault has stopped the carriage: {index}",
}
INDEXING = "It is indexing: wait for the end, or {stop}"


def inhibit_reasons(status: Mapping[str, int], words: Words = on_the_command_line) -> list[str]:
    """Each reason with the next action, in the order to do them."""
    bits = [bit for bit in LaunchInhibit if status["launch_inhibit"] >> bit & 1]
    if LaunchInhibit.FAULT in bits and LaunchInhibit.NOT_TRACKING in bits:
        bits.remove(LaunchInhibit.NOT_TRACKING)  # the fault says all of it
    bits.sort(key=lambda bit: (bit not in LOOK_FIRST, bit))
    texts = {**REASONS, LaunchInhibit.NOT_TRACKING: NOT_TRACKING.get(status["state"], INDEXING)}
    actions = _actions(status, words)
    return [texts.get(bit, bit.text).format(**actions) for bit in bits]


def following_begins(status: Mapping[str, int], words: Words = on_the_command_line) -> str:
    """What a carriage that is indexed and stands waits for."""
    if flag(status, Flag.HELD):
        return f"It was stopped by command: {words('mode track')} lets it follow the drum"
    if status["active_mode"] == Mode.CENTRE:
        return f"It goes to the centre next: for a launch, {words('mode track')}"
    if not flag(status, Flag.DRUM_AT_REST):
        return "It follows the drum as soon as that rests: let the drum come to rest"
    return "It is about to follow the drum"


def _actions(status: Mapping[str, int], words: Words) -> dict[str, str]:
    index, track = words("index"), words("mode track")
    if status["state"] == State.OFF:
        index = f"{track}, then {index}"
    if not flag(status, Flag.DRUM_AT_REST):
        index = f"let the drum come to rest, then {index}"
    acknowledge = words("acknowledge")
    if not flag(status, Flag.INDEXED):
        acknowledge = f"{index}, then {acknowledge}"
    return {
        "index": index,
        "acknowledge": acknowledge,
        "follow": following_begins(status, words),
        "track": track,
        "stop": words("stop"),
        "clear_fault": words("clear-fault"),
        "cam_reason": words("get cam_reason"),
    }
