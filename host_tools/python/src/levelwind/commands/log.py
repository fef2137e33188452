# SPDX-License-Identifier: Apache-2.0
"""The command that shows the event log."""

import dataclasses
from typing import Annotated

import typer

from levelwind.line import event_log
from levelwind.line.connection import Json, with_device
from levelwind.line.device import Device
from levelwind.show.output import console, print_json, print_table

COUNTERS = ("boots", "watchdog_resets", "powered_s", "tracking_s", "log_unsaved")
SECONDS_PER_HOUR = 3600


@with_device
def log(
    device: Device,
    last: Annotated[
        int | None, typer.Option("--last", help="Only so many.", min=1, max=event_log.RECORDS)
    ] = None,
    json_output: Json = False,
) -> None:
    """Show what happened, newest last, also before the last power-up; and the hours."""
    records = event_log.read(device)[-(last or event_log.RECORDS) :]
    counters = device.read_names(*COUNTERS)
    if json_output:
        events = [
            dataclasses.asdict(record)
            | {"event": record.event_name, "state": record.state_name, "detail": record.detail_name}
            for record in records
        ]
        print_json({"counters": counters, "events": events})
        return
    print_table(
        ("no.>", "power-up>", "s>", "event", "detail", "mm>", "edges>", "state"),
        [
            (
                str(record.sequence),
                str(record.boot),
                f"{record.time_ms / 1000:.1f}",
                record.event_text,
                record.detail_text,
                f"{record.position_um / 1000:+.2f}",
                f"{record.net_edges:+d}",
                record.state_name,
            )
            for record in records
        ],
    )
    console.print(
        f"{counters['boots']} power-ups, {counters['watchdog_resets']} of them by the watchdog; "
        f"{counters['powered_s'] / SECONDS_PER_HOUR:.1f} h under power, "
        f"{counters['tracking_s'] / SECONDS_PER_HOUR:.1f} h tracking; "
        f"{counters['log_unsaved']} events not stored yet."
    )
