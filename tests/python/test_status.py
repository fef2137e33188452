# SPDX-License-Identifier: Apache-2.0
"""What the operator reads: nothing green that is not known, and for each reason the next action."""

import io
from collections.abc import Mapping

import pytest
from levelwind.line.event_log import LogRecord
from levelwind.line.live import Travel
from levelwind.map_table import POINTS, Event, Fault, Flag, LaunchInhibit, Mode, State
from levelwind.show.advice import inhibit_reasons
from levelwind.show.status import describe_state, render, render_no_data
from rich.console import Console

TRAVEL = Travel(-83_000, -80_000, 80_000, 83_000)


def status(*bits: Flag | LaunchInhibit, **values: int) -> dict[str, int]:
    """A snapshot with these flags and reasons."""
    flags = sum(1 << bit for bit in bits if isinstance(bit, Flag))
    inhibit = sum(1 << bit for bit in bits if isinstance(bit, LaunchInhibit))
    words = {"flags": flags & 0xFFFFFFFF, "flags_2": flags >> 32, "launch_inhibit": inhibit}
    return dict.fromkeys(POINTS, 0) | words | values


def text(now: Mapping[str, int]) -> str:
    """The panel as it is read."""
    console = Console(file=io.StringIO(), width=120)
    console.print(render(now, TRAVEL))
    return console.file.getvalue()


@pytest.mark.parametrize("state", [State.UNINDEXED, State.FAULT, State.OFF, State.SEEKING])
def test_synchronization_is_unknown_until_indexed(state: State):
    shown = text(status(state=state, fault=Fault.OVERSPEED if state == State.FAULT else 0))
    assert "unknown until indexed" in shown
    assert "in synchronization" not in shown
    assert "in synchronization" in text(status(Flag.INDEXED, state=State.TRACKING))


def test_the_firmware_is_named_with_its_image_where_there_is_one():
    named = status(version_minor=1, image_hash_high=0x0000_ABCD, image_hash_low=0x1234_5678)
    assert "0.1.0, image 0000abcd12345678" in text(named)
    assert "0.1.0 " in text(status(version_minor=1))
    assert "image" not in text(status(version_minor=1))


def test_the_position_after_a_loss_is_uncertain():
    lost = status(Flag.INDEXED, Flag.LOS, Flag.LOS2_PLUS, state=State.TRACKING, position_um=1230)
    assert "+1.23 mm (0 usteps), sweep, UNCERTAIN since synchronization was lost" in text(lost)
    assert "UNCERTAIN" not in text(status(Flag.INDEXED, state=State.TRACKING, position_um=1230))


def test_a_drum_that_was_taken_up_is_a_loss():
    shown = text(status(Flag.INDEXED, Flag.LOS, Flag.REACQUIRED, state=State.TRACKING))
    assert "THE ROPE MAY BE LAID WRONG" in shown
    assert "the turning drum was taken up" in shown


def test_a_loss_sends_to_the_rope_before_the_index():
    lost = status(
        *(Flag.LOS, Flag.LOS1_PLUS, Flag.DRUM_AT_REST),
        *(LaunchInhibit.LOS, LaunchInhibit.NOT_TRACKING),
        state=State.UNINDEXED,
    )
    first, second = inhibit_reasons(lost)
    assert "look at the rope first, then `levelwind index`" in first
    assert second == "The position is unknown: `levelwind index`"


def test_rope_laid_standing_is_shown_like_a_loss_with_turns_and_place():
    laid = {
        "state": State.TRACKING,
        "rope_standing_millirev": 3333,
        "rope_standing_time_ms": 61_000,
    }
    bits = (Flag.ROPE_LAID_STANDING, LaunchInhibit.ROPE_LAID_STANDING, Flag.DRUM_AT_REST)
    shown = text(status(Flag.INDEXED, *bits, **laid))
    assert "3.3 DRUM TURNS OF ROPE WERE LAID WHILE THE CARRIAGE STOOD" in shown
    assert "at an unknown place, 61.0 s after power-up" in shown
    known = {"rope_standing_place_known": 1, "rope_standing_position_um": -12_340}
    shown = text(status(*bits, **laid, **known, look_before_power_up=16))
    assert "at -12.34 mm, 61.0 s after an earlier power-up" in shown
    (before,) = inhibit_reasons(status(*bits, **laid))
    assert before.endswith("then `levelwind index`, then `levelwind acknowledge`")
    (after,) = inhibit_reasons(status(Flag.INDEXED, *bits, **laid))
    assert after.endswith("then `levelwind acknowledge`")
    assert "index" not in after


@pytest.mark.parametrize(
    ("state", "mode", "bits", "action"),
    [
        (State.READY, Mode.TRACK, [Flag.HELD, Flag.DRUM_AT_REST], "`levelwind mode track`"),
        (State.READY, Mode.TRACK, [], "let the drum come to rest"),
        (State.READY, Mode.TRACK, [Flag.DRUM_AT_REST], "about to follow"),
        (State.READY, Mode.CENTRE, [Flag.DRUM_AT_REST], "`levelwind mode track`"),
        (State.CENTRED, Mode.CENTRE, [], "`levelwind mode track`"),
        (State.CENTRING, Mode.CENTRE, [], "`levelwind mode track`"),
        (State.UNINDEXED, Mode.TRACK, [Flag.DRUM_AT_REST], "unknown: `levelwind index`"),
        (State.UNINDEXED, Mode.TRACK, [], "let the drum come to rest, then `levelwind index`"),
        (
            State.OFF,
            Mode.OFF,
            [Flag.DRUM_AT_REST],
            "`levelwind mode track`, then `levelwind index`",
        ),
        (State.JOGGING, Mode.TRACK, [], "end the jog"),
        (State.SPAN_CHECK, Mode.TRACK, [], "wait for the end"),
    ],
)
def test_not_tracking_names_the_next_action_for_this_state(
    state: State, mode: Mode, bits: list[Flag], action: str
):
    now = status(*bits, LaunchInhibit.NOT_TRACKING, state=state, active_mode=mode)
    (reason,) = inhibit_reasons(now)
    assert action in reason
    if state == State.READY:
        assert reason in describe_state(now)


@pytest.mark.parametrize("bit", list(LaunchInhibit))
@pytest.mark.parametrize("state", [State.TRACKING, State.UNINDEXED, State.READY, State.FAULT])
def test_every_reason_names_an_action(bit: LaunchInhibit, state: State):
    (reason,) = inhibit_reasons(status(bit, Flag.HELD, state=state))
    words = ("`levelwind", "check", "look", "wait", "turn the drum", "set the", "let the")
    assert any(word in reason for word in words), reason
    assert "{" not in reason


def test_a_fault_says_it_all_in_one_reason():
    bits = (LaunchInhibit.FAULT, LaunchInhibit.NOT_TRACKING, Flag.DRUM_AT_REST)
    reasons = inhibit_reasons(status(*bits, state=State.FAULT, fault=Fault.STEPPER_ALARM))
    assert reasons == ["A fault stands: remove its cause, then `levelwind index`"]


def test_no_data_is_no_permit():
    console = Console(file=io.StringIO(), width=120)
    console.print(render_no_data("No answer.", 12.3))
    shown = console.file.getvalue()
    assert "NO DATA: take it as NOT PERMITTED" in shown
    assert "Nothing heard for 12 s" in shown


@pytest.mark.parametrize(
    ("event", "detail", "shown"),
    [
        (Event.POWER_UP, 100, "version 0.1.0"),
        (Event.INDEX_DONE, -130, "other switch -0.13 mm from its place"),
        (Event.LOS2_PLUS, 3, "3 since power-up"),
        (Event.FAULT_SET, Fault.INDEX_SPAN, "index span"),
        (Event.SLOT_DAMAGED, 3, "second slot of event log and counters"),
        (Event.OVERSPEED_WARNING, 52_311, "52311 edges/s"),
        (Event.SAVE_FAILED, -5, "Input/output error"),
        (Event.ROPE_LAID_STANDING, 3333, "3.3 drum turns"),
        (Event.LOOK_PENDING, 0b10100, "LOS 2+, rope laid while the carriage stood"),
        (Event.STOPPED, 0, ""),
        (999, 7, "7"),
    ],
)
def test_details_of_the_log_are_words_and_units(event: int, detail: int, shown: str):
    assert LogRecord(1, 1, 0, event, 0, detail, 0, 0).detail_text == shown


@pytest.mark.parametrize("event", list(Event))
def test_no_detail_of_the_log_is_a_bare_number(event: Event):
    shown = LogRecord(1, 1, 0, event, 0, 1, 0, 0).detail_text
    assert not shown.lstrip("+-").isdigit()
