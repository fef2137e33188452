# SPDX-License-Identifier: Apache-2.0
"""Commands for the operator, on registers in a dictionary."""

from pathlib import Path

import pytest
from levelwind.cli import app
from levelwind.line import device as device_module
from levelwind.line import motion
from levelwind.line.live import Travel
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Fault, Flag, State
from levelwind.show import recorder
from levelwind.show.status import render
from levelwind.simulate import launches
from python.fake_client import FakeClient
from typer.testing import CliRunner


class Controller(FakeClient):
    """Refuses to go on jogging, and comes to rest a few looks later."""

    values: dict[str, int] = {}  # noqa: RUF012
    jogs = 0
    looks_until_rest = 3

    def __init__(self, line: Line) -> None:
        super().__init__(line)
        for name, value in self.values.items():
            self.put(name, value)

    def write_registers(self, address: int, values: list[int], **options: object):
        answer = super().write_registers(address, values, **options)
        if address == POINTS["jog"].address and values != [0]:
            self.put("state", State.JOGGING)
            self.jogs += 1
            if self.jogs > 1:
                answer.isError = lambda: True
                answer.exception_code = 6
                self.put("last_error_exception", 6)
        return answer

    def read_input_registers(self, address: int, count: int, device_id: int):
        if self.jogs > 1 and address == 100:
            self.looks_until_rest -= 1
            if self.looks_until_rest == 0:
                self.put("state", State.UNINDEXED)
        return super().read_input_registers(address, count, device_id)


@pytest.fixture(autouse=True)
def controller(monkeypatch: pytest.MonkeyPatch) -> type[Controller]:
    monkeypatch.setattr(device_module, "RtuClient", Controller)
    monkeypatch.setattr(Controller, "values", {})
    monkeypatch.setattr(motion, "JOG_REWRITE_S", 0)
    monkeypatch.setattr(motion, "REST_POLL_S", 0)
    return Controller


def levelwind(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.mark.parametrize(
    "arguments", [["stop"], ["clear-fault"], ["revert"], ["set", "bench_drum_speed_millirpm=1"]]
)
def test_what_was_done_is_said_in_one_line(arguments: list[str]):
    result = levelwind(*arguments)
    assert result.exit_code == 0, result.output
    assert len(result.stdout.splitlines()) == 1


def test_a_refused_bench_set_is_told(controller: type[Controller]):
    controller.values["bench_result"] = 22
    result = levelwind("set", "bench_drum_speed_millirpm=1")
    assert result.exit_code == 1
    assert "The plant refused" in result.stderr


def test_jog_waits_for_rest_and_names_the_switch(controller: type[Controller]):
    controller.values |= {"flags": 1 << Flag.SWITCH_MINUS, "position_um": -12_340}
    result = levelwind("jog", "minus", "--for", "60")
    assert result.exit_code == 0
    assert result.stdout == (
        "unindexed, -12.34 mm from where the jog began (position unknown); "
        "stopped by the minus limit switch\n"
    )


def test_watch_keeps_what_was_recorded_before_ctrl_c(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    looks = []

    def interrupted(device: object) -> dict[str, int]:
        looks.append(1)
        if len(looks) > 2:
            raise KeyboardInterrupt
        return {"state": 0, "position_um": 5}

    monkeypatch.setattr(recorder, "read_live", interrupted)
    table = tmp_path / "table.csv"
    assert levelwind("watch", "--csv", str(table)).exit_code == 130
    assert len(table.read_text().splitlines()) == 3


@pytest.mark.parametrize(("state", "lines"), [(State.UNINDEXED, 1), (State.TRACKING, 0)])
def test_launch_warns_if_the_carriage_will_not_follow(
    controller: type[Controller],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    state: State,
    lines: int,
):
    controller.values["state"] = state
    monkeypatch.setattr(launches, "read_gearing", lambda *_: None)
    monkeypatch.setattr(launches, "upload", lambda *_: None)
    monkeypatch.setattr("levelwind.files.profiles.read", lambda *_: [])
    end = dict.fromkeys(POINTS, 0) | {"state": state}
    monkeypatch.setattr(launches, "play", lambda *_: launches.Launch(end, end))
    result = levelwind("launch", str(tmp_path), "--json")
    assert result.exit_code == bool(lines), result.output
    assert len(result.stderr.splitlines()) == 2 * lines
    assert ("will not follow" in result.stderr) == bool(lines)


NO_LOOK = {"permit": "kept", "state": State.TRACKING}


@pytest.mark.parametrize(
    ("end", "told"),
    [
        ({}, ""),
        ({"permit": "never given", "state": State.OFF}, "launch permit never given"),
        ({"permit": "lost"}, "launch permit lost"),
        ({"state": State.FAULT, "fault": Fault.OVERSPEED}, "state fault (overspeed)"),
        ({"flags": 1 << Flag.LOS}, Flag.LOS.text),
        ({"flags_2": 1 << Flag.ROPE_LAID_STANDING - 32}, Flag.ROPE_LAID_STANDING.text),
    ],
)
def test_a_launch_that_was_not_in_order_ends_with_exit_status_1(
    controller: type[Controller],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    end: dict[str, object],
    told: str,
):
    controller.values["state"] = State.TRACKING
    monkeypatch.setattr(launches, "read_gearing", lambda *_: None)
    monkeypatch.setattr(launches, "upload", lambda *_: None)
    monkeypatch.setattr("levelwind.files.profiles.read", lambda *_: [])
    seen = dict.fromkeys(POINTS, 0) | NO_LOOK | end
    permit = seen.pop("permit")
    monkeypatch.setattr(launches, "play", lambda *_: launches.Launch(seen, seen, permit=permit))
    result = levelwind("launch", str(tmp_path))
    assert result.exit_code == bool(told), result.output
    assert told in result.stderr


@pytest.mark.parametrize("bit", [Flag.HELD, Flag.DIRTY])
def test_notices_are_the_texts_of_the_map(bit: Flag):
    status = dict.fromkeys(POINTS, 0) | {"flags": 1 << bit}
    rows = render(status, Travel(-1, -1, 1, 1)).renderable.renderables[2]
    assert bit.text in str(list(rows.columns[1].cells)[-1])


def status_rows(**values: int) -> dict[str, str]:
    """The rows of the operator's view, as text by their heading."""
    status = dict.fromkeys(POINTS, 0) | values
    rows = render(status, Travel(-1, -1, 1, 1)).renderable.renderables[2]
    headings, texts = (list(column.cells) for column in rows.columns)
    return {str(heading): str(text) for heading, text in zip(headings, texts, strict=True)}


def test_where_the_rope_goes_on_is_shown_until_it_is_followed() -> None:
    assert "Rope goes on" not in status_rows()
    there = {"resume_position_um": -12_340, "resume_direction": -1}
    assert "-12.34 mm, hauling in toward minus; gone to" in status_rows(**there)["Rope goes on"]
    doubt = {"flags_2": 1 << (Flag.RESUME_DOUBTFUL - 32)}
    assert "DOUBTFUL" in status_rows(**there, **doubt)["Rope goes on"]
    assert "Rope goes on" not in status_rows(**there, state=State.TRACKING)


def test_what_the_firmware_measures_is_shown_where_it_is_measured() -> None:
    rows = status_rows()
    assert rows["Encoder"] == "0 late interrupts, no index pulse yet"
    assert "Stack free" not in rows
    rows = status_rows(
        encoder_interrupt_max_ns=12_340,
        late_interrupts=3,
        encoder_index_pulses=7,
        missed_edges=2,
        stack_free_modbus_bytes=700,
    )
    assert rows["Encoder"] == "interrupt 12.3 us at most, 3 late interrupts, 2 missed edges"
    assert "modbus 700," in rows["Stack free"]
