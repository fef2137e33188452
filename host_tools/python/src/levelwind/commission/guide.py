# SPDX-License-Identifier: Apache-2.0
"""The steps, one after the other: told, run, kept, and at the end signed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from levelwind.commission import (
    contacts,
    encoder,
    geometry,
    line,
    others,
    pull_out,
    repeat,
    stepper,
)
from levelwind.commission.bench import Bench, WrongError
from levelwind.commission.human import Heard, StoppedError
from levelwind.commission.session import Finding, Result, now
from levelwind.errors import ToolError
from levelwind.line.parameter_sets import replace_set
from levelwind.map_table import Command

CARRIAGE = "THE CARRIAGE"


@dataclass(frozen=True)
class Step:
    """One step of the dialogue."""

    name: str
    title: str
    does: str
    moves: str
    back: str
    run: Callable[[Bench, Result], None]
    may_be_left_out: bool = False


STEPS = (
    Step(
        "identify",
        "Identity",
        "Reads version, image and parameters, and writes a backup before anything is changed.",
        "Nothing.",
        "`levelwind restore before.yaml`.",
        others.identify,
    ),
    Step(
        "contacts",
        "Switches",
        "You press every switch by hand; both states and both wires of each are looked at.",
        "Nothing by itself: the stepper has no current. You push the carriage.",
        "Nothing is changed but how the switches are wired (`switch_contacts`).",
        contacts.run,
    ),
    Step(
        "encoder",
        "Encoder",
        "You turn the drum by hand, to a mark: pulses, ratio, direction, both channels.",
        "Nothing by itself: the stepper has no current. You turn the drum.",
        "Repeat the step; its values replace those before.",
        encoder.run,
    ),
    Step(
        "stepper",
        "Stepper and screw",
        "Small jogs to a mark that you measure: direction, microsteps, lead.",
        "THE CARRIAGE, a few millimetres, then 25 mm, from the middle.",
        "Repeat the step; its values replace those before.",
        stepper.run,
    ),
    Step(
        "geometry",
        "Geometry",
        "Runs to both switches, measures the way between, proposes where reversals and flanges "
        "are.",
        "THE CARRIAGE, to both switches, slowly; then it indexes.",
        "Repeat the step; its values replace those before.",
        geometry.run,
    ),
    Step(
        "repeat",
        "Repeatability",
        "Indexes again and again, then at several rates: scatter, drift, the switches' delay.",
        "THE CARRIAGE, between both switches.",
        "Repeat the step; its values replace those before.",
        repeat.run,
    ),
    Step(
        "pull_out",
        "Pull-out",
        "Jogs faster and faster in the middle of the way, until the stepper falls out of step.",
        "THE CARRIAGE, FAST, in the middle of its way. It hums or rattles when it falls out of "
        "step.",
        "Repeat the step; its values replace those before.",
        pull_out.run,
        may_be_left_out=True,
    ),
    Step(
        "line",
        "Line",
        "A thousand requests while the stepper runs: latency, errors.",
        "THE CARRIAGE, between both switches.",
        "Nothing is changed.",
        line.run,
        may_be_left_out=True,
    ),
    Step(
        "rope",
        "First rope",
        "Indexes as for a launch; you wind rope, look at it and trim the reversals.",
        "THE CARRIAGE, with the drum.",
        "`levelwind stop`; a trim goes back to 0.",
        others.first_rope,
    ),
)


def moves(step: Step, stop_key: str) -> str:
    """What will move in a step, and what stops it."""
    stops = f" {stop_key} stops it." if step.moves.startswith(CARRIAGE) else ""
    return step.moves + stops


def go_on(bench: Bench) -> None:
    """All steps that are not done yet, then the signature. ToolError where it must end before."""
    session, human = bench.session, bench.human
    _restore(bench)
    for number, step in enumerate(STEPS, 1):
        if session.results.get(step.name, Result()).done:
            at = session.results[step.name].at
            human.say(f"{number} of {len(STEPS)}  {step.title}: done {at}")
            continue
        _step(bench, number, step)
    _accept(bench)


def _restore(bench: Bench) -> None:
    """What the steps before have set may have gone with the power."""
    session = bench.session
    if not session.active:
        return
    active = bench.active()
    differs = {name: value for name, value in session.active.items() if active.get(name) != value}
    if differs:
        bench.rest()
        replace_set(bench.device, differs)
        bench.human.say(
            f"{len(differs)} parameters were not as the last step has left them (the controller "
            "was off, or somebody has changed them): put back."
        )


def _step(bench: Bench, number: int, step: Step) -> None:
    """One step, until it succeeds, is left out, or somebody stops."""
    human, session = bench.human, bench.session
    human.say(
        f"\n{number} of {len(STEPS)}  {step.title.upper()}\n"
        f"  What it does    {step.does}\n"
        f"  What will move  {moves(step, human.stop_key)}\n"
        f"  The way back    {step.back}"
    )
    choices = ("g", "l", "s") if step.may_be_left_out else ("g", "s")
    words = f"g: go, {'l: leave it out, ' if step.may_be_left_out else ''}s: stop here"
    while True:
        chosen = human.choose(f"{step.name}.begin", f"{words}?", choices, "g")
        if chosen == "s":
            raise StoppedError("Stopped.")
        if chosen == "l":
            session.results[step.name] = Result(done=True, at=now(), findings=[
                Finding(f"{step.name}.left_out", "Left out: not measured.",
                        "Run `levelwind commission` again for it.", wrong=False)])  # fmt: skip
            session.save()
            return
        heard = Heard(human)
        result = Result(at=now(), told=heard.told)
        try:
            step.run(replace(bench, human=heard), result)
        except WrongError as error:
            finding = error.finding
            result.findings.append(finding)
            session.results[step.name] = result
            session.save()
            bench.rest()
            human.say(
                f"\n  WRONG  {finding.what}\n  DO     {finding.remedy}\n         ({finding.code})"
            )
            if human.choose(f"{step.name}.again", "r: mended, again; s: stop here?",
                            ("r", "s"), "s") == "s":  # fmt: skip
                raise ToolError(
                    f"Step {number}, {step.title}: {finding.what}\n{finding.remedy}\n"
                    f"What is done so far is kept. {human.to_go_on(session.path)}"
                ) from None
            continue
        result.done = True
        fresh = {name: value for name, value in result.proposed.items()
                 if session.values.get(name) != value}  # fmt: skip
        session.values.update(result.proposed)
        session.results[step.name] = result
        session.active = bench.active()
        session.save()
        _tell(bench, result, fresh)
        return


def _tell(bench: Bench, result: Result, fresh: Mapping[str, int]) -> None:
    """What came of a step."""
    lines = [f"  measured  {name}: {value}" for name, value in result.measured.items()]
    lines += [f"  set       {name}={value}" for name, value in fresh.items()]
    for finding in result.findings:
        lines += [f"  note      {finding.what}", f"            {finding.remedy}"]
    bench.human.say("\n".join([*lines, "  done"]))


def _accept(bench: Bench) -> None:
    """Sign: the active set becomes the accepted one, stored, and the winch is ready."""
    human, session, device = bench.human, bench.session, bench.device
    human.say(
        "\nSIGNATURE\n"
        "  The set that is active now becomes the accepted one, and is saved. From then on\n"
        "  `not_accepted` tells when another set is in force."
    )
    if human.choose("accept", "Is the winch to be accepted so?", "yn", "y") != "y":
        raise StoppedError("Not accepted.")
    session.accepted_by = human.text("accept.name", "Who accepts it (name)?", session.accepted_by)
    bench.rest()
    crc = device.value("active_crc")
    bench.apply({"accepted_crc": crc})
    device.command(Command.SAVE)
    session.active = bench.active()
    session.accepted_crc, session.accepted_at = crc, now()
    session.save()
    others.follow(bench)
