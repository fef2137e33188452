# SPDX-License-Identifier: Apache-2.0
"""Step 8: the serial line, while the stepper runs beside it."""

import contextlib
import statistics
import time

from levelwind.commission.bench import Bench, wrong
from levelwind.commission.session import Result
from levelwind.errors import NoAnswerError, RefusedError
from levelwind.line.live import flag
from levelwind.map_table import Command, Flag

REQUESTS = 1000
ERRORS_MAX = 2
SLOW_S = 0.25
COUNTERS = ("crc_errors", "line_babbles", "line_echoes", "late_requests", "foreign_answers")
CABLE = (
    "Termination at both ends, the pair's screen and polarity, a ground beside it; away from the "
    "stepper's cable; a lower baud rate."
)


def run(bench: Bench, result: Result) -> None:
    """So many readings while indexings run."""
    device = bench.device
    bench.current_on()
    before = device.read_names(*COUNTERS)
    took: list[float] = []
    lost = 0
    timeout_s = device.line.timeout_s
    try:
        for _ in range(REQUESTS):
            began = time.monotonic()
            try:
                live = bench.live()
            except NoAnswerError:
                lost += 1
                continue
            elapsed = time.monotonic() - began
            if elapsed >= timeout_s:
                lost += 1  # asked for again
            else:
                took.append(elapsed)
            if not flag(live, Flag.MOVING):
                with contextlib.suppress(RefusedError):
                    device.write({"command": int(Command.INDEX)})
    finally:
        bench.rest()
    after = device.read_names(*COUNTERS)
    grown = {name: after[name] - before[name] for name in COUNTERS}
    took.sort()
    result.measured["requests while the stepper ran"] = REQUESTS
    if took:
        result.measured["answer in, ms: median, 99 %, at most"] = ", ".join(
            f"{1000 * t:.1f}" for t in
            (statistics.median(took), took[int(0.99 * len(took))], took[-1])
        )  # fmt: skip
        result.series["latency_ms"] = [round(1000 * t, 2) for t in took]
    result.measured["answers lost"] = lost
    for name, count in grown.items():
        result.measured[name] = count
    if lost > ERRORS_MAX or grown["crc_errors"] > ERRORS_MAX:
        raise wrong(
            "line.noise",
            f"Of {REQUESTS} requests {lost} had no answer, {grown['crc_errors']} reached the "
            "controller damaged.",
            CABLE,
        )
    if grown["foreign_answers"]:
        raise wrong(
            "line.two_units",
            f"{grown['foreign_answers']} answers of another device with this unit id were seen.",
            "Two devices have the same unit id: `levelwind line --new-unit`.",
        )
    if statistics.median(took) > SLOW_S:
        raise wrong(
            "line.slow",
            f"An answer takes {1000 * statistics.median(took):.0f} ms.",
            "An adapter that waits (latency timer 16 ms) or a slow gateway: set its timer to 1 ms.",
        )
