# SPDX-License-Identifier: Apache-2.0
"""Commands: guided commissioning, and its report."""

from pathlib import Path
from typing import Annotated

import typer

from levelwind.commission import dialogue, session
from levelwind.commission import verify as signed
from levelwind.commission.bench import Bench
from levelwind.commission.human import Answers, Human, StoppedError, Terminal
from levelwind.errors import ToolError
from levelwind.line.connection import with_device
from levelwind.line.device import Device
from levelwind.show.output import console

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
    human: Human = Answers(answers, device) if answers is not None else Terminal()
    if resume is not None:
        held = session.load(resume)
    else:
        path = folder / dialogue.STATE
        if path.exists():
            raise ToolError(
                f"{path} is there: go on with it by --resume {path}, or give another --report."
            )
        held = dialogue.begin(folder)
    try:
        paths = dialogue.run(Bench(device, human, held))
    except (StoppedError, KeyboardInterrupt) as stopped:
        word = "Stopped" if isinstance(stopped, KeyboardInterrupt) else str(stopped).rstrip(".")
        console.print(f"\n{word}. The carriage stands. {human.to_go_on(held.path)}")
        raise typer.Exit(130 if isinstance(stopped, KeyboardInterrupt) else 1) from None
    for path in paths:
        console.print(str(path))
    console.print(f"Accepted by {held.accepted_by}. The winch is indexed and follows the drum.")


@app.command()
@with_device
def verify(
    device: Device,
    file: Annotated[Path, typer.Argument(help="report.json, .html or .pdf.", metavar="FILE")],
) -> None:
    """Compare a report with the machine: firmware, image, parameters, signature."""
    document = signed.load(file)
    found = signed.differences(document, device)
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
    from levelwind.commission import report  # noqa: PLC0415 - matplotlib takes a second

    held = session.load(file)
    if not held.active:
        raise ToolError(f"{file}: no step is done yet.")
    for path in report.write(held, file.parent):
        console.print(str(path))
