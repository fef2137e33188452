# SPDX-License-Identifier: Apache-2.0
"""The whole of a commissioning, at a terminal or a page: begun or gone on with, and how it ends."""

import contextlib
from pathlib import Path

from levelwind import whole_file
from levelwind.commission import guide, session
from levelwind.commission.bench import Bench
from levelwind.commission.human import StoppedError
from levelwind.errors import NoAnswerError, ToolError, UnknownOutcomeError

STATE = "commissioning.json"


def begin(folder: Path) -> session.Session:
    """A new one in a folder, which is made; ToolError where it cannot be."""
    whole_file.make_folder(folder)
    held = session.Session(folder / STATE, begun=session.now())
    held.save()
    return held


def run(bench: Bench) -> list[Path]:
    """What is left of it, then the report beside its state; the report's files.

    Whatever ends it before, the carriage stands. StoppedError: the person wants to go on another
    time; KeyboardInterrupt as it came; ToolError says what is wrong.
    """
    try:
        return _run(bench)
    except (StoppedError, KeyboardInterrupt):
        try:
            bench.rest()
        except KeyboardInterrupt:  # once more: it must not take the place of STOP
            bench.rest()
            raise
        raise


def _run(bench: Bench) -> list[Path]:
    try:
        guide.go_on(bench)
    except StoppedError:
        raise
    except ToolError as ended:
        with contextlib.suppress(ToolError):
            bench.rest()
        if isinstance(ended, NoAnswerError | UnknownOutcomeError):
            raise ToolError(
                f"{ended}\nA jog ends by itself, and an indexing at its switches. "
                f"{bench.human.to_go_on(bench.session.path)}"
            ) from None
        raise
    from levelwind.commission import report  # noqa: PLC0415 - matplotlib takes a second

    return report.write(bench.session, bench.session.path.parent)
