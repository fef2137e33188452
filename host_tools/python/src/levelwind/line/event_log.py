# SPDX-License-Identifier: Apache-2.0
"""The event log of a controller: file 1 of FC20, one fixed-size record for each event."""

import os
import struct
from collections.abc import Callable
from dataclasses import dataclass

from levelwind.line.device import Device
from levelwind.line.points import enum_label
from levelwind.map_table import DETAIL_ENUMS, POINTS, Event, State

FILE_NUMBER = 1
RECORDS = 64
# Sequence, power-up, time, event, state, detail, position, net edges: lw/storage/log.h.
LAYOUT = struct.Struct(">IIIHHiiq")
WORDS = LAYOUT.size // 2
RECORDS_PER_REQUEST = 7


@dataclass(frozen=True)
class LogRecord:
    """One event."""

    sequence: int
    boot: int
    time_ms: int
    event: int
    state: int
    detail: int
    position_um: int
    net_edges: int

    @property
    def event_name(self) -> str:
        """Its name in the map; the number if newer firmware has written it."""
        return enum_label(Event, self.event)

    @property
    def event_text(self) -> str:
        """What happened, in words."""
        try:
            return Event(self.event).text.partition(". Detail:")[0]
        except ValueError:
            return f"Event {self.event}, not known to this version of the tool"

    @property
    def state_name(self) -> str:
        """The state afterwards."""
        return enum_label(State, self.state)

    @property
    def detail_text(self) -> str:
        """The detail in words and units."""
        if self.event not in list(Event):
            return str(self.detail)
        event = Event(self.event)
        if event in DETAIL_ENUMS:
            return enum_label(DETAIL_ENUMS[event], self.detail).replace("_", " ")
        if event in _DETAIL_TEXTS:
            return _DETAIL_TEXTS[event](self.detail)
        _, has_detail, what = event.text.partition(". Detail: ")
        return f"{self.detail} ({what})" if has_detail else ""

    @property
    def detail_name(self) -> str:
        """The detail by its name where the map has one, else the number."""
        names = DETAIL_ENUMS.get(Event(self.event)) if self.event in list(Event) else None
        return enum_label(names, self.detail) if names else str(self.detail)


def _version(detail: int) -> str:
    return f"version {detail // 10000}.{detail // 100 % 100}.{detail % 100}"


def _slot(detail: int) -> str:
    return POINTS[f"slot_{detail}"].text.removeprefix("Storage: ")


def _since_power_up(detail: int) -> str:
    return f"{detail} since power-up"


def _turns(detail: int) -> str:
    return f"{detail / 1000:.1f} drum turns"


def _look(detail: int) -> str:
    causes = ("LOS 1+", "LOS 1-", "LOS 2+", "LOS 2-", "rope laid while the carriage stood")
    return ", ".join(cause for bit, cause in enumerate(causes) if detail >> bit & 1)


_DETAIL_TEXTS: dict[Event, Callable[[int], str]] = {
    Event.POWER_UP: _version,
    Event.SLOT_DAMAGED: _slot,
    Event.SLOT_NEWER: _slot,
    Event.SLOT_REFUSED: _slot,
    Event.INDEX_DONE: lambda detail: f"other switch {detail / 1000:+.2f} mm from its place",
    Event.LOS1_PLUS: _since_power_up,
    Event.LOS1_MINUS: _since_power_up,
    Event.LOS2_PLUS: _since_power_up,
    Event.LOS2_MINUS: _since_power_up,
    Event.OVERSPEED_WARNING: lambda detail: f"{detail} edges/s",
    Event.SAVED: lambda detail: f"record {detail}",
    Event.SAVE_FAILED: lambda detail: os.strerror(abs(detail)),
    Event.CAM_ACTIVATED: lambda detail: f"table version {detail}",
    Event.ROPE_LAID_STANDING: _turns,
    Event.ROPE_ACKNOWLEDGED: _turns,
    Event.ODOMETER_DOUBTFUL: lambda detail: f"{detail} edges counted meanwhile",
    Event.LOOK_PENDING: _look,
}


def read(device: Device) -> list[LogRecord]:
    """All events that are kept, newest last. The log may grow meanwhile: each record is whole."""
    return records(
        b"".join(read_raw(device, first) for first in range(0, RECORDS, RECORDS_PER_REQUEST))
    )


def read_raw(device: Device, first: int) -> bytes:
    """The places from this one on, as many as one request reads."""
    count = min(RECORDS_PER_REQUEST, RECORDS - first)
    return device.read_file(FILE_NUMBER, first * WORDS, count * WORDS)


def records(raw: bytes) -> list[LogRecord]:
    """What stands in these bytes, newest last."""
    found = (LogRecord(*fields) for fields in LAYOUT.iter_unpack(raw))
    return sorted((r for r in found if r.sequence), key=lambda record: record.sequence)
