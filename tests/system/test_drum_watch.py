# SPDX-License-Identifier: Apache-2.0
"""An encoder that does not tell the drum's motion is told, and a drum that rocks costs nothing."""

import itertools

import pytest
from levelwind.map_table import (
    BenchCommand,
    ChannelFault,
    EncoderFault,
    Mode,
    Reason,
    State,
)
from world import RequestRefusedError, World

HOLD_S = 0.1  # until a doubt has surely passed
EDGES_PER_PULSE = (1, 2, 4)
DEAD = (ChannelFault.STUCK_LOW, ChannelFault.STUCK_HIGH)
CHANNELS = ("a", "b")
ROCKING_PER_S = 25_000  # of the bench's dither: 20 us each way


def turning(edges_per_pulse: int = 2, speed: int = 20_000, index_pulses: bool = False) -> World:
    """A launch, in edges per second of two edges per pulse."""
    world = World(
        encoder_edges_per_pulse=edges_per_pulse,
        pitch_um=6000,
        overshoot_um=2400,
        overspeed_warning_edges_per_s=104_000,
        overspeed_trip_edges_per_s=120_000,
        switch_debounce_ms=1,
    )
    world.write(bench_index_pulses=index_pulses)
    world.index()
    world.drum(speed, edges_per_s2=200_000)
    world.run(0.5)
    assert world.permit
    return world


def break_channel(world: World, channel: str, fault: ChannelFault) -> None:
    """Now."""
    world.write(**{f"bench_encoder_{channel}_fault": fault})


def rock(world: World, milliseconds: int) -> None:
    """About one edge."""
    times = milliseconds * ROCKING_PER_S // 1000
    world.write(bench_argument=times, bench_command=BenchCommand.DITHER)


@pytest.mark.parametrize("speed", [20_000, -20_000, 2_500])
@pytest.mark.parametrize(("channel", "fault"), list(itertools.product(CHANNELS, DEAD)))
@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
def test_a_dead_channel_drops_the_permit_and_becomes_a_los(
    edges_per_pulse: int, channel: str, fault: ChannelFault, speed: int
):
    world = turning(edges_per_pulse, speed)
    break_channel(world, channel, fault)
    world.run(0.05)
    assert not world.permit
    assert "encoder_doubtful" in world.flags
    assert "drum_at_rest" not in world.flags
    world.run(0.5)
    assert {"los", "encoder_fault"} <= world.flags
    assert "drum_at_rest" not in world.flags
    assert world.state == State.TRACKING  # a launch in progress goes on
    kind = EncoderFault.A_STILL if channel == "a" else EncoderFault.B_STILL
    assert world.value("encoder_fault_kind") == kind
    assert world.value("encoder_fault_count") == 1


@pytest.mark.parametrize("channel", CHANNELS)
@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
def test_a_channel_dead_from_rest_on_is_only_doubted_at_first(edges_per_pulse: int, channel: str):
    """It may be a drum that rocks about an edge."""
    world = turning(edges_per_pulse)
    world.stop_drum()
    break_channel(world, channel, ChannelFault.STUCK_LOW)
    world.drum(20_000, edges_per_s2=200_000)
    world.run_until(lambda: "encoder_doubtful" in world.flags, 0.1)
    world.run(0.3)
    assert world.flags.isdisjoint({"los", "encoder_fault", "drum_at_rest"})
    world.run(0.3)
    assert {"los", "encoder_fault"} <= world.flags


@pytest.mark.parametrize("dead_s", [0.003, 0.03, 0.26, 0.45])
@pytest.mark.parametrize("speed", [48_000, -20_000])
@pytest.mark.parametrize("channel", CHANNELS)
def test_a_channel_that_is_dead_for_a_moment_of_a_fast_drum_is_a_los(
    channel: str, speed: int, dead_s: float
):
    """The edges are lost for good; a drum that rocks was not fast just before."""
    world = turning(2, speed)
    break_channel(world, channel, ChannelFault.STUCK_HIGH)
    world.run(dead_s)
    break_channel(world, channel, ChannelFault.NONE)
    world.run(0.05)
    assert {"los", "encoder_fault"} <= world.flags


@pytest.mark.parametrize("speed", [8_000, -12_000, 30_000])
@pytest.mark.parametrize("channel", CHANNELS)
def test_a_wire_that_is_loose_for_a_moment_of_a_fast_drum_is_a_los(channel: str, speed: int):
    """Half of the edges are lost while it is; chatter loses none."""
    world = turning(2, speed)
    break_channel(world, channel, ChannelFault.FLICKER)
    world.run(0.2)
    break_channel(world, channel, ChannelFault.NONE)
    world.run(0.05)
    assert {"los", "encoder_fault"} <= world.flags


@pytest.mark.parametrize("channel", CHANNELS)
def test_a_channel_that_comes_back_to_a_fast_drum_is_a_los(channel: str):
    world = turning()
    world.stop_drum()
    break_channel(world, channel, ChannelFault.STUCK_LOW)
    world.drum(20_000, edges_per_s2=200_000)
    world.run(0.4)
    assert "los" not in world.flags
    break_channel(world, channel, ChannelFault.NONE)
    world.run(0.05)
    assert {"los", "encoder_fault"} <= world.flags


@pytest.mark.parametrize("channel", CHANNELS)
def test_nothing_begins_while_the_drum_may_turn_unseen(channel: str):
    world = turning()
    break_channel(world, channel, ChannelFault.STUCK_LOW)
    world.run(1.0)
    for order in ({"command": 1}, {"jog": 1}, {"mode": Mode.CENTRE}):
        with pytest.raises(RequestRefusedError) as refused:
            world.write(**order)
        assert refused.value.reason == Reason.ENCODER_DOUBTFUL
    assert world.state == State.TRACKING


def test_the_encoder_fault_stays_until_an_indexing_has_succeeded():
    world = turning()
    break_channel(world, "a", ChannelFault.STUCK_LOW)
    world.run(1.0)
    break_channel(world, "a", ChannelFault.NONE)
    world.stop_drum()
    assert {"los", "encoder_fault"} <= world.flags
    assert "encoder_doubtful" not in world.flags
    assert not world.permit
    world.write(command=3)  # clear_fault
    assert "encoder_fault" in world.flags
    world.index()
    assert world.flags.isdisjoint({"los", "encoder_fault"})
    assert world.permit


def test_an_encoder_fault_survives_a_power_cut():
    world = turning()
    break_channel(world, "b", ChannelFault.STUCK_LOW)
    world.run(1.0)
    break_channel(world, "b", ChannelFault.NONE)
    world.stop_drum()
    world.run(5.0)
    world.write(bench_command=BenchCommand.POWER_CUT)
    world.run(0.5)
    assert {"los", "encoder_fault"} <= world.flags
    assert not world.permit
    world.index()
    assert world.flags.isdisjoint({"los", "encoder_fault"})


def test_an_indexing_on_a_drum_that_turns_unseen_does_not_clear_the_fault():
    world = turning()
    break_channel(world, "a", ChannelFault.STUCK_LOW)
    world.run(1.0)
    world.stop_drum()
    world.write(command=1)
    world.run(0.5)
    world.drum(20_000)
    world.run_until(lambda: world.value("command_result") != 1, step_s=0.01)
    world.run(0.5)
    assert {"los", "encoder_fault"} <= world.flags
    assert not world.permit


@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
def test_a_drum_that_rocks_about_an_edge_costs_nothing(edges_per_pulse: int):
    world = turning(edges_per_pulse)
    world.stop_drum()
    for stop in range(8):
        world.drum(500 + 37 * stop, edges_per_s2=1e6)
        world.run(0.3)
        world.stop_drum()
        rock(world, 400)
        world.run(0.05)
        assert "encoder_doubtful" in world.flags
        assert not world.permit
        world.run(0.35 + HOLD_S)
        assert "encoder_doubtful" not in world.flags
        assert "los" not in world.flags
        assert world.permit
    assert world.value("encoder_doubts") == 8
    assert world.value("encoder_fault_count") == 0


def test_a_drum_that_rocks_for_longer_is_told():
    world = turning()
    world.stop_drum()
    rock(world, 700)
    world.run(0.6)
    assert {"los", "encoder_fault"} <= world.flags


def test_chatter_of_a_turning_drum_is_no_los():
    world = turning()
    rock(world, 400)
    world.run(0.4 + HOLD_S)
    assert world.permit


def test_slow_rocking_is_not_even_doubted():
    world = turning()
    world.stop_drum()
    for _ in range(500):  # 1,000 transitions per second
        world.write(bench_argument=1, bench_command=BenchCommand.DITHER)
        world.run(0.002)
        assert world.permit


@pytest.mark.parametrize("speed", [20_000, -20_000, 9_000])
@pytest.mark.parametrize("channel", CHANNELS)
@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
def test_a_loose_wire_is_told(edges_per_pulse: int, channel: str, speed: int):
    world = turning(edges_per_pulse, speed)
    break_channel(world, channel, ChannelFault.FLICKER)
    world.run(0.05)
    assert "encoder_doubtful" in world.flags
    world.run(0.55)
    assert {"los", "encoder_fault"} <= world.flags


def test_the_masters_word_makes_a_doubt_a_fault_at_once():
    world = turning()
    world.write(drum_running=1)
    break_channel(world, "a", ChannelFault.STUCK_LOW)
    world.run(0.05)
    assert {"los", "encoder_fault"} <= world.flags


@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
@pytest.mark.parametrize("channel", CHANNELS)
def test_index_pulses_tell_a_dead_channel_of_a_slow_drum(edges_per_pulse: int, channel: str):
    world = turning(edges_per_pulse, 1200, index_pulses=True)  # 5 index pulses per 3 seconds
    break_channel(world, channel, ChannelFault.STUCK_LOW)
    world.run(3.0)
    assert {"los", "encoder_fault"} <= world.flags
    assert "encoder_doubtful" not in world.flags


@pytest.mark.parametrize("edges_per_pulse", EDGES_PER_PULSE)
@pytest.mark.parametrize("revolutions", [0.5, 1, 2, 5])
@pytest.mark.parametrize("speed", [8_000, -8_000])
def test_index_pulses_without_their_edges_are_told(
    edges_per_pulse: int, revolutions: float, speed: int
):
    world = turning(edges_per_pulse, speed, index_pulses=True)
    world.write(bench_argument=round(360 * revolutions), bench_command=BenchCommand.LOSE_PULSES)
    world.run(0.1 + 720 * (revolutions + 4) / abs(speed))
    assert {"los", "encoder_fault"} <= world.flags
    assert world.value("encoder_fault_kind") == EncoderFault.INDEX_MISFIT


def test_both_channels_dead_are_told_by_the_index_pulses():
    world = turning(index_pulses=True)
    for channel in CHANNELS:
        break_channel(world, channel, ChannelFault.STUCK_LOW)
    world.run(0.5)
    assert {"los", "encoder_fault"} <= world.flags


def test_a_pulse_lost_here_and_there_is_counted_and_no_los():
    world = turning(index_pulses=True)
    world.write(bench_argument=8, bench_command=BenchCommand.LOSE_PULSES)
    world.run(1.0)
    assert world.value("encoder_misfit_edges") == -16
    assert world.permit


def test_both_channels_dead_are_told_by_the_master():
    world = turning()
    world.apply_allowed = True
    world.stop_drum()
    world.write(mode=Mode.CENTRE)
    world.run_until(lambda: world.state == State.CENTRED)
    world.apply(drum_watch_ms=300)
    world.index()
    world.write(mode=Mode.TRACK)
    world.run_until(lambda: world.state == State.TRACKING)
    world.drum(20_000)
    world.run(0.5)
    world.write(drum_running=1)
    world.run(2.0)
    assert world.permit
    for channel in CHANNELS:
        break_channel(world, channel, ChannelFault.STUCK_HIGH)
    world.run(0.25)
    assert world.permit
    world.run(0.1)
    assert {"los", "encoder_fault"} <= world.flags
    assert "drum_at_rest" not in world.flags
    assert world.value("encoder_fault_kind") == EncoderFault.NO_EDGES
    with pytest.raises(RequestRefusedError) as refused:
        world.write(command=1)
    assert refused.value.reason == Reason.DRUM_RUNNING


def test_without_the_masters_word_nobody_knows_that_both_are_dead():
    world = turning()
    world.write(drum_running=1)  # drum_watch_ms is 0
    for channel in CHANNELS:
        break_channel(world, channel, ChannelFault.STUCK_HIGH)
    world.run(3.0)
    assert "encoder_fault" not in world.flags


def test_many_illegal_transitions_are_told():
    world = turning()
    world.write(bench_argument=10, bench_command=BenchCommand.ILLEGAL_TRANSITIONS)
    world.run(0.5)
    assert world.permit
    world.write(bench_argument=40, bench_command=BenchCommand.ILLEGAL_TRANSITIONS)
    world.run(0.5)
    assert {"los", "encoder_fault"} <= world.flags
    assert world.value("encoder_fault_kind") == EncoderFault.ILLEGAL
