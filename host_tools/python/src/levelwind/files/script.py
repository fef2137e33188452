# SPDX-License-Identifier: Apache-2.0
"""Setup scripts: a YAML list of steps, checked as a whole before the first one is sent.

- note: A fresh controller
- set: {pitch_um: 12000, index_switch: plus}
- apply
- index
- expect: {state: ready, los: false, position_um: {min: -83000, max: -82000}}
- wait: {until: {launch_permit: true}, timeout_s: 5}
- jog: {direction: plus, seconds: 0.5}
- bench: {bench_stall: 1}
"""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from levelwind.errors import ToolError
from levelwind.files import yaml_file
from levelwind.line.device import Device
from levelwind.line.motion import INDEX_LIMIT_S, hold_jog
from levelwind.line.plant import write_plant
from levelwind.line.points import (
    check_limits,
    format_value,
    lookup,
    parse_number,
    parse_value,
    parse_whole,
)
from levelwind.map_table import Command, Mode, Point

WAIT_LIMIT_S = 30.0
WAIT_POLL_S = 0.05
COMMAND_STEPS = ("apply", "revert", "save", "index", "stop", "clear_fault", "acknowledge_rope")


@dataclass(frozen=True)
class Step:
    """One checked step. `run` returns a remark, or raises ToolError."""

    text: str
    run: Callable[[Device], str]


@dataclass(frozen=True)
class Condition:
    """What a register must read: one of some values, or a value in a range."""

    point: Point
    allowed: tuple[int, ...] = ()
    min: int | None = None
    max: int | None = None

    def holds(self, value: int) -> bool:
        """Whether a value meets it."""
        if self.allowed:
            return value in self.allowed
        above = self.min is None or value >= self.min
        return above and (self.max is None or value <= self.max)

    def __str__(self) -> str:
        if self.allowed:
            wanted = " or ".join(format_value(self.point, value) for value in self.allowed)
        else:
            low = "" if self.min is None else f"at least {self.min}"
            high = "" if self.max is None else f"at most {self.max}"
            wanted = " and ".join(filter(None, (low, high)))
        return f"{self.point.name} {wanted}"


def load(path: Path) -> list[Step]:
    """The steps of a script; ToolError names the step and what is wrong with it."""
    document = yaml_file.load(path)
    if not isinstance(document, list) or not document:
        raise ToolError(f"{path}: a script is a list of steps, each beginning with a dash.")
    steps = []
    for number, item in enumerate(document, 1):
        try:
            steps.append(_step(item))
        except ToolError as error:
            line = getattr(error, "line", _line(item))
            raise ToolError(f"{path}, line {line}, step {number}: {error}") from None
    return steps


def _line(item: object) -> object:
    """Where a step stands."""
    while isinstance(item, dict | list) and item:
        item = next(iter(item))
    return getattr(item, "line", "?")


def _step(item: object) -> Step:
    if isinstance(item, str):
        item = {item: None}
    if not isinstance(item, dict) or len(item) != 1:
        raise ToolError("a step is one word, or one `name: ...`.")
    ((kind, argument),) = item.items()
    if kind in COMMAND_STEPS:
        if argument is not None:
            raise ToolError(f"{kind} takes no argument.")
        return _command_step(Command[kind.upper()])
    build = _BUILDERS.get(kind)
    if build is None:
        known = ", ".join([*COMMAND_STEPS, *_BUILDERS])
        raise ToolError(f"unknown step {kind!r}; known: {known}.")
    return build(argument)


def _command_step(command: Command) -> Step:
    def run(device: Device) -> str:
        limit_s = INDEX_LIMIT_S if command == Command.INDEX else WAIT_LIMIT_S
        device.command(command, limit_s=limit_s)
        return ""

    return Step(command.label, run)


def _note(argument: object) -> Step:
    return Step(f"# {'' if argument is None else argument}", lambda device: "")


def _write_step(argument: object, kind: str, bench: bool) -> Step:
    values = {}
    for name, given in _mapping(argument, kind).items():
        with yaml_file.at(name):
            point = lookup(name)
            if point.space != "holding" or (point.block == "bench") != bench:
                raise ToolError(f"{name} cannot be written by {kind}.")
            values[name] = parse_value(point, given)
    shown = ", ".join(f"{name}={format_value(lookup(name), v)}" for name, v in values.items())

    def run(device: Device) -> str:
        if bench:
            write_plant(device, values)
        else:
            device.write(values)
        return ""

    return Step(f"{kind} {shown}", run)


def _mode(argument: object) -> Step:
    value = parse_value(lookup("mode"), argument)

    def run(device: Device) -> str:
        device.write({"mode": value})
        return ""

    return Step(f"mode {Mode(value).label}", run)


def _factory(argument: object) -> Step:
    if not isinstance(argument, str) or argument not in ("motion", "line", "all"):
        raise ToolError("factory: give motion, line or all.")
    return _command_step(Command[f"FACTORY_{str(argument).upper()}"])


def _jog(argument: object) -> Step:
    fields = _fields(argument, "jog", {"direction", "seconds"})
    direction = fields.get("direction")
    if direction not in ("plus", "minus"):
        raise ToolError("jog: direction is plus or minus.")
    seconds = _seconds(fields.get("seconds"), "jog: seconds")

    def run(device: Device) -> str:
        hold_jog(device, direction, seconds)
        return ""

    return Step(f"jog {direction} for {seconds:g} s", run)


def _expect(argument: object) -> Step:
    conditions = _conditions(argument, "expect")

    def run(device: Device) -> str:
        wrong = _unmet(conditions, device)
        if wrong:
            raise ToolError("; ".join(wrong))
        return ""

    return Step(f"expect {', '.join(map(str, conditions))}", run)


def _wait(argument: object) -> Step:
    fields = _fields(argument, "wait", {"until", "timeout_s"})
    conditions = _conditions(fields.get("until"), "wait: until")
    limit_s = _seconds(fields.get("timeout_s", WAIT_LIMIT_S), "wait: timeout_s")

    def run(device: Device) -> str:
        began = time.monotonic()
        while wrong := _unmet(conditions, device):
            if time.monotonic() - began > limit_s:
                raise ToolError(f"not within {limit_s:g} s: {'; '.join(wrong)}")
            time.sleep(WAIT_POLL_S)
        return f"after {time.monotonic() - began:.1f} s"

    return Step(f"wait until {', '.join(map(str, conditions))}", run)


_BUILDERS: dict[str, Callable[[object], Step]] = {
    "note": _note,
    "set": lambda argument: _write_step(argument, "set", bench=False),
    "bench": lambda argument: _write_step(argument, "bench", bench=True),
    "mode": _mode,
    "factory": _factory,
    "jog": _jog,
    "expect": _expect,
    "wait": _wait,
}


def _unmet(conditions: list[Condition], device: Device) -> list[str]:
    values = device.read(condition.point for condition in conditions)
    return [
        f"{c}, but it is {format_value(c.point, values[c.point.name])}"
        for c in conditions
        if not c.holds(values[c.point.name])
    ]


def _conditions(argument: object, kind: str) -> list[Condition]:
    return [_condition(name, wanted) for name, wanted in _mapping(argument, kind).items()]


def _condition(name: str, wanted: Any) -> Condition:
    with yaml_file.at(name):
        point = lookup(name)
        if isinstance(wanted, dict):
            if not wanted or not wanted.keys() <= {"min", "max"}:
                raise ToolError(f"{name}: a range has min, max or both.")
            limits = {key: _whole(point, value) for key, value in wanted.items()}
            return Condition(point, min=limits.get("min"), max=limits.get("max"))
        values = wanted if isinstance(wanted, list) else [wanted]
        if not values:
            raise ToolError(f"{name}: an empty list can never hold.")
        return Condition(point, tuple(_whole(point, value) for value in values))


def _whole(point: Point, given: object) -> int:
    """A value to compare with: read-only registers have names, but no limits."""
    names = {"false": 0, "true": 1} if point.type == "bit" else {}
    if point.enum is not None:
        names = {member.label: int(member) for member in point.enum}
    if isinstance(given, str) and given in names:
        return names[given]
    try:
        value = parse_whole(given)
    except ValueError:
        value = None
    if names and value not in names.values():
        raise ToolError(f"{point.name}: {given} is none of {', '.join(names)}.")
    if value is None:
        raise ToolError(f"{point.name}: {given} is no whole number.")
    return check_limits(point, value) if point.writable else value


def _mapping(argument: object, kind: str) -> Mapping[str, Any]:
    if not isinstance(argument, dict) or not argument:
        raise ToolError(f"{kind}: give name: value pairs.")
    return argument


def _fields(argument: object, kind: str, known: set[str]) -> Mapping[str, Any]:
    fields = _mapping(argument, kind)
    unknown = sorted(map(str, fields.keys() - known))
    if unknown:
        raise ToolError(f"{kind}: unknown {', '.join(unknown)}; known: {', '.join(sorted(known))}.")
    return fields


def _seconds(value: object, what: str) -> float:
    with yaml_file.at(value):
        try:
            seconds = value if isinstance(value, float) else parse_number(value)
        except ValueError:
            seconds = 0.0
        if not 0 < seconds <= 3600:
            raise ToolError(f"{what} is a number of seconds, at most 3600.")
        return seconds
