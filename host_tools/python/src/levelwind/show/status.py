# SPDX-License-Identifier: Apache-2.0
"""The live status of a controller: read in one snapshot, shown to an operator, or as JSON."""

from collections.abc import Mapping

from rich.console import Group
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from levelwind.line.live import Travel, all_flags, flag, image_of, version_of
from levelwind.line.points import enum_label, enum_text, flag_names
from levelwind.map_table import POINTS, EncoderFault, Fault, Flag, Mode, SlotState, State
from levelwind.show.advice import (
    Words,
    following_begins,
    inhibit_reasons,
    on_the_command_line,
)
from levelwind.show.output import console, json_value

LOS_KINDS = {
    "los1_plus": "1+, the plus switch did not trigger",
    "los1_minus": "1-, the minus switch did not trigger",
    "los2_plus": "2+, the plus switch triggered out of place",
    "los2_minus": "2-, the minus switch triggered out of place",
}
ENCODER_LOOK_BIT = 5  # of look_before_power_up; 4 is the rope laid standing
STACKS = ("supervisor", "limits", "modbus", "storage", "interrupts")
STATE_STYLES: dict[int, str] = {State.TRACKING: "green", State.READY: "cyan", State.FAULT: "red"}
NOTICES = (
    Flag.HELD,
    Flag.MASTER_LOST,
    Flag.OVERSPEED_WARNING,
    Flag.OVERSPEED_TRIP,
    Flag.ODOMETER_DOUBTFUL,
    Flag.RESUME_DOUBTFUL,
    Flag.WATCHDOG_RESET,
    Flag.DEFAULTS_LOADED,
    Flag.STAGED,
    Flag.DIRTY,
    Flag.NOT_ACCEPTED,
    Flag.TRIM_PENDING,
    Flag.CORRECTION_PENDING,
    Flag.RESTART_NEEDED,
    Flag.LOCKED,
    Flag.LINE_TRIAL,
)
BAR_CELLS = 48
BAR_TERMINAL_COLUMNS = 76  # in a narrower one the bar would be broken
STORED = {
    "parameters": (0, "an older set may be in force. Compare it with your backup, then "
                   "`levelwind save`"),
    "event log": (2, "the last events before this power-up may be missing"),
    "cam table": (4, "the one before it may be in force. `levelwind cam download` reads it"),
    "record of what needs a look": (6, "a loss of synchronization, or rope laid while the "
                                    "carriage stood, may be forgotten: look at the rope"),
}  # fmt: skip
NOT_USED: dict[int, str] = {
    SlotState.DAMAGED: "damaged",
    SlotState.REFUSED: "not accepted by this firmware",
    SlotState.NEWER: "of newer firmware",
}
WIDTH = 100


def status_json(status: Mapping[str, int]) -> dict[str, object]:
    """Names as keys, enumerations and flags by name."""
    document = {name: json_value(POINTS[name], value) for name, value in status.items()}
    return {
        "launch_permit": flag(status, Flag.LAUNCH_PERMIT),
        "image": image_of(status),
        **document,
    }


def describe_state(status: Mapping[str, int], words: Words = on_the_command_line) -> str:
    """The state in a sentence, with what to do next; in a fault, why."""
    state = status["state"]
    if state == State.FAULT:
        return enum_text(Fault, status["fault"])
    if state == State.READY:
        return f"Indexed and at rest. {following_begins(status, words)}."
    return enum_text(State, state)


def render(status: Mapping[str, int], travel: Travel) -> Panel:
    """The operator's view."""
    state = status["state"]
    style = STATE_STYLES.get(state, "yellow")
    rows = Table.grid(padding=(0, 2))
    rows.add_column(style="dim", no_wrap=True)
    rows.add_column(overflow="fold")
    rows.add_row("Launch", _permit(status))
    rows.add_row("LOS", _los(status))
    if flag(status, Flag.ROPE_LAID_STANDING):
        rows.add_row("Rope laid", _rope_laid_standing(status))
    if status["cam_row"]:
        rows.add_row("Cam", _cam(status))
    rows.add_row("Carriage", _carriage(status, travel))
    if flag(status, Flag.INDEXED) and console.width >= BAR_TERMINAL_COLUMNS:
        rows.add_row("", _bar(status["position_um"], travel))
    rows.add_row("Switches", _switches(status))
    rows.add_row(
        "Rope",
        f"{status['rope_speed_mm_per_s'] / 1000:+.2f} m/s, "
        f"{status['rope_mm'] / 1000:+.1f} m since power-up "
        f"({status['drum_speed_edges_per_s']:+d} edges/s, {status['net_edges']:+d} edges net)",
    )
    if status["rope_radius_um"] or flag(status, Flag.ROPE_DOUBTFUL):
        rows.add_row("On the drum", _on_drum(status))
    if status["resume_direction"] and status["state"] != State.TRACKING:
        rows.add_row("Rope goes on", _resume(status))
    rows.add_row(
        "Mode", f"{enum_label(Mode, status['active_mode'])}, up {status['uptime_ms'] / 1000:.0f} s"
    )
    rows.add_row("Encoder", _encoder(status))
    stacks = {name: status[f"stack_free_{name}_bytes"] for name in STACKS}
    if any(stacks.values()):
        free = ", ".join(f"{name} {count}" for name, count in stacks.items())
        rows.add_row("Stack free", f"{free} bytes")
    image = image_of(status)
    rows.add_row("Firmware", version_of(status) + (f", image {image}" if image else ""))
    notices = notice_lines(status)
    if notices:
        rows.add_row("Notices", Text("\n".join(notices), style="yellow"))
    title = Text(enum_label(State, state).upper().replace("_", " "), style=f"bold reverse {style}")
    return Panel(
        Group(Text(describe_state(status), style=style), "", rows),
        title=Text.assemble(" ", title, " "),
        title_align="left",
        border_style=style,
        width=WIDTH,
    )


def notice_lines(status: Mapping[str, int]) -> list[str]:
    """What is no fault and should be known."""
    return [bit.text for bit in NOTICES if flag(status, bit)] + _storage_notices(status)


def _on_drum(status: Mapping[str, int]) -> Text:
    """How much rope there is, and whether that can be believed."""
    if not status["rope_radius_um"]:
        return Text("not known: levelwind set-rope METRES, where it is known", style="yellow")
    text = (
        f"{status['rope_on_drum_mm'] / 1000:.1f} m, {status['rope_out_mm'] / 1000:+.1f} m out, "
        f"layer {status['rope_layer']}"
    )
    if flag(status, Flag.ROPE_DOUBTFUL):
        return Text(f"{text}; DOUBTFUL: set-rope where it is known", style="yellow")
    return Text(text)


def _resume(status: Mapping[str, int]) -> Text:
    """Where the drum came to rest, and what that is worth."""
    side = "plus" if status["resume_direction"] > 0 else "minus"
    text = f"at {status['resume_position_um'] / 1000:+.2f} mm, hauling in toward {side}"
    if flag(status, Flag.RESUME_DOUBTFUL):
        return Text(f"{text}; DOUBTFUL, it is not gone to", style="yellow")
    return Text(f"{text}; gone to before the carriage follows")


def render_no_data(reason: str, seconds: float) -> Panel:
    """Instead of the operator's view: old values must not stay on the screen."""
    rows = Table.grid(padding=(0, 2))
    rows.add_column(style="dim", no_wrap=True)
    rows.add_column()
    rows.add_row("Launch", Text("NO DATA: take it as NOT PERMITTED", style="bold red"))
    rows.add_row("Line", Text(reason))
    rows.add_row("", f"Nothing heard for {seconds:.0f} s. Goes on by itself when it answers.")
    return Panel(
        rows,
        title=Text(" NO DATA ", style="bold reverse red"),
        title_align="left",
        border_style="red",
        width=WIDTH,
    )


def _storage_notices(status: Mapping[str, int]) -> list[str]:
    """What was stored and is not used: nothing else of a set, a log or a table shows it."""
    return [
        f"A stored {what} record is {NOT_USED[state]}: {so}."
        for what, (first, so) in STORED.items()
        for state in (status[f"slot_{first}"], status[f"slot_{first + 1}"])
        if state in NOT_USED
    ]


def _permit(status: Mapping[str, int]) -> Text:
    if flag(status, Flag.LAUNCH_PERMIT):
        return Text("PERMITTED", style="bold green")
    return Text.assemble(
        ("NOT PERMITTED", "bold red"), *(f"\n- {reason}" for reason in inhibit_reasons(status))
    )


def los_lines(status: Mapping[str, int]) -> list[str]:
    """Every loss of synchronization: kind and side, where, when. None where there is none."""
    seen = [
        f"type {kind}: at {status[f'{name}_position_um'] / 1000:+.2f} mm, "
        f"{_when(status, f'{name}_time_ms', number)}"
        for number, (name, kind) in enumerate(LOS_KINDS.items())
        if flag(status, Flag[name.upper()])
    ]
    if flag(status, Flag.ENCODER_FAULT):
        what = enum_text(EncoderFault, status["encoder_fault_kind"])
        if status["encoder_fault_kind"] == EncoderFault.NONE:
            what = "the encoder did not tell the drum's motion"
        seen.append(
            f"encoder: {what}: at {status['encoder_fault_position_um'] / 1000:+.2f} mm, "
            f"{_when(status, 'encoder_fault_time_ms', ENCODER_LOOK_BIT)}"
        )
    if flag(status, Flag.REACQUIRED):
        seen.append("after a restart in a launch the turning drum was taken up")
    return seen


def _los(status: Mapping[str, int]) -> Text:
    seen = los_lines(status)
    if not seen and not flag(status, Flag.INDEXED):
        return Text("unknown until indexed", style="yellow")
    if not seen:
        return Text("in synchronization", style="green")
    recoveries = f"{status['los_recoveries']} re-indexings in this launch"
    return Text(
        "\n".join(["LOST: THE ROPE MAY BE LAID WRONG", *seen, recoveries]), style="bold red"
    )


def rope_standing_lines(status: Mapping[str, int]) -> list[str]:
    """How much rope was laid while the carriage stood; where, when."""
    place = "at an unknown place"
    if status["rope_standing_place_known"]:
        place = f"at {status['rope_standing_position_um'] / 1000:+.2f} mm"
    return [
        f"{status['rope_standing_millirev'] / 1000:.1f} DRUM TURNS OF ROPE WERE LAID WHILE THE "
        "CARRIAGE STOOD",
        f"{place}, {_when(status, 'rope_standing_time_ms', len(LOS_KINDS))}",
    ]


def _rope_laid_standing(status: Mapping[str, int]) -> Text:
    return Text("\n".join(rope_standing_lines(status)), style="bold red")


def _when(status: Mapping[str, int], name: str, look_bit: int) -> str:
    """When something happened that needs a look at the rope."""
    earlier = status["look_before_power_up"] >> look_bit & 1
    return f"{status[name] / 1000:.1f} s after {'an earlier ' if earlier else ''}power-up"


def _cam(status: Mapping[str, int]) -> Text:
    return Text(
        f"not the level-wind law: table version {status['cam_version']}, "
        f"row {status['cam_row']} of {status['cam_rows']}, cycle {status['cam_cycles']:+d}",
        style="bold yellow",
    )


def _encoder(status: Mapping[str, int]) -> Text:
    parts = []
    if status["encoder_interrupt_max_ns"]:
        parts.append(f"interrupt {status['encoder_interrupt_max_ns'] / 1000:.1f} us at most")
    parts.append(f"{status['late_interrupts']} late interrupts")
    if status["encoder_index_pulses"]:
        parts.append(f"{status['missed_edges']} missed edges")
    else:
        parts.append("no index pulse yet")
    return Text(", ".join(parts), style="bold red" if status["missed_edges"] else "")


def _carriage(status: Mapping[str, int], travel: Travel) -> Text:
    if not flag(status, Flag.INDEXED):
        return Text("position unknown")
    inside = travel.reversal_minus_um < status["position_um"] < travel.reversal_plus_um
    place = "sweep" if inside else "reversal"
    known = f"{status['position_um'] / 1000:+.2f} mm ({status['position_usteps']} usteps), {place}"
    if flag(status, Flag.LOS):
        return Text.assemble(known, (", UNCERTAIN since synchronization was lost", "bold yellow"))
    return Text(known)


def _bar(position_um: int, travel: Travel) -> Text:
    """Minus flange to plus flange; the sweep is drawn lighter than the reversals."""
    width_um = max(1, travel.flange_plus_um - travel.flange_minus_um)

    def cell(um: int) -> int:
        at = (um - travel.flange_minus_um) * (BAR_CELLS - 1) / width_um
        return max(0, min(BAR_CELLS - 1, round(at)))

    cells = ["━"] * BAR_CELLS
    cells[cell(travel.reversal_minus_um)] = "╸"
    cells[cell(travel.reversal_plus_um)] = "╺"
    at = cell(position_um)
    return Text.assemble("- ▕", "".join(cells[:at]), ("█", "bold"), "".join(cells[at + 1 :]), "▏ +")


def _switches(status: Mapping[str, int]) -> Text:
    parts = []
    for side in ("plus", "minus"):
        on = flag(status, Flag[f"SWITCH_{side.upper()}"])
        parts.append(f"{side} {'ACTUATED' if on else 'released'}")
    bad = [name for name in flag_names(all_flags(status)) if name.startswith(("wiring", "overtr"))]
    return Text.assemble(", ".join(parts), *((f", {name.upper()}", "bold red") for name in bad))
