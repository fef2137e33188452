# SPDX-License-Identifier: Apache-2.0
"""The command that puts a slave, whichever it is, through the Modbus standards."""

import statistics
from collections import Counter
from typing import Annotated

import typer

from levelwind import interrupt
from levelwind.conformance import framing, others, reads, writes  # noqa: F401 - they hold the cases
from levelwind.conformance.line import SerialLine
from levelwind.conformance.slave import Slave
from levelwind.conformance.suite import Outcome, Verdict, all_cases, run
from levelwind.conformance.survey import SPACES, Found, survey
from levelwind.errors import ToolError
from levelwind.line.connection import Json, with_line
from levelwind.line.port import Line
from levelwind.show.output import console, print_json, print_table

Address = Annotated[int | None, typer.Option(min=0, max=65535, metavar="ADDRESS")]


@with_line
def conformance(
    line: Line,
    coil: Address = None,
    discrete_input: Address = None,
    holding_register: Address = None,
    input_register: Address = None,
    scratch_register: Annotated[
        int | None,
        typer.Option(
            min=0, max=65535, metavar="ADDRESS", help="Holding register that may be changed."
        ),
    ] = None,
    read_only: Annotated[
        bool, typer.Option("--read-only", help="Leave out every case that writes.")
    ] = False,
    only: Annotated[
        str, typer.Option("--case", help="Only cases whose name contains this.", metavar="TEXT")
    ] = "",
    json_output: Json = False,
) -> None:
    """Put any Modbus RTU slave through the standard, case by case. Exit status 1 if one fails.

    It asks for what the slave has; --coil, --discrete-input, --holding-register and
    --input-register say where to look first. Whatever is written is put back, also on Ctrl-C.
    Unknown function codes and broken frames are sent, and counters are cleared: not for a machine
    at work.
    """
    if read_only and scratch_register is not None:
        raise ToolError("--read-only and --scratch-register exclude each other.")
    cases = [case for case in all_cases() if only in case.name]
    if not cases:
        raise ToolError(f"--case {only}: no case's name contains this.")
    hints = {1: coil, 2: discrete_input, 3: holding_register, 4: input_register}
    port = SerialLine(line)
    try:
        interrupt.only_the_first()
        slave = Slave(port, line.unit, line.timeout_s)
        found = survey(
            slave,
            {function: hint for function, hint in hints.items() if hint is not None},
            may_write=not read_only,
            scratch=scratch_register,
        )
        outcomes = run(slave, found, cases)
    finally:
        port.close()
    if json_output:
        print_json({"slave": _facts(slave, found), "cases": [_case(o) for o in outcomes]})
    else:
        print_table(("", ""), _facts(slave, found).items())
        print_table(
            ("case", "standard", "result", "what"),
            [(o.name, o.section, o.verdict.value, o.detail) for o in outcomes],
        )
        counts = Counter(o.verdict for o in outcomes)
        console.print(", ".join(f"{counts[v]} {v.value}" for v in Verdict))
    if any(o.verdict == Verdict.FAIL for o in outcomes):
        raise typer.Exit(1)


def _case(outcome: Outcome) -> dict[str, str]:
    return {
        "name": outcome.name,
        "standard": outcome.section,
        "result": outcome.verdict.value,
        "detail": outcome.detail,
    }


def _facts(slave: Slave, found: Found) -> dict[str, str]:
    milliseconds = [1000 * latency for latency in slave.latencies_s]
    areas = {
        SPACES[function]: f"{area.count} from {area.first}"
        for function, area in found.areas.items()
    }
    return {
        "functions": ", ".join(f"{code:02d}" for code in sorted(found.functions)),
        **areas,
        "answers after": f"{statistics.median(milliseconds):.1f} ms (median), "
        f"{max(milliseconds):.1f} ms (slowest of {len(milliseconds)})",
    }
