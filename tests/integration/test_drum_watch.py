# SPDX-License-Identifier: Apache-2.0
"""Over the line and through the pins: an encoder that does not tell the drum's motion is told."""

import pytest
from levelwind.map_table import (
    BenchCommand,
    ChannelFault,
    Command,
    EncoderFault,
    Flag,
    LaunchInhibit,
    Reason,
    Result,
    State,
)
from slave import Slave
from test_life import index, turn_drum


@pytest.mark.parametrize(
    ("channel", "kinds"),
    [
        ("a", (EncoderFault.A_STILL, EncoderFault.A_FLICKERS)),
        ("b", (EncoderFault.B_STILL, EncoderFault.B_FLICKERS)),
    ],
)
def test_a_dead_channel_is_told_and_cleared_by_an_indexing(
    slave: Slave, channel: str, kinds: tuple[EncoderFault, ...]
) -> None:
    """One that dies a moment before a block of the watch ends is told as a loose one."""
    slave.write("bench_index_pulses", 0)
    index(slave)
    turn_drum(slave, 200_000)
    slave.wait(lambda: slave.read("bench_drum_actual_millirpm") >= 190_000)
    slave.write(f"bench_encoder_{channel}_fault", ChannelFault.STUCK_LOW)
    slave.wait(lambda: slave.flag(Flag.ENCODER_DOUBTFUL))
    assert slave.read("launch_inhibit") & 1 << LaunchInhibit.ENCODER
    assert slave.command(Command.INDEX) == Result.REFUSED
    assert slave.read("command_reason") == Reason.ENCODER_DOUBTFUL
    slave.wait(lambda: slave.flag(Flag.ENCODER_FAULT))
    assert slave.flag(Flag.LOS)
    assert slave.read("encoder_fault_kind") in kinds
    assert slave.read("state") == State.TRACKING

    turn_drum(slave, 0)
    slave.write(f"bench_encoder_{channel}_fault", ChannelFault.NONE)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    assert slave.flag(Flag.ENCODER_FAULT)
    index(slave)
    assert not slave.flag(Flag.ENCODER_FAULT)
    assert slave.flag(Flag.LAUNCH_PERMIT)


def test_a_drum_that_rocks_about_an_edge_costs_nothing(slave: Slave) -> None:
    index(slave)
    slave.write("bench_argument", 7_500)  # 300 ms
    slave.write("bench_command", BenchCommand.DITHER)
    slave.wait(lambda: slave.read("encoder_doubts") >= 1)
    slave.wait(lambda: not slave.flag(Flag.ENCODER_DOUBTFUL))
    assert not slave.flag(Flag.LOS)
    slave.wait(lambda: slave.flag(Flag.LAUNCH_PERMIT))
