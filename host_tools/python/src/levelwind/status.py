"""The live status of a controller: read in one snapshot, shown to an operator, or as JSON."""

from collections.abc import Mapping
from dataclasses import dataclass

from rich.console import Group
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from levelwind.device import Device
from levelwind.map_table import POINTS, Fault, Flag, Mode, State
from levelwind.output import json_value
from levelwind.parameter_sets import read_set
from levelwind.points import enum_label, enum_text, flag_names, inhibit_texts

LIVE_POINTS = [p for p in POINTS.values() if p.block == "status" and 100 <= p.address < 200]
LOS_KINDS = {
    "los1_plus": "1+, the plus switch did not trigger",
    "los1_minus": "1-, the minus switch did not trigger",
    "los2_plus": "2+, the plus switch triggered out of place",
    "los2_minus": "2-, the minus switch triggered out of place",
}
LOS_POINTS = [
    POINTS[f"{kind}_{part}"] for kind in LOS_KINDS for part in ("count", "position_um", "time_ms")
]
HEALTH_POINTS = [p for p in POINTS.values() if p.block == "status" and 340 <= p.address < 370]
CAM_POINTS = [POINTS[name] for name in ("cam_version", "cam_rows", "cam_row", "cam_cycles")]
STACKS = ("supervisor", "limits", "modbus", "storage", "interrupts")
STATE_STYLES = {State.TRACKING: "green", State.READY: "cyan", State.FAULT: "red"}
NOTICES = (
    Flag.HELD,
    Flag.MASTER_LOST,
    Flag.OVERSPEED_WARNING,
    Flag.OVERSPEED_TRIP,
    Flag.WATCHDOG_RESET,
    Flag.DEFAULTS_LOADED,
    Flag.STAGED,
    Flag.DIRTY,
    Flag.TRIM_PENDING,
    Flag.CORRECTION_PENDING,
    Flag.RESTART_NEEDED,
    Flag.LOCKED,
    Flag.LINE_TRIAL,
)
BAR_CELLS = 48


@dataclass(frozen=True)
class Travel:
    """The places that the carriage bar is drawn between."""

    flange_minus_um: int
    reversal_minus_um: int
    reversal_plus_um: int
    flange_plus_um: int


def read_live(device: Device) -> dict[str, int]:
    """State, flags, position, speeds: one request, one consistent snapshot."""
    return device.read(LIVE_POINTS)


def read_status(device: Device) -> dict[str, int]:
    """The live status, the LOS records, the cam, and what the firmware measures of itself."""
    more = [*LOS_POINTS, *CAM_POINTS, *HEALTH_POINTS]
    return read_live(device) | device.read(more)


def read_travel(device: Device) -> Travel:
    """Flanges and reversal points of the active set."""
    names = list(Travel.__dataclass_fields__)
    return Travel(**read_set(device, "active", [POINTS[name] for name in names]))


def flag(status: Mapping[str, int], bit: Flag) -> bool:
    """One flag of a status."""
    return bool(status["flags"] >> bit & 1)


def status_json(status: Mapping[str, int]) -> dict[str, object]:
    """Names as keys, enumerations and flags by name."""
    document = {name: json_value(POINTS[name], value) for name, value in status.items()}
    return {"launch_permit": flag(status, Flag.LAUNCH_PERMIT), **document}


def describe_state(status: Mapping[str, int]) -> str:
    """The state in a sentence; in a fault, why."""
    if status["state"] == State.FAULT:
        return enum_text(Fault, status["fault"])
    return enum_text(State, status["state"])


def render(status: Mapping[str, int], travel: Travel) -> Panel:
    """The operator's view."""
    state = status["state"]
    style = STATE_STYLES.get(state, "yellow")
    rows = Table.grid(padding=(0, 2))
    rows.add_column(style="dim", no_wrap=True)
    rows.add_column()
    rows.add_row("Launch", _permit(status))
    rows.add_row("LOS", _los(status))
    if status["cam_row"]:
        rows.add_row("Cam", _cam(status))
    rows.add_row("Carriage", _carriage(status, travel))
    if flag(status, Flag.INDEXED):
        rows.add_row("", _bar(status["position_um"], travel))
    rows.add_row("Switches", _switches(status))
    rows.add_row(
        "Rope",
        f"{status['rope_speed_mm_per_s'] / 1000:+.2f} m/s, "
        f"{status['rope_mm'] / 1000:+.1f} m since power-up "
        f"({status['drum_speed_edges_per_s']:+d} edges/s, {status['net_edges']:+d} edges net)",
    )
    rows.add_row(
        "Mode", f"{enum_label(Mode, status['active_mode'])}, up {status['uptime_ms'] / 1000:.0f} s"
    )
    rows.add_row("Encoder", _encoder(status))
    stacks = {name: status[f"stack_free_{name}_bytes"] for name in STACKS}
    if any(stacks.values()):
        free = ", ".join(f"{name} {count}" for name, count in stacks.items())
        rows.add_row("Stack free", f"{free} bytes")
    notices = [bit.text for bit in NOTICES if flag(status, bit)]
    if notices:
        rows.add_row("Notices", Text("\n".join(notices), style="yellow"))
    title = Text(enum_label(State, state).upper().replace("_", " "), style=f"bold reverse {style}")
    return Panel(
        Group(Text(describe_state(status), style=style), "", rows),
        title=Text.assemble(" ", title, " "),
        title_align="left",
        border_style=style,
        width=100,
    )


def _permit(status: Mapping[str, int]) -> Text:
    if flag(status, Flag.LAUNCH_PERMIT):
        return Text("PERMITTED", style="bold green")
    reasons = inhibit_texts(status["launch_inhibit"])
    return Text.assemble(("NOT PERMITTED", "bold red"), *(f"\n- {reason}" for reason in reasons))


def _los(status: Mapping[str, int]) -> Text:
    seen = [
        f"type {kind}: at {status[f'{name}_position_um'] / 1000:+.2f} mm, "
        f"{status[f'{name}_time_ms'] / 1000:.1f} s after power-up "
        f"({status[f'{name}_count']} since power-up)"
        for name, kind in LOS_KINDS.items()
        if flag(status, Flag[name.upper()])
    ]
    if not seen:
        return Text("in synchronization", style="green")
    recoveries = f"{status['los_recoveries']} re-indexings in this launch"
    return Text(
        "\n".join(["LOST: THE ROPE MAY BE LAID WRONG", *seen, recoveries]), style="bold red"
    )


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


def _carriage(status: Mapping[str, int], travel: Travel) -> str:
    if not flag(status, Flag.INDEXED):
        return "position unknown"
    inside = travel.reversal_minus_um < status["position_um"] < travel.reversal_plus_um
    place = "sweep" if inside else "reversal"
    return f"{status['position_um'] / 1000:+.2f} mm ({status['position_usteps']} usteps), {place}"


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
    bad = [name for name in flag_names(status["flags"]) if name.startswith(("wiring", "overtr"))]
    return Text.assemble(", ".join(parts), *((f", {name.upper()}", "bold red") for name in bad))
