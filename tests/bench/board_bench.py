# SPDX-License-Identifier: Apache-2.0
"""What the Nucleo's image costs on the emulated board, for bench.py."""

from board.machine import IRQ0, available
from board.ready import indexed
from budgets import EDGE_TO_PULSE_MAX_US, LOAD_MAX_PERCENT
from figure import Figure

TOP_EDGES_PER_S = 48_000
POLLS = 50
SECONDS = 2.0  # some double traverses: the share of the reversals is that of any launch
ENCODER = IRQ0 + 28
CYCLES_PERMILLE = (1000, 1300)
PER_EDGE_MAX = 90
# The image before the timer counted the edges: by GPIO, the first at 96 MHz, the last at 168.
BEFORE_INTERRUPT = {1000: 238, 1300: 238}
BEFORE_PER_EDGE = {1000: 425, 1300: 425}
BEFORE_LOAD_PERCENT = {1000: 33, 1300: 41}
BEFORE_EDGE_TO_PULSE_US = {1000: 13.2, 1300: None}


def measure() -> list[Figure]:
    """At full speed, polled without a pause."""
    if available():
        return []
    rows = []
    for permille in CYCLES_PERMILLE:
        board = indexed(baud=115_200, cycles_permille=permille)
        board.drum(TOP_EDGES_PER_S, 480_000)
        board.run(0.2)
        board.clear_seen()
        until_ns = board.now_ns + round(SECONDS * 1e9)
        while board.now_ns < until_ns:
            board.read("state", "flags", "m")
        cpi = f"CPI {permille / 1000:.1f}"
        options = f"{TOP_EDGES_PER_S} edges/s, {permille / 1000:g} cycles an instruction"
        cost, load = board.costs()[ENCODER], 100 * board.load
        per_edge = cost.count * cost.avg / abs(board.seen.edges)
        late_us = board.seen.edge_to_step_max_ns / 1000
        for name, figures, unit, before, limit in (
            (
                "encoder's interrupt",
                (cost.min, cost.avg, cost.max),
                "instructions",
                BEFORE_INTERRUPT,
                None,
            ),
            (
                "encoder's interrupts, by edge",
                (per_edge,) * 3,
                "instructions",
                BEFORE_PER_EDGE,
                PER_EDGE_MAX,
            ),
            (
                "edge to its pulse, at worst",
                (late_us,) * 3,
                "us",
                BEFORE_EDGE_TO_PULSE_US,
                EDGE_TO_PULSE_MAX_US,
            ),
            ("processor's load", (load,) * 3, "%", BEFORE_LOAD_PERCENT, LOAD_MAX_PERCENT),
        ):
            limits = {} if limit is None else {"avg_max": limit}
            of_image = (unit, before[permille], limits, True)
            rows.append(
                Figure(f"board, {cpi}: {name}", "nucleo_f446re", options, *figures, *of_image)
            )
    return rows
