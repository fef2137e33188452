# SPDX-License-Identifier: Apache-2.0
"""The worked examples of doc/integration.md against a slave that was just switched on."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.map_table import Flag
from slave import RawLine, Simulator, Slave

PAGE = Path(__file__).parents[2] / "doc" / "integration.md"
EXCHANGE = re.compile(r"^    > ([0-9A-F ]+)\n    < ([0-9A-F ]+)$", re.M)


def test_documented_frames(own_simulator: Callable[..., Simulator], target: str) -> None:
    if target == "board":
        pytest.skip("hardware has no permit before its set is saved, and its frames say so")
    exchanges = EXCHANGE.findall(PAGE.read_text())
    assert len(exchanges) > 8
    port = str(own_simulator().port)
    slave = Slave(port)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    slave.close()
    line = RawLine(port)
    for request, answer in exchanges:
        real = line.exchange(bytes.fromhex(request))
        assert real == bytes.fromhex(answer), f"> {request}\nreally: {real.hex(' ').upper()}"
    line.close()
