# SPDX-License-Identifier: Apache-2.0
"""`./dev board --injections`: all operations, each interrupted at every instruction, on all cores.

LEVELWIND_INJECTION_STRIDE in the environment takes one instruction in so many.

What an operation is interrupted by, and the walk through it, for test_injection.py, too.
"""

import multiprocessing
import os
import re
import time
from collections.abc import Callable
from typing import NamedTuple

from levelwind.show.output import console, print_table

from board.injection import STRIDE, Injector, TornError, Walk, contact, edge, timer_edge
from board.machine import Board
from board.operations import OPERATIONS

EVERY = int(os.environ.get("LEVELWIND_INJECTION_STRIDE", "1"))
LEAVES_OUT = "timer"  # an edge of the edge timer may be left out: the carriage waits a moment
PLACES_MIN = 5  # fewer are no operation


def interrupts(name: str) -> dict[str, Callable[[Board], None]]:
    """What is injected into an operation."""
    operation = OPERATIONS[name]
    found = {"edge": edge, "switch": contact(operation.side)}
    return found | ({"timer": timer_edge} if operation.timer else {})


def walk(name: str, interrupt: str, stride: int = STRIDE) -> Walk:
    """Inject an interrupt into an operation, before one instruction in every `stride`."""
    operation = OPERATIONS[name]
    board = operation.prepare()
    board.run_to_sleep()  # so that something is done wholly before what begins now
    operation.begin(board)
    return Injector(board).walk(interrupts(name)[interrupt], operation.window_s, stride)


def check(done: Walk, interrupt: str) -> None:
    """Raises TornError where an outcome is neither that of before nor that of after."""
    done.check(may_be_left_out=interrupt == LEAVES_OUT)
    asleep = sum(place.asleep for place in done.places)
    assert asleep >= 2, "nothing to compare with"
    assert len(done.places) - asleep > PLACES_MIN, "nothing was under way"


class Row(NamedTuple):
    """One operation with one interrupt."""

    operation: str
    interrupt: str
    injections: int
    outcomes: int
    torn: str  # where, and what; empty if nothing


def judge(name: str) -> list[Row]:
    """All interrupts of an operation, at every instruction, or one in so many."""
    rows = []
    for interrupt in interrupts(name):
        done = walk(name, interrupt, EVERY)
        torn = ""
        try:
            check(done, interrupt)
        except TornError as error:
            torn = str(error)
        rows.append(Row(name, interrupt, len(done.places), done.outcomes, torn))
    return rows


def main(pattern: str) -> int:
    """Those operations whose name matches; told one by one, and the sums at the end."""
    names = [name for name in OPERATIONS if re.search(pattern, name)]
    if not names:
        console.print(f"no operation matches {pattern!r}; there are: {', '.join(OPERATIONS)}")
        return 1
    began = time.monotonic()
    rows: list[Row] = []
    processes = min(len(names), os.cpu_count() or 1)
    with multiprocessing.Pool(processes) as pool:
        for found in pool.imap_unordered(judge, names, chunksize=1):
            rows += found
            for row in found:
                verdict = f"TORN {row.torn}" if row.torn else "whole"
                console.print(
                    f"{row.operation} / {row.interrupt}: {row.injections} injections, {verdict}",
                    markup=False,
                    highlight=False,
                )
    rows.sort(key=lambda row: names.index(row.operation))
    kinds = {row.interrupt: None for row in rows}
    table = []
    for name in names:
        of_name = {row.interrupt: row for row in rows if row.operation == name}
        counts = [str(of_name[kind].injections) if kind in of_name else "" for kind in kinds]
        torn = sum(bool(row.torn) for row in of_name.values())
        table.append((name, *counts, f"{torn} TORN" if torn else "whole"))
    print_table(("operation", *kinds, "outcome"), table)
    torn = sum(bool(row.torn) for row in rows)
    console.print(
        f"{sum(row.injections for row in rows)} injections, {torn} of {len(rows)} torn, "
        f"{(time.monotonic() - began) / 60:.0f} minutes"
    )
    return int(torn > 0)
