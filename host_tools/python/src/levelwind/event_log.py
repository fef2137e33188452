"""The event log of a controller: file 1 of FC20, one fixed-size record for each event."""

import struct
from dataclasses import dataclass

from levelwind.device import Device
from levelwind.map_table import DETAIL_ENUMS, Event, State
from levelwind.points import enum_label

FILE_NUMBER = 1
RECORDS = 64
# Sequence, power-up, time, event, state, detail, position, net edges: lw/log.h.
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
    def detail_name(self) -> str:
        """The detail by its name where the map has one, else the number."""
        names = DETAIL_ENUMS.get(Event(self.event)) if self.event in list(Event) else None
        return enum_label(names, self.detail) if names else str(self.detail)


def read(device: Device) -> list[LogRecord]:
    """All events that are kept, newest last. The log may grow meanwhile: each record is whole."""
    raw = b"".join(
        device.read_file(
            FILE_NUMBER, first * WORDS, min(RECORDS_PER_REQUEST, RECORDS - first) * WORDS
        )
        for first in range(0, RECORDS, RECORDS_PER_REQUEST)
    )
    records = (LogRecord(*fields) for fields in LAYOUT.iter_unpack(raw))
    return sorted((r for r in records if r.sequence), key=lambda record: record.sequence)
