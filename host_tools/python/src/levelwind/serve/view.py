# SPDX-License-Identifier: Apache-2.0
"""What the page shows of a status: words and numbers, ready to be drawn."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from levelwind.line.event_log import LogRecord
from levelwind.line.live import Travel, all_flags, flag
from levelwind.line.points import enum_label, enum_text
from levelwind.map_table import Event, Fault, Flag, Mode, State
from levelwind.show.advice import inhibit_reasons
from levelwind.show.status import describe_state, los_lines, notice_lines, rope_standing_lines

# Where the page, or the panel of the winch, has a key; {} of the texts of the map.
KEYS = {
    "index": "the key Index",
    "stop": "the key Stop carriage",
    "mode track": "the key Follow the drum",
    "acknowledge": "the key Rope looked at",
    "clear-fault": "the key Clear fault",
    "get cam_reason": "the parameter list (cam_reason)",
}
SIDES = ("minus", "plus")
STILL_UM = 20
"""Less than this between two looks is no direction."""


@dataclass
class Motion:
    """Which way the carriage went last."""

    position_um: int | None = None
    direction: int = 0

    def see(self, status: Mapping[str, int]) -> int:
        """-1, 0 or 1, after this status."""
        now_um = status["position_um"]
        before_um, resting = self.position_um, flag(status, Flag.DRUM_AT_REST)
        if before_um is None or (resting and not flag(status, Flag.MOVING)):
            self.direction, self.position_um = 0, now_um
        elif abs(now_um - before_um) >= STILL_UM:
            self.direction = 1 if now_um > before_um else -1
            self.position_um = now_um
        return self.direction


@dataclass
class Seen:
    """All that is known of the device at one time."""

    status: dict[str, int]
    travel: Travel
    stamp_s: float
    """When the request of the live values was sent: time.monotonic()."""
    direction: int = 0
    log: list[LogRecord] = field(default_factory=list)
    log_s: float = 0.0
    """Every event until then is in `log`: time.monotonic()."""


def key(action: str) -> str:
    """How an action is asked for at the page."""
    return KEYS[action]


def view(seen: Seen) -> dict[str, object]:
    """The document for the page. Words come from the map and from the tool's own advice."""
    status, travel = seen.status, seen.travel
    indexed, lost = flag(status, Flag.INDEXED), los_lines(status)
    return {
        "permit": flag(status, Flag.LAUNCH_PERMIT),
        "inhibits": inhibit_reasons(status, key),
        "state": enum_label(State, status["state"]).replace("_", " "),
        "state_text": describe_state(status, key),
        "mode": enum_label(Mode, status["active_mode"]),
        "fault": _fault(status),
        "los": {
            "lost": bool(lost) or flag(status, Flag.LOS),
            "known": indexed,
            "lines": lost,
            "todo": "Look at the rope first. Pull out what lies badly. Then index: "
            "only an indexing that succeeds ends this.",
        },
        "standing": rope_standing_lines(status) if flag(status, Flag.ROPE_LAID_STANDING) else [],
        "notices": notice_lines(status),
        "indexed": indexed,
        "position_mm": status["position_um"] / 1000,
        "travel_mm": [
            um / 1000
            for um in (
                travel.flange_minus_um,
                travel.reversal_minus_um,
                travel.reversal_plus_um,
                travel.flange_plus_um,
            )
        ],
        "direction": seen.direction,
        "next_reversal": _next_reversal(seen),
        "switches": {side: _switch(status, side) for side in SIDES},
        "rope": {
            "speed_m_per_s": status["rope_speed_mm_per_s"] / 1000,
            "out_m": status["rope_out_mm"] / 1000,
            "on_drum_m": status["rope_on_drum_mm"] / 1000,
            "since_power_up_m": status["rope_mm"] / 1000,
            "layer": status["rope_layer"],
            "known": bool(status["rope_radius_um"]),
            "doubtful": flag(status, Flag.ROPE_DOUBTFUL),
        },
        "index_age_s": index_age_s(status, seen.log),
        "drum_at_rest": flag(status, Flag.DRUM_AT_REST),
    }


def _fault(status: Mapping[str, int]) -> dict[str, str] | None:
    if not flag(status, Flag.FAULTED):
        return None
    cause, _, remedy = enum_text(Fault, status["fault"]).partition(". ")
    name = enum_label(Fault, status["fault"]).replace("_", " ")
    return {"name": name, "cause": cause, "remedy": remedy or "Remove the cause, then index"}


def _next_reversal(seen: Seen) -> dict[str, object] | None:
    if not seen.direction or not flag(seen.status, Flag.INDEXED):
        return None
    travel = seen.travel
    at_um = travel.reversal_plus_um if seen.direction > 0 else travel.reversal_minus_um
    left_um = max(0, (at_um - seen.status["position_um"]) * seen.direction)
    return {"side": SIDES[seen.direction > 0], "in_mm": left_um / 1000}


def _switch(status: Mapping[str, int], side: str) -> dict[str, object]:
    """The worst that is to be said of a side's switches."""
    for name, word in (("WIRING", "WIRING FAULT"), ("OVERTRAVEL", "OVERTRAVEL")):
        if flag(status, Flag[f"{name}_{side.upper()}"]):
            return {"word": word, "bad": True, "on": True}
    on = flag(status, Flag[f"SWITCH_{side.upper()}"])
    return {"word": "actuated" if on else "free", "bad": False, "on": on}


def index_age_s(status: Mapping[str, int], log: list[LogRecord]) -> float | None:
    """Since the last indexing that succeeded; None where the log does not say it."""
    boot = max((record.boot for record in log), default=0)
    done = [r.time_ms for r in log if r.event == Event.INDEX_DONE and r.boot == boot]
    if not done or not flag(status, Flag.INDEXED):
        return None
    return max(0.0, (status["uptime_ms"] - done[-1]) / 1000)


def flag_words(status: Mapping[str, int]) -> list[str]:
    """Every flag that is on, as the map says it."""
    flags = all_flags(status)
    return [bit.text for bit in Flag if flags >> bit & 1]


def log_rows(log: list[LogRecord]) -> list[list[str]]:
    """The event log in words, newest first."""
    return [
        [
            str(record.boot),
            f"{record.time_ms / 1000:.1f}",
            record.event_text,
            record.detail_text,
            f"{record.position_um / 1000:+.2f}",
            record.state_name.replace("_", " "),
        ]
        for record in reversed(log)
    ]
