# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C, and the signals that mean the same: a KeyboardInterrupt that nothing loses."""

import contextlib
import opcode
import signal
import sys
import threading
import time
from _thread import start_new_thread
from types import FrameType
from typing import Any

AGAIN_S = 0.01
# Python 3.13 leaves a while loop's jump back out of the `try` around the loop (its issue 130279).
_OUTSIDE = opcode.opmap["JUMP_BACKWARD"] if sys.version_info[:2] == (3, 13) else None

_only_first = False
_counted = False


def prepare() -> None:
    """For the whole program: whatever ends it ends it as Ctrl-C does, and is not lost."""
    global _only_first, _counted  # noqa: PLW0603 - signals are the process's
    _only_first = _counted = False
    if signal.getsignal(signal.SIGINT) == signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)
    signal.signal(signal.SIGTERM, _end)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:  # as nohup
        signal.signal(signal.SIGHUP, _end)
    sys.unraisablehook = _again


def only_the_first() -> None:
    """From now on a second one does not count: it would cut off the putting back."""
    global _only_first  # noqa: PLW0603
    _only_first = True


def is_behind(error: BaseException | None) -> bool:
    """Ctrl-C came first, and the error tells what it has cut off."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def _end(number: int, frame: FrameType | None) -> None:
    """So whatever a command has set in motion is stopped."""
    global _counted  # noqa: PLW0603
    if _only_first and _counted:
        return
    if frame is not None and frame.f_code.co_code[frame.f_lasti] == _OUTSIDE:
        _once_more()
        return
    _counted = True
    raise KeyboardInterrupt(signal.Signals(number).name)


def _again(dropped: Any) -> None:
    """The interpreter drops what is raised in a destructor or a callback: give it once more."""
    global _counted  # noqa: PLW0603
    if not issubclass(dropped.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(dropped)
        return
    _counted = False
    _once_more()


def _once_more() -> None:
    """By another thread and later: here it would be lost again."""
    with contextlib.suppress(RuntimeError):  # the interpreter is at its end
        start_new_thread(_interrupt, ())


def _interrupt() -> None:
    time.sleep(AGAIN_S)
    if hasattr(signal, "pthread_kill"):  # wakes what the main thread waits in
        main = threading.main_thread().ident
        assert main is not None, "it runs"
        signal.pthread_kill(main, signal.SIGINT)
    else:
        signal.raise_signal(signal.SIGINT)
