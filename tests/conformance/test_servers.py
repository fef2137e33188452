# SPDX-License-Identifier: Apache-2.0
"""Other people's servers: what they do otherwise than the standard, found and listed.

The lists show that the suite tells right from wrong, and what an integrator may meet. They hold for
pymodbus 3.16 and libmodbus 3.1.6.
"""

import ctypes
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pymodbus
import pytest
from conformance.server import SCRATCH, UNIT, libmodbus
from levelwind.conformance import framing, others, reads, writes  # noqa: F401 - they hold the cases
from levelwind.conformance.line import SerialLine
from levelwind.conformance.slave import Slave
from levelwind.conformance.suite import Outcome, Verdict, all_cases, run
from levelwind.conformance.survey import survey
from levelwind.line.port import Line
from slave import NullModem

SERVER = Path(__file__).with_name("server.py")
SERVERS = ("pymodbus", "libmodbus")
QUICK_S = 0.25
PATIENT_S = 0.6
READS = ("FC01", "FC02", "FC03", "FC04")

KNOWN_VERSIONS = {"pymodbus": "3.16.1", "libmodbus": "3.1.6"}
EXPECTED = {
    "pymodbus": {
        # Bytes of a broken frame stay in its buffer and spoil the next request; there are no
        # pauses; requests that it cannot decode get an exception with the function code 0x80.
        Verdict.FAIL: {
            *(f"{f}: count {name}" for f in READS for name in ("0", "above the limit")),
            "FC05: a value that is neither on nor off",
            "FC08/04: listen only mode, ended by 01",
            "FC08: counters",
            "FC08: wrong lengths",
            "FC15: count 0",
            "FC15: count above the limit",
            "FC20: byte count",
            "FC20: reference type, file and record",
            "FC21: byte count",
            "FC21: reference type, file and record",
            "FC23: a refused reading writes nothing",
            "FC23: counts 0 and above the limit",
            "FC43/14: basic objects",
            "FC43/14: regular and extended objects",
            "frame: a write to another unit changes nothing",
            "frame: every beginning of a request",
            "frame: other units",
            "frame: shorter than 4 bytes",
            "noise: a request after it",
            "pause: half a frame, then a whole one",
            "unknown functions with 252 bytes of data",
        },
        Verdict.DEVIATION: {
            *(f"{f}: one byte too few and too many" for f in (*READS, "FC22")),
            "FC08: unknown sub-functions",
            "FC08: wrong data field",
            "FC15: data shorter and longer than its byte count",
            "FC16: count above the limit",
            "FC16: data shorter and longer than its byte count",
            "FC17: with data",
            "FC43/14: a stream from an unknown object begins anew",
            "FC43: wrong codes and lengths",
            "frame: 256 bytes",
            "noise: joined to a request",
            "pause: a long one cuts a frame in two",
            "unknown functions",
            "unknown functions without data",
        },
    },
    "libmodbus": {
        # It takes a function that it does not know for one without data, misses the CRC and stays
        # silent: FC08, FC20, FC21, FC43. A wrong length is a wrong CRC to it.
        Verdict.FAIL: {"FC15: byte count that does not fit", "noise: joined to a request"},
        Verdict.DEVIATION: {
            *(f"{f}: one byte too few and too many" for f in (*READS, "FC22")),
            "FC15: data shorter and longer than its byte count",
            "FC16: count above the limit",
            "FC16: data shorter and longer than its byte count",
            "FC17: with data",
            "FC23: counts 0 and above the limit",
            "unknown functions",
            "unknown functions with 252 bytes of data",
            "unsupported public functions",
        },
    },
}


def examine(server: str, timeout_s: float) -> list[Outcome]:
    line = NullModem()
    process = subprocess.Popen(
        [sys.executable, str(SERVER), server, str(line.firmware_end)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        slave = Slave(SerialLine(Line(str(line.port))), UNIT, timeout_s)
        return run(slave, survey(slave, {}, scratch=SCRATCH), all_cases())
    finally:
        process.kill()
        process.wait()
        line.close()


def version(server: str) -> str:
    if server == "pymodbus":
        return pymodbus.__version__
    library = libmodbus()
    parts = ("major", "minor", "micro")
    return ".".join(
        str(ctypes.c_uint.in_dll(library, f"libmodbus_version_{part}").value) for part in parts
    )


def verdicts(outcomes: list[Outcome]) -> dict[Verdict, set[str]]:
    return {
        verdict: {o.name for o in outcomes if o.verdict == verdict}
        for verdict in (Verdict.FAIL, Verdict.DEVIATION)
    }


@pytest.fixture(scope="module")
def quick() -> dict[str, list[Outcome]]:
    """Both at the same time: most of it is waiting for what does not come."""
    with ThreadPoolExecutor() as pool:
        found = pool.map(lambda server: examine(server, QUICK_S), SERVERS)
        return dict(zip(SERVERS, found, strict=True))


@pytest.mark.parametrize("server", SERVERS)
def test_server(quick: dict[str, list[Outcome]], server: str) -> None:
    outcomes = quick[server]
    if version(server) != KNOWN_VERSIONS[server]:
        passed = {o.name for o in outcomes if o.verdict == Verdict.PASS}
        assert {f"{f}: every count that fits" for f in READS} <= passed
        pytest.skip(f"the list is for {server} {KNOWN_VERSIONS[server]}, not {version(server)}")
    if verdicts(outcomes) != EXPECTED[server]:  # this machine may have been busy
        outcomes = examine(server, PATIENT_S)
    details = [f"{o.name}: {o.verdict.value} {o.detail}" for o in outcomes]
    assert verdicts(outcomes) == EXPECTED[server], "\n".join(details)


def test_libmodbus_is_silent(quick: dict[str, list[Outcome]]) -> None:
    detail = next(o.detail for o in quick["libmodbus"] if o.name == "unsupported public functions")
    assert {"FC08", "FC20", "FC43"} <= {word.rstrip(",") for word in detail.split()}
