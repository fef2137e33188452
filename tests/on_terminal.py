# SPDX-License-Identifier: Apache-2.0
"""A command as a terminal shows it, of any width and any letters."""

import fcntl
import os
import pty
import re
import struct
import termios
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
TERMINALS = {
    "latin-1, 80 columns": (80, {"PYTHONIOENCODING": "latin-1"}),
    "ascii, 40 columns": (40, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
}


def leaves(command: object, path: str = "") -> Iterator[str]:
    """The commands, with those of groups inside."""
    for name, inner in getattr(command, "commands", {}).items():
        here = f"{path} {name}".strip()
        if getattr(inner, "commands", None):
            yield from leaves(inner, here)
        else:
            yield here


def on_a_terminal(
    line: list[str], columns: int, env: dict[str, str], ctrl_c_at: bytes | None = None
) -> tuple[int, str]:
    """Exit status, and what a terminal of this width shows; Ctrl-C where it shows `ctrl_c_at`."""
    process, terminal = pty.fork()
    if process == 0:
        fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        os.chdir(ROOT)
        os.execvpe(line[0], line, env)
    shown = b""
    while True:
        try:
            more = os.read(terminal, 65536)
        except OSError:  # the other end is closed
            break
        if not more:
            break
        if ctrl_c_at is not None and ctrl_c_at in more:
            os.write(terminal, b"\x03")
        shown += more
    os.close(terminal)
    _, status = os.waitpid(process, 0)
    encoding = env.get("PYTHONIOENCODING", "ascii")
    return os.waitstatus_to_exitcode(status), shown.decode(encoding)


def words(text: str, *, digits: bool) -> set[str]:
    """What must not be cut. Words, and digits where they are the same in every run."""
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)
    form = r"[\w./+=-]*\w" if digits else r"[A-Za-z_]{3,}"
    return set(re.findall(form, text))
