# SPDX-License-Identifier: Apache-2.0
"""The guided commissioning at a page: the dialogue of the command, and a page for the person."""

import math
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from levelwind.commission import dialogue, guide, session
from levelwind.commission.bench import Bench
from levelwind.commission.human import PATIENCE_S, YES, StoppedError
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.serve.owner import PortOwner, QueuedClient

REPORTS = ("report.html", "report.pdf")
LINES_KEPT = 400
ANSWER_MAX = 200
CLOSE_S = 20.0
"""A carriage that is stopped stands long before."""


class Interruption:
    """What Ctrl-C is to a terminal: a KeyboardInterrupt at the dialogue's next request or question.

    The same exception as at a terminal, so that every step stops the carriage and puts back what it
    has changed as it does there. It comes once; no question is asked after it.
    """

    def __init__(self) -> None:
        self.why = ""
        self._raised = False

    def check(self) -> None:
        """Called before every request: where it has been asked for, it is raised here."""
        if self.why and not self._raised:
            self._raised = True
            raise KeyboardInterrupt


class InterruptibleClient(QueuedClient):
    """The dialogue's way to the line."""

    def __init__(self, owner: PortOwner, interruption: Interruption) -> None:
        super().__init__(owner)
        self._interruption = interruption

    def send(self, request: bytes, addr: tuple[object, ...] | None = None) -> int:
        """The next step on the way to the line; not taken where somebody has pressed Stop."""
        self._interruption.check()
        return super().send(request, addr)


class AtPage:
    """A person at the page. Says and asks from the dialogue's thread; answered from any other."""

    patience_s = PATIENCE_S
    stop_key = "The key Stop carriage"

    def __init__(self, changed: threading.Condition, told: Callable[[], None]) -> None:
        self.lines: list[str] = []
        self.question: dict[str, object] | None = None
        self.request = ""
        """What the person is to do, and the controller sees by itself."""
        self.interruption = Interruption()
        self._changed, self._told = changed, told
        self._given: str | None = None
        self._number = 0

    # ---- from the dialogue's thread ------------------------------------------------------------

    def to_go_on(self, path: Path) -> str:
        """By the same page, or the command."""
        return (
            "What is done so far is kept: this page goes on with it, or `levelwind commission "
            f"--resume {path}`."
        )

    def say(self, text: str) -> None:
        """A block of what was said."""
        with self._changed:
            self.request = ""
            self.lines = [*self.lines, *text.strip("\n").splitlines()][-LINES_KEPT:]
            self._told()

    def ask_to(self, name: str, text: str) -> None:
        """No key: it stands there until something else is said or asked."""
        del name
        self.say(f"  > {text}")
        with self._changed:
            self.request = text
            self._told()

    def when_done(self, name: str, text: str) -> None:
        """A key says that it is done."""
        self._ask("done", name, text, ("done",), "done")

    def choose(self, name: str, text: str, choices: Sequence[str], default: str) -> str:
        """A key for each."""
        return self._ask("choose", name, text, tuple(choices), default)

    def number(self, name: str, text: str, default: float) -> float:
        """A field; what is no number has not been taken."""
        return float(self._ask("number", name, text, (), f"{default:g}"))

    def text(self, name: str, text: str, default: str) -> str:
        """A field."""
        return self._ask("text", name, text, (), default)

    def _ask(self, kind: str, name: str, text: str, choices: tuple[str, ...], default: str) -> str:
        with self._changed:
            self._number += 1
            self._given, self.request = None, ""
            self.question = {
                "number": self._number, "kind": kind, "name": name, "text": text,
                "choices": choices, "default": default,
            }  # fmt: skip
            self._told()
            try:
                while self._given is None:
                    self.interruption.check()
                    if self.interruption.why:
                        raise StoppedError(self.interruption.why)
                    self._changed.wait()
            finally:
                self.question = None
                self._told()
            self.lines = [*self.lines, f"  ? {text} {self._given}"][-LINES_KEPT:]
            return self._given

    # ---- from the page -------------------------------------------------------------------------

    def answer(self, number: object, given: str) -> None:
        """The answer to a question, by its number; ToolError if it is none."""
        with self._changed:
            question = self.question
            if question is None or question["number"] != number or self._given is not None:
                return  # pressed twice, or late: another question stands there, or none
            self._given = _taken(question, given.strip()[:ANSWER_MAX])
            self._changed.notify_all()

    def interrupt(self, why: str) -> None:
        """As Ctrl-C; the first reason is kept."""
        with self._changed:
            self.interruption.why = self.interruption.why or why
            self._changed.notify_all()


def _taken(question: dict[str, object], given: str) -> str:
    """An answer as the dialogue wants it; ToolError says why it is none."""
    choices, default = question["choices"], str(question["default"])
    assert isinstance(choices, tuple)
    given = given or default
    if question["kind"] in ("choose", "done"):
        given = YES.get(given, given) if "y" in choices else given
        if given not in choices:
            raise ToolError(f"{given}: give one of {', '.join(choices)}.")
    elif question["kind"] == "number":
        given = given.replace(",", ".")
        try:
            finite = math.isfinite(float(given))
        except ValueError:
            finite = False
        if not finite:
            raise ToolError(f"{given} is no number.")
    elif not given:
        raise ToolError("Give a few words.")
    return given


class Commissioning:
    """One dialogue at a time, in a thread of its own, and who leads it.

    Who leads it is the page that has begun it. When that goes away, the dialogue ends as by Ctrl-C.
    """

    def __init__(self, owner: PortOwner, folder: Path) -> None:
        """ToolError where the folder cannot be, or holds something else."""
        self.folder = folder
        self._owner = owner
        self._changed = threading.Condition(threading.RLock())
        self._version = 0
        self._leader: object = None
        self._human: AtPage | None = None
        self._thread: threading.Thread | None = None
        self._ended = ""
        self._held = self._session()
        self._steps = self._told_steps()

    def _session(self) -> session.Session:
        path = self.folder / dialogue.STATE
        return session.load(path) if path.exists() else dialogue.begin(self.folder)

    # ---- what the page shows -------------------------------------------------------------------

    def look(self) -> None:
        """A page has come: what the folder holds now, as the command may have gone on with it."""
        with self._changed:
            if self._leader is None:
                try:
                    self._held = self._session()
                except ToolError as error:
                    self._ended = str(error)
                self._said()

    @property
    def is_running(self) -> bool:
        """Has it begun, and not come to its end?"""
        with self._changed:
            return self._leader is not None

    def leads(self, leader: object) -> bool:
        """Has this page begun it?"""
        with self._changed:
            return self._leader is leader

    def picture(self, leader: object, seen: int) -> tuple[int, dict[str, object] | None]:
        """Everything that one page shows of it; None where that is what it has `seen`."""
        with self._changed:
            if self._version == seen:
                return seen, None
            human = self._human
            return self._version, {
                "running": self._leader is not None,
                "leads": self._leader is leader,
                "stopping": human.interruption.why if human else "",
                "ended": self._ended,
                "steps": self._steps,
                "accepted": self._held.accepted_by if self._held.accepted_crc else "",
                "lines": human.lines if human else [],
                "request": human.request if human else "",
                "question": human.question if human else None,
                "reports": [name for name in REPORTS if self.report(name) is not None],
            }

    def report(self, name: str) -> Path | None:
        """A report's file; none but those, and nothing outside the folder."""
        path = self.folder / name
        if name not in REPORTS or not path.is_file():
            return None
        return path if path.resolve().parent == self.folder.resolve() else None

    def _told_steps(self) -> list[dict[str, object]]:
        """The steps, what each does, and what came of it."""
        told = []
        for step in guide.STEPS:
            held = self._held.results.get(step.name, session.Result())
            told.append(
                {
                    "name": step.name,
                    "title": step.title,
                    "does": step.does,
                    "moves": guide.moves(step, AtPage.stop_key),
                    "back": step.back,
                    "done": held.done,
                    "at": held.at,
                    "told": list(held.told.items()),
                    "measured": [(name, str(value)) for name, value in held.measured.items()],
                    "set": list(held.proposed.items()) if held.done else [],
                    "findings": [asdict(finding) for finding in held.findings],
                }
            )
        return told

    def _change(self) -> None:
        with self._changed:
            self._version += 1

    def _said(self) -> None:
        """From the dialogue's thread, between what the steps do: their results are whole."""
        self._steps = self._told_steps()
        self._change()

    # ---- what the page asks for ----------------------------------------------------------------

    def begin(self, leader: object) -> None:
        """Begin, or go on with what is kept in the folder; ToolError while another page leads."""
        with self._changed:
            if self._leader is not None:
                raise ToolError("A commissioning is under way already, at another page.")
            self._held = self._session()
            self._leader, self._ended = leader, ""
            self._human = AtPage(self._changed, self._said)
            self._thread = threading.Thread(
                target=self._run, args=(self._human, self._held), name="commission", daemon=True
            )
            self._change()
            self._thread.start()

    def answer(self, leader: object, number: object, given: str) -> None:
        """An answer of the page that leads; ToolError if it is none."""
        with self._changed:
            if self._leader is leader and self._human is not None:
                self._human.answer(number, given)

    def stop(self, why: str) -> None:
        """End it as Ctrl-C does, whoever leads; nothing where none is under way."""
        with self._changed:
            if self._leader is not None and self._human is not None:
                self._human.interrupt(why)
                self._change()

    def leave(self, leader: object) -> None:
        """A page has gone; if it leads, the dialogue ends."""
        with self._changed:
            if self._leader is leader:
                self.stop("The page that led it has gone.")

    def close(self) -> None:
        """The server ends."""
        self.stop("The server has been ended.")
        if self._thread is not None:
            self._thread.join(CLOSE_S)

    # ---- the dialogue's thread -----------------------------------------------------------------

    def _run(self, human: AtPage, held: session.Session) -> None:
        device = Device(self._owner.line, InterruptibleClient(self._owner, human.interruption))
        bench = Bench(device, human, held)
        try:
            ended = self._end(bench, human)
        except ToolError as error:
            ended = f"{human.interruption.why}\n{error}".strip()
        except Exception as error:  # a fault of ours must not leave it moving
            traceback.print_exc(file=sys.stderr)
            with suppress(ToolError, KeyboardInterrupt):
                bench.rest()
            ended = f"A fault of this program: {error!r}. {human.to_go_on(held.path)}"
        finally:
            with self._changed:
                human.request, human.question = "", None
                self._ended, self._leader = ended, None
                self._said()

    @staticmethod
    def _end(bench: Bench, human: AtPage) -> str:
        """Run it; how it has ended, in words. ToolError says what is wrong."""
        try:
            dialogue.run(bench)
        except (StoppedError, KeyboardInterrupt) as stopped:
            why = human.interruption.why or str(stopped)
            return f"{why} The carriage stands. {human.to_go_on(bench.session.path)}"
        return (
            f"Accepted by {bench.session.accepted_by}. The winch is indexed and follows the drum."
        )
