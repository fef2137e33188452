# SPDX-License-Identifier: Apache-2.0
"""The event log: what happened, in order, also before a power cut."""

import json
import signal
from collections.abc import Callable

import pytest
from levelwind.line import event_log
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import Command, Event, Result
from slave import Simulator, Slave
from test_tool import output


def events(port: str) -> list[event_log.LogRecord]:
    with Device(Line(port)) as device:
        return event_log.read(device)


def test_a_launch_leaves_its_trace(slave: Slave, port: str) -> None:
    before = slave.read("log_sequence")
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("log_sequence") >= before + 3)
    slave.command(Command.STOP)
    slave.wait(lambda: slave.read("log_sequence") >= before + 5)
    boots = slave.read("boots")
    slave.close()
    fresh = [record for record in events(port) if record.sequence > before]
    assert [Event(record.event) for record in fresh] == [
        Event.INDEX_STARTED,
        Event.INDEX_DONE,
        Event.TRACKING_STARTED,
        Event.STOPPED,
        Event.TRACKING_ENDED,
    ]
    assert [record.sequence for record in fresh] == list(range(before + 1, before + 6))
    assert {record.boot for record in fresh} == {boots}
    times = [record.time_ms for record in fresh]
    assert times == sorted(times)
    assert fresh[-1].detail_name == fresh[-1].state_name == "ready"


def test_the_ring_keeps_the_last_64(slave: Slave, port: str) -> None:
    before = slave.read("log_sequence")
    for _ in range(70):
        slave.command(Command.STOP)
    slave.close()
    records = events(port)
    assert len(records) == event_log.RECORDS
    newest = records[-1].sequence
    assert newest >= before + 70
    assert [r.sequence for r in records] == list(range(newest - 63, newest + 1))


def test_log_and_counters_survive_a_kill(
    target: str, own_simulator: Callable[..., Simulator]
) -> None:
    if target == "qemu":
        pytest.skip("the emulated board keeps its storage in RAM")
    first = own_simulator()
    slave = Slave(str(first.port))
    slave.wait(lambda: slave.read("log_unsaved") == 0)  # the power-up's, at once
    assert slave.command(Command.STOP) == Result.DONE
    slave.wait(lambda: slave.read("log_unsaved") == 0)
    newest = slave.read("log_sequence")
    assert slave.read("powered_s") >= 2  # what belongs together waits for it
    slave.close()
    first.stop(signal.SIGKILL)

    second = own_simulator()
    port = str(second.port)
    shown = json.loads(output(port, "log", "--json"))
    assert shown["counters"]["boots"] == 2
    assert shown["counters"]["powered_s"] >= 2
    kept = [(e["sequence"], e["boot"], e["event"]) for e in shown["events"]]
    assert (newest, 1, "stopped") in kept
    after = [e for e in shown["events"] if e["boot"] == 2]
    assert after[0]["event"] == "power_up"
    assert after[0]["sequence"] > newest  # no number is given anew
    text = output(port, "log", "--last", "20")
    assert text.index("The command stop") < text.rindex("Power-up")
    assert "2 power-ups, 0 of them by the watchdog" in text
    assert second.stop() == 0
