# SPDX-License-Identifier: Apache-2.0
"""A winch in virtual time behind the tool's own Device, and a person with hands on it."""

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml
from levelwind.commission import guide, session
from levelwind.commission.bench import Bench
from levelwind.commission.human import Answers
from levelwind.errors import ToolError
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.line.rtu import Heard
from world import World

NAMES = [step.name for step in guide.STEPS]
REQUEST_S = 0.004
"""What a request takes, of virtual time."""


class KilledError(BaseException):
    """The tool has been killed: nothing that it does arrives any more."""


class WorldClient:
    """A transport of Device whose other end is a World."""

    def __init__(self, world: World, clock: "Clock") -> None:
        self.world, self.clock = world, clock
        self.line_echoes = False
        self.heard = Heard.NOTHING
        self.other_units: set[int] = set()
        self.watch: Callable[[bytes], None] = lambda _: None
        self.after: Callable[[], None] = lambda: None

    def connect(self) -> bool:
        return True

    def close(self) -> None:
        pass

    def _answer(self, pdu: bytes) -> Any:
        self.watch(pdu)
        self.clock.sleep(REQUEST_S)
        answer = self.world.request(pdu)
        self.after()
        if answer[0] & 0x80:
            return SimpleNamespace(isError=lambda: True, exception_code=answer[1])
        data = answer[2:]
        words = [int.from_bytes(data[i : i + 2], "big") for i in range(0, len(data) - 1, 2)]
        return SimpleNamespace(isError=lambda: False, registers=words)

    def _read(self, function: int, address: int, count: int) -> Any:
        return self._answer(
            bytes([function]) + address.to_bytes(2, "big") + count.to_bytes(2, "big")
        )

    def read_holding_registers(self, address: int, count: int, device_id: int) -> Any:
        return self._read(3, address, count)

    def read_input_registers(self, address: int, count: int, device_id: int) -> Any:
        return self._read(4, address, count)

    read_coils = read_discrete_inputs = None  # no step reads bits

    def write_registers(self, address: int, values: list[int], **_: Any) -> Any:
        head = bytes([16]) + address.to_bytes(2, "big") + len(values).to_bytes(2, "big")
        words = b"".join(value.to_bytes(2, "big") for value in values)
        return self._answer(head + bytes([len(words)]) + words)


class Clock:
    """The tool's time is the world's."""

    def __init__(self, world: World) -> None:
        self.world, self.now_s = world, 0.0

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds
        self.world.run(seconds)

    def monotonic(self) -> float:
        return self.now_s


class Winch:
    """A world, the tool at its line, and what the person answers."""

    def __init__(
        self, world: World, folder: Path, monkeypatch: pytest.MonkeyPatch, **answers: object
    ) -> None:
        clock = Clock(world)
        monkeypatch.setattr(time, "sleep", clock.sleep)
        monkeypatch.setattr(time, "monotonic", clock.monotonic)
        self.world, self.folder = world, folder
        self.client = WorldClient(world, clock)
        self.device = Device(Line("world"), self.client)  # type: ignore[arg-type]
        self.answers: dict[str, object] = {**hands(), **answers}
        self.session = session.Session(folder / "commissioning.json", begun=session.now())

    def answer(self, **answers: object) -> None:
        """Names with _ for the point are none: give a mapping where that matters."""
        self.answers.update(answers)

    def go_on(self) -> session.Session:
        """What `levelwind commission --answers` does."""
        path = self.folder / "answers.yaml"
        path.write_text(
            yaml.safe_dump({"levelwind_answers": 1, "patience_s": 2, "answers": self.answers})
        )
        guide.go_on(Bench(self.device, Answers(path, self.device), self.session))
        return self.session


def hands(plus_mm: float = 78.4, minus_mm: float = -78.4, beyond_mm: float = 86.0,
          middle_mm: float = 0.0) -> dict[str, object]:  # fmt: skip
    """A person who presses the switches by pushing the carriage, and reads a ruler."""
    to: Callable[[float], Mapping[str, float]] = lambda mm: {"place_mm": mm}  # noqa: E731
    answers: dict[str, object] = {"contacts.middle": to(middle_mm)}
    for side, at, beyond in (("plus", plus_mm, beyond_mm), ("minus", minus_mm, -beyond_mm)):
        sign = 1 if side == "plus" else -1
        answers[f"contacts.{side}.press"] = to(at + sign)
        answers[f"contacts.{side}.release"] = to(middle_mm)
        answers[f"contacts.overtravel_{side}.press"] = to(beyond + sign * 0.5)
        answers[f"contacts.overtravel_{side}.release"] = to(middle_mm)
    return answers | {
        "encoder.forward": {"turn": 1},
        "encoder.back": {"turn": -1},
        "encoder.pulses": 360,
        "stepper.lead_mm": 20,
        "stepper.mark": {"mark": "bench_carriage_um"},
        "stepper.way": {"way_mm": "bench_carriage_um"},
        "geometry.room_plus_mm": 4.6,
        "geometry.room_minus_mm": 4.6,
        "geometry.pitch_mm": 12,
        "geometry.rope_m_per_s": 30,
        "rope.ends": {"turn": 15},
        "rope.back": {"turn": -3},
        "rope.fast": {"turn": 3},
        "accept.name": "A. Builder",
    }


def ended_with(winch: Winch) -> tuple[str, str]:
    """The step that ended it, and its finding."""
    with pytest.raises(ToolError, match="What is done so far is kept"):
        winch.go_on()
    results = session.load(winch.session.path).results
    (step,) = [name for name, held in results.items() if not held.done]
    assert NAMES.index(step) == len(results) - 1, "later steps have begun"
    (finding,) = [finding for finding in results[step].findings if finding.wrong]
    assert len(finding.remedy) > 20
    return step, finding.code
