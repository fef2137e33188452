# SPDX-License-Identifier: Apache-2.0
"""`status --watch` ends by Ctrl-C wherever that comes."""

import contextlib
import signal

import pytest
from levelwind.commands import operate
from levelwind.errors import ToolError
from levelwind.line.port import Line


@pytest.mark.parametrize("error", [None, ToolError("lost")])
def test_an_interrupt_that_is_dropped_ends_watching(
    monkeypatch: pytest.MonkeyPatch, error: ToolError | None
) -> None:
    readings = 0

    def read(*_: object) -> None:
        nonlocal readings
        readings += 1
        assert readings < 3, "it goes on"
        with contextlib.suppress(KeyboardInterrupt):  # as the interpreter in a destructor
            signal.raise_signal(signal.SIGINT)
        if error is not None:
            raise error

    monkeypatch.setattr(operate, "Device", lambda _: contextlib.nullcontext())
    monkeypatch.setattr(operate, "read_travel", lambda _: None)
    before = signal.getsignal(signal.SIGINT)
    watching = operate.Watching(Line("nowhere"))
    monkeypatch.setattr(watching, "_read", read)
    try:
        with pytest.raises(KeyboardInterrupt):
            watching.run(lambda: None)
    finally:
        signal.signal(signal.SIGINT, before)
