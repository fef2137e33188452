# SPDX-License-Identifier: Apache-2.0
"""Standard output and error as they are: another encoding, a full disk, a reader that has gone."""

import codecs
import contextlib
import errno
import os
import sys
import unicodedata
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

PLAIN = "levelwind-plain"
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EPIPE)  # all files are told by their names
# One character for one, or columns would move. Boxes and spinners of rich among them.
_PLAIN = {
    ord(character): plain
    for plain, characters in {
        "-": "━─╸╺═–—−‐",  # noqa: RUF001
        "|": "│┃║▏▕",
        "+": "╭╮╰╯┌┐└┘┏┓┗┛├┤┬┴┼",
        "#": "█▉▊▋▌▍▎",
        ".": "…",
        "'": "‘’‚",  # noqa: RUF001
        '"': "“”„",
        "u": "µμ",
        "x": "×",  # noqa: RUF001
        "*": "•⠋⠙⠹⠸⠼⠴⠦⠧⠇⠏",
    }.items()
    for character in characters
}


def _replace(error: UnicodeError) -> tuple[str | bytes, int]:
    """What this terminal cannot show, in plain characters; a file name's own bytes as they are."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    character = error.object[error.start]
    if "\udc80" <= character <= "\udcff":
        return bytes([ord(character) - 0xDC00]), error.start + 1
    plain = character.translate(_PLAIN)
    if not plain.isascii():
        plain = unicodedata.normalize("NFKD", character)[0]
    return plain if plain.isascii() else "?", error.start + 1


def prepare() -> None:
    """Let nothing that is printed end a command half-way."""
    codecs.register_error(PLAIN, _replace)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the shell
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
        getattr(sys, name).reconfigure(errors=PLAIN)


def say(text: str) -> None:
    """A line on standard error, if that can be written at all."""
    with contextlib.suppress(OSError, ValueError):
        print(text, file=sys.stderr, flush=True)


def run(command: Callable[[], None]) -> None:
    """Run a command to its exit. What it printed and could not be written is one message."""
    try:
        try:
            command()
        finally:
            sys.stdout.flush()
    except OSError as error:
        _drop_what_cannot_be_written(sys.stdout)
        if error.errno not in _FULL:
            say(f"levelwind: {error}")
        elif error.errno != errno.EPIPE:  # else `| head` has read enough
            say(
                f"levelwind: the output cannot be written: {error.strerror}. "
                "What the command does may be done all the same."
            )
        sys.exit(1)
    finally:
        _drop_what_cannot_be_written(sys.stderr)


def _drop_what_cannot_be_written(stream: TextIO) -> None:
    """At its end the interpreter would try it once more, and tell that in its own words."""
    try:
        stream.flush()
    except (OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
