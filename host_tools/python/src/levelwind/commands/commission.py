# SPDX-License-Identifier: Apache-2.0
"""Commands: guided commissioning, and its report."""

import contextlib
from pathlib import Path
from typing import Annotated

import typer

from levelwind.commission import guide, report, session
from levelwind.commission.bench import Bench
from levelwind.commission.human import Answers, StoppedError, Terminal
from levelwind.errors import NoAnswerError, ToolError, UnknownOutcomeError
from levelwind.line.connection import with_device
from levelwind.line.device import Device
from levelwind.show.output import console

STATE = "commissioning.json"

app = typer.Typer(no_args_is_help=True, help="The report of a commissioning.")


@with_device
def commission(
    device: Device,
    resume: Annotated[
        Path | None, typer.Option(help="Go on with this file, kept by an earlier run.")
    ] = None,
    folder: Annotated[
        Path, typer.Option("--report", help="Where report and state are written.")
    ] = Path("commissioning"),
    answers: Annotated[
        Path | None, typer.Option(help="A file that plays the person, for CI and rehearsals.")
    ] = None,
) -> None:
    """Set a winch up by a dialogue that measures, proposes, explains and signs."""
    human = Answers(answers, device) if answers is not None else Terminal()
    if resume is not None:
        held = session.load(resume)
        folder = resume.parent
    else:
        path = folder / STATE
        if path.exists():
            raise ToolError(
                f"{path} is there: go on with it by --resume {path}, or give another --report."
            )
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ToolError(f"{folder} cannot be made: {error.strerror}.") from error
        held = session.Session(path, begun=session.now())
        held.save()
    bench = Bench(device, human, held)
    try:
        guide.go_on(bench)
    except (StoppedError, KeyboardInterrupt) as stopped:
        bench.rest()
        word = "Stopped" if isinstance(stopped, KeyboardInterrupt) else str(stopped).rstrip(".")
        console.print(f"\n{word}. The carriage stands. {_go_on(held)}")
        raise typer.Exit(130 if isinstance(stopped, KeyboardInterrupt) else 1) from None
    except (NoAnswerError, UnknownOutcomeError) as lost:
        with contextlib.suppress(ToolError):
            bench.rest()
        raise ToolError(
            f"{lost}\nA jog ends by itself, and an indexing at its switches. {_go_on(held)}"
        ) from None
    for path in report.write(held, folder):
        console.print(str(path))
    console.print(f"Accepted by {held.accepted_by}. The winch is indexed and follows the drum.")


def _go_on(held: session.Session) -> str:
    return f"Go on with: levelwind commission --resume {held.path}"


@app.command()
@with_device
def verify(
    device: Device,
    file: Annotated[Path, typer.Argument(help="report.json, .html or .pdf.", metavar="FILE")],
) -> None:
    """Compare a report with the machine: firmware, image, parameters, signature."""
    document = report.load(file)
    found = report.differences(document, device)
    if found:
        raise ToolError(
            f"{file} is not of this machine as it is now:\n" + "\n".join(f"- {d}" for d in found)
        )
    console.print(
        f"{file}: accepted by {document['accepted_by']}, {document['accepted_at']}; firmware, "
        "image and parameters of the machine are those of the report."
    )


@app.command()
def write(
    file: Annotated[Path, typer.Argument(help="commissioning.json.", metavar="FILE")],
) -> None:
    """Write the report anew, also of a commissioning that is not finished."""
    held = session.load(file)
    if not held.active:
        raise ToolError(f"{file}: no step is done yet.")
    for path in report.write(held, file.parent):
        console.print(str(path))
