# SPDX-License-Identifier: Apache-2.0
"""The connection: one request where possible, all or nothing, refusals in words."""

from typing import Any

import pytest
from levelwind.errors import RefusedError, ToolError
from levelwind.line import device as device_module
from levelwind.line import port
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import POINTS, Command, Reason, Result
from python.fake_client import OVERFLOW, FakeClient


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch) -> Device:
    monkeypatch.setattr(device_module, "RtuClient", FakeClient)
    return Device(Line("/dev/null"))


def test_values_that_follow_each_other_go_out_in_one_request(device: Device):
    device.write({"overshoot_um": 70_000, "pitch_um": 11_000, "slope_tolerance_ppm": 5})
    assert device._client.writes == [(114, [0, 11_000, 1, 4464, 5])]


def test_signed_values_come_back(device: Device):
    device.write({"reversal_minus_um": -80_000, "trim_plus_um": -3})
    assert device.read_names("reversal_minus_um", "trim_plus_um") == {
        "reversal_minus_um": -80_000,
        "trim_plus_um": -3,
    }


def test_a_refused_write_leaves_nothing_changed(device: Device):
    device.write({"encoder_pulses_per_rev": 360, "screw_lead_um": 20_000})
    with pytest.raises(RefusedError) as refusal:
        device.write({"encoder_pulses_per_rev": 500, "screw_lead_um": 10_000, "pitch_um": OVERFLOW})
    assert device.read_names("encoder_pulses_per_rev", "screw_lead_um") == {
        "encoder_pulses_per_rev": 360,
        "screw_lead_um": 20_000,
    }
    # For programs.
    parts = refusal.value.reason, refusal.value.register, refusal.value.value, refusal.value.limit
    assert parts == (Reason.OUT_OF_RANGE, "pitch_um", OVERFLOW, 100_000)
    # For people, without a word of the protocol.
    assert str(refusal.value).startswith("The value is outside the limits")
    assert "pitch_um = 100001 um, must be at most 100000 um (holding register 114)" in str(
        refusal.value
    )


def test_a_lost_read_is_repeated_and_silence_is_told(device: Device):
    device._client.silent_reads = 2
    assert device.value("state") == 0
    device._client.silent_reads = 3
    with pytest.raises(ToolError, match=r"(?s)No answer from .*unit 1.*wiring") as silence:
        device.value("state")
    assert len(str(silence.value).splitlines()) == 2


def test_a_command_that_is_done_returns(device: Device):
    device.command(Command.SAVE)
    assert device._client.writes == [(0, [Command.SAVE])]


def test_a_refused_command_says_why(device: Device):
    device._client.result = Result.REFUSED
    device._client.reason = Reason.REVERSALS_CROSSED
    device._client.put("command_address", POINTS["reversal_minus_um"].address)
    device._client.put("command_value", 90_000)
    device._client.put("command_limit", 80_000)
    with pytest.raises(RefusedError) as refusal:
        device.command(Command.APPLY)
    assert "apply refused: reversal_minus must lie" in str(refusal.value)
    assert "reversal_minus_um = 90000 um, must be at most 80000 um" in str(refusal.value)


def test_a_command_that_does_not_end_is_given_up(device: Device):
    device._client.result = Result.IN_PROGRESS
    looks = []
    with pytest.raises(ToolError, match="index has not ended"):
        device.command(Command.INDEX, lambda: looks.append(1), limit_s=0.02, poll_s=0.005)
    assert looks


@pytest.mark.parametrize("target", ["/dev/pts/7", "/dev/ttyUSB0"])
def test_a_pseudo_terminal_is_opened_without_parity(tmp_path: Any, target: str):
    link = tmp_path / "port"
    link.symlink_to(target)
    assert port.parity(Line(str(link))) == ("N" if "pts" in target else "E")
