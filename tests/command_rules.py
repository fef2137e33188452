# SPDX-License-Identifier: Apache-2.0
"""Which write is taken in which state: the rules that test_commands.py tests cell by cell.

`python tests/command_rules.py` writes the table into doc/commands.md; with --check it only says
whether the table there is this one.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

from levelwind.map_table import Command, Mode, Reason, State

DOCUMENT = Path(__file__).parent.parent / "doc" / "commands.md"

MOVING = {
    *(State.BACKING_OFF, State.SEEKING, State.INDEX_REVERSAL, State.SPAN_CHECK, State.PARKING),
    *(State.CENTRING, State.JOGGING),
}
FOLLOWING = {State.TRACKING, State.REACQUIRING}
SET_COMMANDS = {
    *(Command.APPLY, Command.REVERT, Command.SAVE),
    *(Command.FACTORY_MOTION, Command.FACTORY_LINE, Command.FACTORY_ALL, Command.TRY_LINE),
}
TRIM_COMMANDS = {Command.TRIM_EARLY, Command.TRIM_LATE}
CAM_COMMANDS = {Command.CAM_CHECK, Command.CAM_ACTIVATE, Command.CAM_DISCARD}

STATES: dict[str, tuple[State, str]] = {
    "unindexed": (State.UNINDEXED, ""),
    "unindexed_turning": (State.UNINDEXED, "drum turning"),
    "backing_off": (State.BACKING_OFF, ""),
    "seeking": (State.SEEKING, ""),
    "index_reversal": (State.INDEX_REVERSAL, ""),
    "span_check": (State.SPAN_CHECK, ""),
    "parking": (State.PARKING, ""),
    "ready": (State.READY, ""),
    "ready_turning": (State.READY, "drum turning"),
    "tracking": (State.TRACKING, ""),
    "tracking_turning": (State.TRACKING, "drum turning"),
    "centring": (State.CENTRING, ""),
    "centred": (State.CENTRED, ""),
    "centred_turning": (State.CENTRED, "drum turning"),
    "jogging": (State.JOGGING, "toward plus"),
    "reacquiring_turning": (State.REACQUIRING, "drum turning"),
    "off": (State.OFF, ""),
    "off_turning": (State.OFF, "drum turning"),
    "fault": (State.FAULT, "plus overtravel switch still actuated"),
    "fault_turning": (State.FAULT, "its cause gone, drum turning"),
}
"""What is told apart: the state, and what else matters in it."""


def busy(state: State) -> Reason | None:
    """Why what needs a standing carriage is refused."""
    if state in FOLLOWING:
        return Reason.BUSY_TRACKING
    return Reason.BUSY_MOVING if state in MOVING else None


def jog_refusal(name: str, state: State, direction: int) -> Reason | None:
    """A jog may be held on, ended, and begun where nothing else moves the carriage."""
    if direction == 0 or (state == State.JOGGING and direction > 0) or name == "tracking":
        return None
    if name == "fault" and direction > 0:
        return Reason.OVERTRAVEL
    return Reason.MODE_OFF if state == State.OFF else busy(state)


def by_hand_refusal(state: State, command: int) -> Reason | None:
    """The factory set does not describe the drum; a trim is for what follows it."""
    if command == Command.SET_ROPE:
        return Reason.ROPE_NOT_DESCRIBED
    return None if state == State.TRACKING else Reason.TRIM_NOT_FOLLOWING


def reacquire_refusal(name: str, state: State) -> Reason | None:
    """For a turning drum and an unknown place only."""
    if state == State.OFF:
        return Reason.MODE_OFF
    if busy(state):
        return busy(state)
    if state in (State.READY, State.CENTRED):
        return Reason.POSITION_KNOWN
    if state == State.FAULT:
        return Reason.FAULT_STANDS
    return None if name.endswith("turning") else Reason.DRUM_AT_REST


def command_refusal(name: str, state: State, command: int) -> Reason | None:
    """Stop is never refused; sets change at rest; indexing needs current and a resting drum.

    So does looking at the rope. Where some was laid while the carriage stood, that is acknowledged
    after an indexing only: test_rope.py.
    """
    if command in SET_COMMANDS:
        return busy(state)
    if command in TRIM_COMMANDS | {Command.SET_ROPE}:
        return by_hand_refusal(state, command)
    if command == Command.REACQUIRE:
        return reacquire_refusal(name, state)
    if command == Command.CLEAR_FAULT and name == "fault":
        return Reason.CAUSE_PRESENT
    if command == Command.INDEX and (state == State.OFF or state in MOVING):
        return Reason.MODE_OFF if state == State.OFF else Reason.BUSY_MOVING
    at_rest_only = command in (Command.INDEX, Command.ACKNOWLEDGE_ROPE)
    return Reason.DRUM_MOVING if at_rest_only and name.endswith("turning") else None


def expected_refusal(name: str, state: State, register: str, value: int) -> Reason | None:
    """Why a write must be refused here; None if it must be taken."""
    if register == "jog":
        return jog_refusal(name, state, value)
    if register == "command":
        return command_refusal(name, state, value)
    if register == "pitch_um":
        return Reason.BUSY_TRACKING if state in FOLLOWING else None
    if register == "trim_plus_um":
        return Reason.BUSY_MOVING if state in MOVING else None
    return None


WRITES = [
    *(("command", command) for command in Command),
    *(("mode", mode) for mode in Mode),
    *(("jog", direction) for direction in (-1, 0, 1)),
    ("pitch_um", 11_000),
    ("trim_plus_um", -500),
]


def _columns() -> Iterator[tuple[str, str, list[int]]]:
    """Head of a column, and the register and values that it stands for."""
    sets = [command for command in Command if command in SET_COMMANDS]
    cams = [command for command in Command if command in CAM_COMMANDS]
    trims = [command for command in Command if command in TRIM_COMMANDS]
    together = SET_COMMANDS | CAM_COMMANDS | TRIM_COMMANDS
    alone = [c for c in Command if c not in together and c != Command.NONE]
    for command in alone:
        yield command.label, "command", [command]
    yield ", ".join(command.label for command in sets), "command", sets
    yield ", ".join(command.label for command in cams), "command", cams
    yield ", ".join(command.label for command in trims), "command", trims
    yield "mode", "mode", list(Mode)
    yield "jog +1", "jog", [1]
    yield "jog -1", "jog", [-1]
    yield "jog 0", "jog", [0]
    yield "trim", "trim_plus_um", [-500]
    yield "parameter", "pitch_um", [11_000]


def table() -> str:
    """The rules as a Markdown table."""
    columns = list(_columns())
    lines = [
        "| state | " + " | ".join(head for head, _, _ in columns) + " |",
        "| --- |" + " --- |" * len(columns),
    ]
    for name, (state, what) in STATES.items():
        cells = [f"{state.label}{f' ({what})' if what else ''}"]
        for _, register, values in columns:
            refusals = {expected_refusal(name, state, register, value) for value in values}
            assert len(refusals) == 1, f"{name}, {register} {values}: a column of its own each"
            refusal = refusals.pop()
            cells.append("yes" if refusal is None else refusal.label)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def document() -> str:
    """doc/commands.md."""
    return f"""# Which write is taken in which state

Generated by `python tests/command_rules.py` from the rules that `tests/system/test_commands.py`
tests on the running controller, every cell. Do not edit.

*yes*: taken. Else the write is refused with exception 06, nothing changes, and the name is the
reason that `last_error_reason` (input 410) and, for a command, `command_reason` (input 403) tell;
[registers.md](registers.md) has them in words. A closed write lock adds its own refusals, reason
`locked`: [integration.md](integration.md). A command that is taken may still end as refused or
failed: `command_result` (input 402) tells. With the flag `rope_laid_standing`, `acknowledge_rope`
is refused with `rope_index_first` until an indexing has succeeded since. `set_rope` stands here for
the factory set, which does not describe the drum; of one that is described it is taken in every
state, with the drum at rest. `trim_early` and `trim_late` are also refused where the reversal would
break a rule of the parameters, with the reason that APPLY would give.

{table()}
The columns stand for writes of holding registers: `command`, `mode` (any), `jog`, `trim_plus_um`
or `trim_minus_um` (a changed value), and any parameter. The coils of the same names are refused
alike.
"""


if __name__ == "__main__":
    if "--check" not in sys.argv[1:]:
        DOCUMENT.write_text(document())
    elif DOCUMENT.read_text() != document():
        sys.exit(f"{DOCUMENT} is not what tests/command_rules.py makes: run it")
