# SPDX-License-Identifier: Apache-2.0
"""The demonstration for the page shows a level wind in order, not one in a fault."""

from pathlib import Path

import pytest
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import Fault
from levelwind.serve import demonstration
from levelwind.simulate import launches, simulator


def test_the_launch_begins_with_the_rope_out_and_the_permit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(demonstration, "PAUSE_S", 0.1)
    port, said, found = str(tmp_path / "port"), [], {}

    def launch(device: Device, *_: object) -> None:
        wanted = ("fault", "launch_inhibit", "rope_out_mm")
        found.update({name: device.value(name) for name in wanted})
        shown.close()

    monkeypatch.setattr(launches, "play", launch)
    with simulator.Simulator(simulator.arguments(port, speed="6")), Device(Line(port)) as device:
        shown = demonstration.Demonstration(lambda: device, said.append)
        shown.start()
        shown._thread.join(60)
    assert said == []
    assert found["rope_out_mm"] >= demonstration.PULLED_OUT_MM
    assert Fault(found["fault"]) == Fault.NONE
    assert found["launch_inhibit"] == 0
