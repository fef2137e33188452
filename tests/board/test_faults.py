# SPDX-License-Identifier: Apache-2.0
"""What only the board shows: clocks, restarts, and what happens while the flash is written."""

import os
from collections.abc import Callable

import pytest
from levelwind.map_table import Command, Event, LineFormat, Mode, Result, State
from slave import crc16

from board.machine import IRQ0, READ_STATE, START_S, Board, Cut, available, frame
from board.ready import indexed

pytestmark = pytest.mark.skipif(bool(available()), reason=available())

BAUD_RATES = [1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200]
FORMATS = {
    LineFormat.FORMAT_8E1: ("E", 1),
    LineFormat.FORMAT_8O1: ("O", 1),
    LineFormat.FORMAT_8N1: ("N", 1),
    LineFormat.FORMAT_8N2: ("N", 2),
}
BAUD_ERROR_MAX = 0.01
SAVE = frame(command=Command.SAVE)
NOWHERE = 0x60000000
CUT_STRIDE = os.environ.get("LEVELWIND_CUT_STRIDE")  # 1: a cut in every operation
BEFORE_JOURNAL_S = 0.15
SYSTEM_TIMER, PENDSV = IRQ0 + 50, 14  # TIM5


def use_line(board: Board, baud: int, line_format: LineFormat) -> None:
    """Set the line by APPLY, SAVE and a restart, as a master does."""
    board.apply(baud_rate=baud, line_format=line_format)
    assert board.command(Command.SAVE) == Result.DONE
    board.line_settings(baud, *FORMATS[line_format])
    board.power_cycle(0.6)


def events(board: Board) -> list[int]:
    """Kinds of all events in the log, oldest first."""
    count = board.value("log_count")
    newest = board.value("log_sequence")
    kinds = []
    for sequence in range(newest - count + 1, newest + 1):
        first = sequence % 64 * 16
        pdu = bytes([20, 7, 6, 0, 1, *first.to_bytes(2, "big"), 0, 16])
        record = board.request(pdu)[4:]
        kinds.append(int.from_bytes(record[12:14], "big"))
    return kinds


class TestLine:
    """Every rate and format is what it says, on the wire."""

    @pytest.mark.parametrize("line_format", FORMATS, ids=lambda f: f.label)
    @pytest.mark.parametrize("baud", BAUD_RATES)
    def test_every_rate_and_format_is_right_on_the_wire(self, baud: int, line_format: LineFormat):
        board = Board()
        use_line(board, baud, line_format)
        board.send(READ_STATE)
        board.run(0.1 + 200 / baud)
        heard = board.heard()
        assert crc16(bytes(byte.value for byte in heard)) == 0
        assert heard
        for byte in heard:
            assert byte.baud_millihz / 1000 == pytest.approx(baud, rel=BAUD_ERROR_MAX)
            assert ("NOE"[byte.parity], byte.stop_bits) == FORMATS[line_format]


class TestClock:
    """The kernel's clock, and the processor's."""

    LATENCY_MS = 2

    def drift_ms(self, board: Board, seconds: float) -> float:
        before_ms, before_ns = board.value("uptime_ms"), board.now_ns
        board.run(seconds)
        return board.value("uptime_ms") - before_ms - (board.now_ns - before_ns) / 1e6

    def test_it_is_not_slow(self):
        assert abs(self.drift_ms(Board(), 20)) < self.LATENCY_MS

    def test_it_does_not_stand_still_while_the_flash_is_erased(self):
        board = Board(flash_erase_us=2_000_000)
        board.spoil_free_storage()
        board.clear_seen()
        board.write(command=Command.SAVE)
        drift_ms = self.drift_ms(board, 5)
        assert board.seen.stall_max_ns > 1.9e9, "no erasure fell into it"
        assert abs(drift_ms) < self.LATENCY_MS

    def test_an_erasure_is_no_thread_that_hangs(self):
        board = Board(flash_erase_us=2_000_000, lsi_hz=47_000)
        board.spoil_free_storage()
        board.clear_seen()
        assert board.command(Command.SAVE) == Result.DONE
        board.run(3)
        assert board.seen.stall_max_ns > 1.9e9
        assert board.seen.resets_software + board.seen.resets_watchdog == 0

    def test_buses_and_flash_run_within_their_limits(self):
        board = Board()
        assert board.clock_hz(0) == 168_000_000
        assert board.complaints == ""

    def test_without_the_external_clock_it_runs_by_the_internal_one_and_tells(self):
        board = Board(hse_hz=0)
        assert board.clock_hz(0) == 168_000_000
        assert "clock_fallback" in board.flags
        assert Event.CLOCK_FALLBACK in events(board)

    def test_with_it_nothing_is_told(self):
        board = Board()
        assert "clock_fallback" not in board.flags
        assert Event.CLOCK_FALLBACK not in events(board)

    def test_a_clock_that_fails_later_restarts_by_the_internal_one(self):
        board = indexed()
        board.drum(24_000, 240_000)
        board.run(0.5)
        board.set_hse(0)
        board.run(1.0)
        assert board.seen.resets_software == 1
        assert {"clock_fallback", "watchdog_reset"} <= board.flags
        assert board.state == State.UNINDEXED


class TestRestarts:
    """Each is counted, and the hardware watchdog ends what hangs."""

    def test_restarts_within_two_seconds_of_the_start_are_counted(self):
        board = Board()
        board.run(4)
        before = board.read("boots", "watchdog_resets")
        stored = board.seen.flash_operations
        for _ in range(3):
            board.set_register(15, NOWHERE)
            board.run(BEFORE_JOURNAL_S)
        operations = board.seen.flash_operations
        board.run(START_S - BEFORE_JOURNAL_S)
        after = board.read("boots", "watchdog_resets")
        assert operations == stored, "the journal was written meanwhile"
        assert board.seen.resets_software == 3
        assert after["boots"] == before["boots"] + 3
        assert after["watchdog_resets"] == before["watchdog_resets"] + 3
        board.run(4)
        board.power_cycle(0.6)
        assert board.read("boots", "watchdog_resets") == {
            "boots": before["boots"] + 4,
            "watchdog_resets": before["watchdog_resets"] + 3,
        }

    def test_a_thread_switch_that_hangs_is_ended_within_a_second(self):
        board = Board()
        assert board.run_to_exception(PENDSV, 0.01)
        board.hang_handler()
        board.run(1.2)
        assert board.seen.resets_software == 1

    @pytest.mark.parametrize(("lsi_hz", "within_s"), [(17_000, 17), (47_000, 7)])
    def test_an_interrupt_that_hangs_is_ended_by_the_hardware_watchdog(
        self, lsi_hz: int, within_s: float
    ):
        board = Board(lsi_hz=lsi_hz)
        assert board.run_to_exception(SYSTEM_TIMER, 0.01)
        board.hang_handler()
        board.run(within_s)
        assert board.seen.resets_watchdog == 1
        assert "watchdog_reset" in board.flags

    def test_no_pulse_and_no_byte_comes_out_of_a_restart(self):
        board = indexed()
        board.clear_seen()
        board.set_register(15, NOWHERE)
        board.run(1.0)
        assert board.seen.resets_software == 1
        assert board.seen.pulses == 0
        assert board.heard() == []
        assert board.state == State.UNINDEXED


class TestFlash:
    """What happens while it is written."""

    @pytest.mark.parametrize("when", [Cut.BEFORE, Cut.IN, Cut.AFTER], ids=lambda w: w.name.lower())
    @pytest.mark.parametrize("erases", [False, True], ids=["save", "erasure and copies"])
    def test_a_cut_in_any_operation_of_a_save_leaves_the_old_set_or_the_new_one(
        self, erases: bool, when: Cut, record_property: Callable[[str, object], None]
    ):
        board = Board()
        board.apply(pitch_um=11_000)
        assert board.command(Command.SAVE) == Result.DONE
        board.run(3)
        board.apply(pitch_um=11_500)
        board.run(3)
        if erases:
            board.spoil_free_storage()
        before = board.read("boots", "log_sequence", "log_unsaved")
        state = board.save()
        operations = board.seen.flash_operations
        board.send(SAVE)
        board.run(4)
        operations = board.seen.flash_operations - operations
        assert operations > (200 if erases else 50)
        found = set()
        places = range(1, operations + 1, int(CUT_STRIDE or (36 if erases else 9)))
        for operation in places:
            board.restore(state)
            board.cut_power(operation, when)
            board.send(SAVE)
            board.run(4)
            assert not board.powered
            board.power_on()
            board.run(0.6)
            at = board.read("active.pitch_um", "boots", "log_sequence")
            assert at["boots"] == before["boots"] + 1, f"operation {operation}: {at}"
            kept = before["log_sequence"] - before["log_unsaved"]
            assert at["log_sequence"] > kept, f"operation {operation}: {at}, {before}"
            found.add(at["active.pitch_um"])
        record_property("cuts", len(places))
        assert found <= {11_000, 11_500}
        assert 11_000 in found

    def test_no_answer_comes_a_second_late_after_an_erasure(self):
        # The first journal erases. The request's last byte comes before that.
        board = Board(start_s=0.15)
        state = board.save()
        board.run_until(lambda: board.seen.flash_operations > 0, step_s=0.0002)
        erasure_ns = board.now_ns
        for early_us in (300, 1_000, 2_500):
            board.restore(state)
            board.heard()
            sending_ns = len(READ_STATE) * board.char_ns + early_us * 1000
            board.run_ns(erasure_ns - board.now_ns - sending_ns)
            board.send(READ_STATE)
            board.run(3)
            assert board.seen.stall_max_ns > 0.9e9
            assert [b for b in board.heard() if b.start_ns - erasure_ns > 0.3e9] == []

    def off(self) -> Board:
        """A board whose next save erases, in the mode off."""
        board = Board()
        board.mode(Mode.OFF)
        board.run(0.5)
        board.spoil_free_storage()
        board.clear_seen()
        return board

    def test_nothing_is_written_while_the_drum_turns_and_no_edge_is_lost(self):
        board = self.off()
        before = board.value("net_edges")
        board.drum(24_000, 240_000)
        board.run(0.2)
        board.write(command=Command.SAVE)
        board.run(2)
        assert board.seen.flash_operations == 0
        board.stop_drum()
        assert board.value("net_edges") - before == board.seen.edges
        board.run(2)
        assert board.value("command_result") == Result.DONE
        assert board.seen.stall_max_ns > 0.9e9

    def test_edges_of_a_drum_that_begins_to_turn_in_an_erasure_are_not_lost(self):
        board = self.off()
        before = board.value("net_edges")
        board.send(SAVE)
        board.run_until(lambda: board.seen.flash_operations > 0, step_s=0.001)
        board.drum(24_000, 240_000)
        board.run(2)
        board.stop_drum()
        assert board.seen.stall_max_ns > 0.9e9
        assert board.seen.edges > 10_000
        assert board.value("net_edges") - before == board.seen.edges
        assert "odometer_doubtful" not in board.flags
