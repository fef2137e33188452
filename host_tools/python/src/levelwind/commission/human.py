# SPDX-License-Identifier: Apache-2.0
"""Who is asked: a person at the terminal, or a file that plays one for CI.

Every question has a name, by which an answers file answers it; doc/commissioning.md lists them.
"""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

from levelwind.errors import ToolError
from levelwind.files import yaml_file
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.line.plant import write_plant
from levelwind.line.points import lookup, parse_value
from levelwind.map_table import BenchCommand, Flag
from levelwind.show.output import console

PATIENCE_S = 60.0
RESUME = "Go on with: levelwind commission --resume {}"
TURN_RPM = 30.0
TURN_RAMP_S = 0.5
REST_LIMIT_S = 30.0
POLL_S = 0.05
YES = {"y": "y", "yes": "y", "true": "y", "n": "n", "no": "n", "false": "n"}


class StoppedError(ToolError):
    """The person wants to go on another time."""


class Human(Protocol):
    """What the steps need of a person."""

    patience_s: float
    """How long something that was asked for may take to be seen."""
    stop_key: str
    """What stops the carriage at once, as this person knows it."""

    def to_go_on(self, path: Path) -> str:
        """How to go on with a commissioning that has ended; a sentence."""

    def say(self, text: str) -> None:
        """Tell."""

    def ask_to(self, name: str, text: str) -> None:
        """Ask for something that the controller will see by itself."""

    def when_done(self, name: str, text: str) -> None:
        """Ask for something, and wait until the person says that it is done."""

    def choose(self, name: str, text: str, choices: Sequence[str], default: str) -> str:
        """One of some words."""

    def number(self, name: str, text: str, default: float) -> float:
        """A number, in the unit that the text names."""

    def text(self, name: str, text: str, default: str) -> str:
        """Some words; "" only where the default is."""


class Terminal:
    """A person at the terminal. Enter takes what stands in brackets; q goes on another time."""

    patience_s = PATIENCE_S
    stop_key = "Ctrl-C"

    def to_go_on(self, path: Path) -> str:
        """By the same command."""
        return RESUME.format(path)

    def say(self, text: str) -> None:
        """As it is."""
        console.print(text)

    def ask_to(self, name: str, text: str) -> None:
        """The controller sees it: no key."""
        del name
        console.print(f"  > {text}")

    def when_done(self, name: str, text: str) -> None:
        """Enter says that it is done."""
        del name
        self._read(f"  > {text} [Enter] ")

    def choose(self, name: str, text: str, choices: Sequence[str], default: str) -> str:
        """Asks again until it is one of them."""
        del name
        shown = "/".join(c.upper() if c == default else c for c in choices)
        while True:
            given = self._read(f"  ? {text} [{shown}] ").lower() or default
            given = YES.get(given, given) if "y" in choices else given
            if given in choices:
                return given
            console.print(f"    One of {', '.join(choices)}, or q to go on another time.")

    def number(self, name: str, text: str, default: float) -> float:
        """Asks again until it is one; a comma is a decimal point."""
        del name
        while True:
            given = self._read(f"  ? {text} [{default:g}] ")
            try:
                return float(given.replace(",", ".")) if given else default
            except ValueError:
                console.print(f"    {given} is no number. q goes on another time.")

    def text(self, name: str, text: str, default: str) -> str:
        """Asks again where there is neither an answer nor a default."""
        del name
        while True:
            given = self._read(f"  ? {text}{f' [{default}]' if default else ''} ") or default
            if given:
                return given

    def _read(self, prompt: str) -> str:
        try:
            given = console.input(prompt, markup=False).strip()
        except EOFError:
            raise StoppedError("The terminal has ended.") from None
        if given == "q":
            raise StoppedError("Stopped.")
        return given


class Heard:
    """Hands everything on, and remembers what was answered: it stands in the report as told."""

    def __init__(self, human: Human) -> None:
        self._human = human
        self.patience_s, self.stop_key = human.patience_s, human.stop_key
        self.told: dict[str, str] = {}

    def to_go_on(self, path: Path) -> str:
        """As it is."""
        return self._human.to_go_on(path)

    def say(self, text: str) -> None:
        """As it is."""
        self._human.say(text)

    def ask_to(self, name: str, text: str) -> None:
        """As it is."""
        self._human.ask_to(name, text)

    def when_done(self, name: str, text: str) -> None:
        """As it is."""
        self._human.when_done(name, text)

    def choose(self, name: str, text: str, choices: Sequence[str], default: str) -> str:
        """Remembered but for what only steers the dialogue."""
        given = self._human.choose(name, text, choices, default)
        if not name.endswith((".begin", ".again")):
            self.told[text] = {"y": "yes", "n": "no"}.get(given, given)
        return given

    def number(self, name: str, text: str, default: float) -> float:
        """Remembered; of a question that comes again all answers."""
        given = self._human.number(name, text, default)
        before = self.told.get(text)
        self.told[text] = f"{before}; {given:g}" if before else f"{given:g}"
        return given

    def text(self, name: str, text: str, default: str) -> str:
        """Remembered."""
        self.told[text] = self._human.text(name, text, default)
        return self.told[text]


class Answers:
    """A file that plays a person, with hands on a simulated machine.

    An answer is a word or a number, or a mapping of what the hands do: `place_mm` pushes the
    carriage, `turn` turns the drum by so many revolutions, `bench` writes registers of the plant,
    `mark` and `way_mm` put a ruler on one of them (`bench_carriage_um`).
    """

    stop_key = "Ctrl-C"
    HANDS = ("bench", "place_mm", "turn", "mark", "way_mm", "answer")

    def __init__(self, path: Path, device: Device) -> None:
        """ToolError where the file is no such."""
        document = yaml_file.load(path)
        if not isinstance(document, dict) or document.get("levelwind_answers") != "1":
            raise ToolError(f"{path} has no answers: it must begin with `levelwind_answers: 1`.")
        answers = document.get("answers") or {}
        if not isinstance(answers, dict):
            raise ToolError(f"{path}: `answers` must be a mapping from questions to answers.")
        self.patience_s = float(document.get("patience_s", 3.0))
        self._path, self._answers, self._device = path, answers, device
        self._marked_um = 0

    def to_go_on(self, path: Path) -> str:
        """By the same command."""
        return RESUME.format(path)

    def say(self, text: str) -> None:
        """As it is: CI keeps it."""
        console.print(text)

    def ask_to(self, name: str, text: str) -> None:
        """Let the hands do it."""
        console.print(f"  > {text}")
        self._do(name)

    def when_done(self, name: str, text: str) -> None:
        """Let the hands do it."""
        self.ask_to(name, text)

    def choose(self, name: str, text: str, choices: Sequence[str], default: str) -> str:
        """The file's answer, or the default."""
        given = self._answer(name, text, default).lower()
        given = YES.get(given, given) if "y" in choices else given
        if given not in choices:
            raise ToolError(f"{self._path}: {name}: {given}: give one of {', '.join(choices)}.")
        return given

    def number(self, name: str, text: str, default: float) -> float:
        """The file's answer, or the default."""
        given = self._answer(name, text, f"{default!r}")
        try:
            return float(given)
        except ValueError:
            raise ToolError(f"{self._path}: {name}: {given} is no number.") from None

    def text(self, name: str, text: str, default: str) -> str:
        """The file's answer, or the default."""
        given = self._answer(name, text, default)
        if not given:
            raise ToolError(f"{self._path} has no answer to {name}: {text}")
        return given

    def _answer(self, name: str, text: str, default: str) -> str:
        done = self._do(name)
        given = default if done is None else done
        console.print(f"  ? {text} {given}")
        return given

    def _do(self, name: str) -> str | None:
        """What the file says to this question; its hands move first."""
        given = self._answers.get(name)
        if not isinstance(given, dict):
            return None if given is None else str(given)
        unknown = [key for key in given if key not in self.HANDS]
        if unknown:
            raise ToolError(
                f"{self._path}: {name}: {unknown[0]} is none of {', '.join(self.HANDS)}."
            )
        if "bench" in given:
            self._bench(given["bench"])
        if "place_mm" in given:
            self._bench({"bench_argument": round(1000 * float(given["place_mm"]))})
            self._bench({"bench_command": BenchCommand.PLACE_CARRIAGE.label})
        if "turn" in given:
            self._turn(float(given["turn"]))
        if "mark" in given:
            self._marked_um = self._device.value(str(given["mark"]))
        if "way_mm" in given:
            way_um = self._device.value(str(given["way_mm"])) - self._marked_um
            return f"{way_um / 1000:.1f}"  # as a ruler is read
        return None if given.get("answer") is None else str(given["answer"])

    def _bench(self, values: Mapping[str, object]) -> None:
        write_plant(self._device, {n: parse_value(lookup(n), given) for n, given in values.items()})

    def _turn(self, revolutions: float) -> None:
        """Turn the drum exactly so far, gently: a profile of speeds, exact to the transition."""
        sign = 1 if revolutions > 0 else -1
        turning_s = abs(revolutions) * 60 / TURN_RPM  # a ramp up and one down are one at full speed
        peak = round(sign * TURN_RPM * 1000)
        ramp_ms, end_ms = round(1000 * TURN_RAMP_S), round(1000 * (turning_s + TURN_RAMP_S))
        points = [0, 0, ramp_ms, peak, end_ms - ramp_ms, peak, end_ms, 0]
        self._device.write({"bench_command": BenchCommand.PROFILE_CLEAR})
        window = lookup("bench_profile")
        words = [w for p in points for w in ((p & 0xFFFFFFFF) >> 16, p & 0xFFFF)]
        self._device.write_registers(window.address, words, "bench_profile", "")
        self._device.write(
            {"bench_argument": len(points) // 2, "bench_command": BenchCommand.PROFILE_APPEND}
        )
        self._device.write({"bench_command": BenchCommand.PROFILE_START})
        deadline = time.monotonic() + end_ms / 1000 + REST_LIMIT_S
        while time.monotonic() < deadline:
            time.sleep(POLL_S)
            if not self._device.value("bench_profile_running") and flag(
                read_live(self._device), Flag.DRUM_AT_REST
            ):
                return
        raise ToolError("The simulated drum does not come to rest.")
