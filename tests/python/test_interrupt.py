# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C ends a command wherever it comes: also in destructors and callbacks of Python."""

import signal
import subprocess
import sys
import textwrap

import pytest
from levelwind import interrupt
from levelwind.cli import EXIT_INTERRUPTED

# `Dropper()` is Ctrl-C in a destructor, `call_back()` in a callback: both drop what is raised.
BEGIN = """
import contextlib, signal, sys, time, weakref
from levelwind import cli, interrupt
from levelwind.commands import operate
from levelwind.errors import ToolError

class Dropper:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

class Thing:
    pass

def call_back():
    thing = Thing()
    reference = weakref.ref(thing, lambda _: signal.raise_signal(signal.SIGINT))
    del thing
"""

WATCH = """
readings = 0
def read(*_):
    global readings
    readings += 1
    if readings == 2:
        {what}
    if readings > 50:
        print("it goes on"); sys.exit(3)
operate.Device = lambda _: contextlib.nullcontext(None)
operate.read_status = operate.read_travel = lambda _: None
operate.Watching._read = read
operate.WATCH_PERIOD_S = 0.01
sys.argv = ["levelwind", "status", "--watch", "--port", "nowhere"]
cli.main()
"""

# What comes in the loop comes at its jump back, nearly always, where Python 3.13 forgets the `try`.
LOOP = """
interrupt.prepare()
{before}
{what}
try:
    end = time.monotonic() + 0.1
    while time.monotonic() < end:
        pass
    time.sleep(10)
    sys.exit(3)
except KeyboardInterrupt:
    {after}
    sys.exit(130)
"""


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(BEGIN + program)],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("what", ["Dropper()", "call_back()"])
def test_what_the_interpreter_drops_comes_again(what: str) -> None:
    done = run(LOOP.format(before="", what=what, after=""))
    assert done.returncode == EXIT_INTERRUPTED, done.stdout + done.stderr
    assert not done.stderr, "and nothing is said of it"


def test_where_only_the_first_counts_a_dropped_one_is_none() -> None:
    again = "signal.raise_signal(signal.SIGINT); signal.raise_signal(signal.SIGTERM)"
    done = run(LOOP.format(before="interrupt.only_the_first()", what="Dropper()", after=again))
    assert done.returncode == EXIT_INTERRUPTED, done.stdout + done.stderr


def test_it_wakes_what_waits() -> None:
    """For a process, as `levelwind demo --stay` does: without limit."""
    wait = "import subprocess\n    subprocess.run(['sleep', '8'])"
    program = LOOP.replace("end = time.monotonic() + 10", wait)
    done = run("began = time.monotonic()\n" + program.format(
        before="", what="Dropper()", after="assert time.monotonic() - began < 5"
    ))  # fmt: skip
    assert done.returncode == EXIT_INTERRUPTED, done.stdout + done.stderr


def test_other_errors_of_destructors_are_told() -> None:
    done = run("""
class Bad:
    def __del__(self):
        raise ValueError("bad destructor")
interrupt.prepare()
Bad()
""")
    assert "bad destructor" in done.stderr


@pytest.mark.parametrize(
    "what",
    [
        "Dropper()",
        # In the middle of a request whose end fails, too: the error hides it.
        "try: signal.raise_signal(signal.SIGINT)\n        finally: raise ToolError('lost')",
    ],
)
def test_watching_ends(what: str) -> None:
    done = run(WATCH.format(what=what))
    assert done.returncode == EXIT_INTERRUPTED, done.stdout + done.stderr


def test_a_program_that_shall_not_hear_it_does_not() -> None:
    """Started in the background by a shell without jobs: Ctrl-C is for another."""
    done = run("""
signal.signal(signal.SIGINT, signal.SIG_IGN)
interrupt.prepare()
assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
""")
    assert done.returncode == 0, done.stderr


def test_a_system_without_hang_up_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows."""
    monkeypatch.delattr(signal, "SIGHUP")
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    try:
        interrupt.prepare()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
