# SPDX-License-Identifier: Apache-2.0
"""The tool on lines that are not clean: it never says what is not so."""

import json
import os
import pty
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from levelwind import interrupt
from levelwind.conformance.line import sealed
from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.line.port import Line, open_port
from levelwind.map_table import POINTS, Command
from python.dirty_line import (
    DirtyLine,
    Pieces,
    Sent,
    clean,
    connect,
    echoing,
    levelwind,
    losing,
    noise_before,
)

COMMAND = POINTS["command"].address
MAY_BE_DONE = "sent, may have been done"
SCRATCH = POINTS["encoder_pulses_per_rev"].address


@pytest.fixture
def line(monkeypatch: pytest.MonkeyPatch) -> DirtyLine:
    return connect(monkeypatch)


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    """The program takes the signals to itself; here it is not a process of its own."""
    ending = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.getsignal(number) for number in ending}
    hook = sys.unraisablehook
    interrupt.prepare()
    yield
    sys.unraisablehook = hook
    for number, handler in before.items():
        signal.signal(number, handler)


def said(*arguments: str) -> str:
    """What a command that ends well prints."""
    done = levelwind(*arguments)
    assert done.exit_code == 0, done.output
    return done.stdout


def refused(*arguments: str) -> str:
    """What a command that does not end well says: a few lines, no traceback."""
    done = levelwind(*arguments)
    assert done.exit_code == 1, (done.output, done.exception)
    assert isinstance(done.exception, SystemExit)
    assert len(done.stderr.strip().splitlines()) <= 3
    return done.stderr


def is_command(command: Command) -> Callable[[Sent], bool]:
    frame = sealed(bytes([1, 16, 0, COMMAND, 0, 1, 2, 0, command]))
    return lambda sent: sent.frame == frame


def is_write_of(name: str) -> Callable[[Sent], bool]:
    head = b"\x10" + POINTS[name].address.to_bytes(2, "big")
    return lambda sent: sent.frame[1:4] == head


def no_write_is_sent_again(line: DirtyLine) -> bool:
    lost = [sent.frame for sent in line.sent if not sent.reading and not sent.delivered]
    return all([sent.frame for sent in line.sent].count(frame) == 1 for frame in lost)


# ---- bytes before the answer ---------------------------------------------------------------------


@pytest.mark.parametrize("noise", ["ff", "00", "ff ff ff", "00 ff", "01", "01 10 00 72"])
def test_bytes_before_the_answer_do_not_hide_it(line: DirtyLine, noise: str):
    line.carry = noise_before(bytes.fromhex(noise))
    said("set", "pitch_um=11111")
    assert json.loads(said("get", "pitch_um", "--json"))["pitch_um"]["staged"] == 11_111
    assert "UNINDEXED" in said("status")
    assert len(line.executed()) == 1


@pytest.mark.parametrize("unit", [3, 9, 16, 30, 129, 247])
def test_bytes_before_the_answer_of_any_unit(line: DirtyLine, unit: int):
    line.world.apply(unit_id=unit)
    line.world.write(command=Command.TRY_LINE)
    line.carry = noise_before(b"\xff")
    said("set", "pitch_um=11111", "--unit", str(unit))


def test_where_no_answer_is_intact_that_is_said(line: DirtyLine):
    def damaged(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        return [(0.0, b"\xff" + honest(sent.frame)[:-1] + b"\x00")]

    line.carry = damaged
    told = refused("status")
    assert "Bytes came, no whole frame" in told
    assert "power" not in told
    told = refused("set", "pitch_um=11111")
    assert MAY_BE_DONE in told
    assert "Bytes came, no whole frame" in told
    assert line.world.value("pitch_um") == 11_111


def test_a_frame_of_another_unit_before_the_answer_is_passed_over(line: DirtyLine):
    line.carry = noise_before(sealed(bytes.fromhex("09 03 04 00 00 2b 67")))
    assert "UNINDEXED" in said("status")
    said("set", "pitch_um=11111")
    said("log")


def test_frames_of_another_unit_only_name_that_unit(line: DirtyLine):
    line.carry = lambda sent, honest: [(0.0, sealed(bytes.fromhex("09 03 04 00 00 2b 67")))]
    assert "unit 9" in refused("status")


# ---- an answer that is lost ----------------------------------------------------------------------


def test_a_lost_answer_to_a_write_is_told_as_perhaps_done(line: DirtyLine):
    line.carry = losing(is_write_of("pitch_um"))
    told = refused("set", "pitch_um=11111")
    assert told.startswith(f"levelwind: pitch_um: {MAY_BE_DONE}")
    assert "levelwind diff" in told
    assert line.world.value("pitch_um") == 11_111
    assert len(line.executed()) == 1


def test_a_lost_answer_in_a_set_of_several_says_which_half(line: DirtyLine):
    line.carry = losing(is_write_of("screw_lead_um"))
    told = refused("set", "encoder_pulses_per_rev=500", "screw_lead_um=10000", "pitch_um=11111")
    assert f"screw_lead_um: {MAY_BE_DONE}" in told
    assert "Written: encoder_pulses_per_rev." in told
    assert "Not sent: pitch_um." in told
    assert "levelwind diff" in told
    assert line.world.read("encoder_pulses_per_rev", "screw_lead_um", "pitch_um") == {
        "encoder_pulses_per_rev": 500,
        "screw_lead_um": 10_000,
        "pitch_um": 12_000,
    }


def test_a_refused_set_that_could_not_be_put_back_says_so(line: DirtyLine):
    written: list[Sent] = []

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        if is_write_of("pitch_um")(sent):
            return [(0.0, sealed(bytes([1, 0x90, 3])))]
        answer = honest(sent.frame)
        if is_write_of("encoder_pulses_per_rev")(sent):
            written.append(sent)
            if len(written) == 2:
                return []
        return [(0.0, answer)]

    line.carry = carry
    done = levelwind("set", "encoder_pulses_per_rev=500", "pitch_um=11111")
    assert done.exit_code == 1
    assert "exception 03" in done.stderr
    assert "Putting back encoder_pulses_per_rev failed" in done.stderr
    assert MAY_BE_DONE in done.stderr
    assert "levelwind diff" in done.stderr


@pytest.mark.parametrize(
    ("name", "look"),
    [
        ("index", "levelwind status"),
        ("apply", "levelwind diff"),
        ("save", "levelwind diff"),
        ("stop", "levelwind status"),
        ("clear-fault", "levelwind status"),
    ],
)
def test_a_lost_answer_to_a_command_is_told_as_perhaps_done(line: DirtyLine, name: str, look: str):
    command = Command[name.upper().replace("-", "_")]
    line.carry = losing(is_command(command))
    told = refused(name)
    assert told.startswith(f"levelwind: {command.label}: {MAY_BE_DONE}")
    assert look in told
    assert line.world.value("command_code") == command
    assert [sent.frame[8] for sent in line.executed()] == [command]


def test_a_line_that_fails_while_a_command_runs_is_told_as_perhaps_done(line: DirtyLine):
    def dies(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        answer = honest(sent.frame)
        return [] if line.executed() and sent.reading else [(0.0, answer)]

    line.carry = dies
    told = refused("index")
    assert f"index: {MAY_BE_DONE}" in told
    assert "levelwind stop" in told


def test_what_was_done_before_the_line_failed_is_told(line: DirtyLine):
    line.carry = lambda sent, honest: [] if line.executed() else [(0.0, honest(sent.frame))]
    told = refused("mode", "centre")
    assert "Before that was done: mode" in told


@pytest.fixture
def backup(line: DirtyLine, tmp_path: Path) -> Path:
    """A backup with another pitch than the controller has."""
    path = tmp_path / "winch.yaml"
    said("backup", str(path))
    path.write_text(re.sub("pitch_um: 12000", "pitch_um: 11000", path.read_text()))
    line.sent.clear()
    return path


def test_a_restore_whose_answer_is_lost_puts_back(line: DirtyLine, backup: Path):
    before = line.world.read("pitch_um", "active.pitch_um")
    line.carry = losing(lambda sent: sent.executed and b"\x2a\xf8" in sent.frame)  # 11,000
    told = refused("restore", str(backup))
    assert len(line.executed()) > 1
    assert MAY_BE_DONE in told
    assert "Put back: the active parameters are as before, and nothing is staged" in told
    assert line.world.read("pitch_um", "active.pitch_um") == before
    assert no_write_is_sent_again(line)


def test_a_restore_whose_apply_does_not_arrive_puts_back(line: DirtyLine, backup: Path):
    before = line.world.read("pitch_um", "active.pitch_um")

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        if is_command(Command.APPLY)(sent):
            return []
        sent.delivered = True
        return [(0.0, honest(sent.frame))]

    line.carry = carry
    told = refused("restore", str(backup))
    assert f"apply: {MAY_BE_DONE}" in told
    assert "Put back: the active parameters are as before, and nothing is staged" in told
    assert line.world.read("pitch_um", "active.pitch_um") == before
    assert no_write_is_sent_again(line)


def interrupting(at: Callable[[Sent], bool]) -> Callable[..., Pieces]:
    """Ctrl-C while the first request of a kind has no answer yet; it has arrived."""
    cut: list[Sent] = []

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        answer = honest(sent.frame)
        if not cut and at(sent):
            cut.append(sent)
            raise KeyboardInterrupt
        sent.delivered = True
        return [(0.0, answer)]

    return carry


@pytest.mark.parametrize("nth", range(1, 6))
def test_a_restore_cut_off_by_ctrl_c_puts_back(line: DirtyLine, backup: Path, nth: int):
    before = line.world.read("pitch_um", "active.pitch_um")
    line.carry = interrupting(lambda sent: len(line.executed()) == nth)
    done = levelwind("restore", str(backup))
    assert done.exit_code == 130
    assert "Put back: the active parameters are as before" in done.stderr
    assert line.world.read("pitch_um", "active.pitch_um") == before


def test_a_restore_cut_off_by_ctrl_c_after_it_was_done_says_so(line: DirtyLine, backup: Path):
    line.carry = interrupting(is_command(Command.APPLY))
    done = levelwind("restore", str(backup))
    assert done.exit_code == 130
    assert "It was done" in done.stderr
    assert line.world.value("active.pitch_um") == 11_000


def test_a_set_of_several_cut_off_by_ctrl_c_says_which_half(line: DirtyLine):
    line.carry = interrupting(is_write_of("screw_lead_um"))
    done = levelwind("set", "encoder_pulses_per_rev=500", "screw_lead_um=10000", "pitch_um=11111")
    assert done.exit_code == 130
    assert f"screw_lead_um: {MAY_BE_DONE}" in done.stderr
    assert "Written: encoder_pulses_per_rev. Not sent: pitch_um." in done.stderr


def test_a_restore_whose_lost_apply_was_done_says_so(line: DirtyLine, backup: Path):
    line.carry = losing(is_command(Command.APPLY))
    told = refused("restore", str(backup), "--save")
    assert MAY_BE_DONE in told
    assert "It was done" in told
    assert "not saved" in told
    assert line.world.value("active.pitch_um") == 11_000
    assert no_write_is_sent_again(line)


def test_a_restore_on_a_line_that_stays_dead_says_what_to_look_at(line: DirtyLine, backup: Path):
    def dies(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        answer = honest(sent.frame)
        return [] if line.executed() else [(0.0, answer)]

    line.carry = dies
    done = levelwind("restore", str(backup))
    assert done.exit_code == 1
    assert MAY_BE_DONE in done.stderr
    assert "levelwind diff" in done.stderr


def test_a_lost_answer_on_trial_of_a_line_is_settled_by_the_trial(line: DirtyLine):
    line.carry = losing(is_command(Command.TRY_LINE))
    assert "Saved" in said("line", "--new-unit", "7")
    assert line.world.value("stored.unit_id") == 7


def test_reading_is_tried_again(line: DirtyLine):
    line.carry = losing(lambda sent: True)
    assert "UNINDEXED" in said("status")


# ---- a line that returns what is sent ------------------------------------------------------------


def test_an_echo_is_dropped(line: DirtyLine):
    plain = {name: said(name) for name in ("identify", "status", "log")}
    line.carry = echoing
    assert {name: said(name) for name in plain}.keys() == plain.keys()
    events = json.loads(said("log", "--json"))["events"]
    assert len({event["sequence"] for event in events}) == len(events)
    said("set", "pitch_um=11111")
    said("apply")
    assert line.world.value("active.pitch_um") == 11_111


def test_an_echo_without_an_answer_is_named(line: DirtyLine):
    line.carry = lambda sent, honest: [(0.0, sent.frame)]
    told = refused("status")
    assert "echo" in told
    assert MAY_BE_DONE not in told
    told = refused("identify")
    assert "echo" in told


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "table.txt"
    path.write_text("0 0\n1440 3000\n2880 0\n")
    return path


def refusing_files(echo: bool) -> Callable[..., Pieces]:
    """Writing a file is refused."""

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        if sent.frame[1] == 21:
            answer = sealed(bytes([1, 0x95, 6]))
        else:
            answer = honest(sent.frame)
        return [(0.001, sent.frame * echo), (0.002, answer)]

    return carry


@pytest.mark.parametrize("echo", [False, True])
def test_a_refused_file_write_is_no_success(line: DirtyLine, table: Path, echo: bool):
    line.carry = refusing_files(echo)
    assert "exception 06" in refused("cam", "upload", str(table))


def test_a_cam_table_goes_through_a_line_with_echo(line: DirtyLine, table: Path, tmp_path: Path):
    line.carry = echoing
    assert "3 rows checked" in said("cam", "upload", str(table))
    said("cam", "activate")
    copy = tmp_path / "copy.txt"
    said("cam", "download", str(copy))
    assert "1440" in copy.read_text()


def test_a_file_write_whose_answer_is_lost_is_read_back(line: DirtyLine, table: Path):
    line.carry = losing(lambda sent: sent.frame[1] == 21)
    assert "3 rows checked" in said("cam", "upload", str(table))
    assert no_write_is_sent_again(line)


def test_a_file_write_that_did_not_arrive_is_found_by_reading_back(line: DirtyLine, table: Path):
    def with_echo(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        return [(0.0, sent.frame), *([] if sent.frame[1] == 21 else [(0.0, honest(sent.frame))])]

    line.carry = with_echo
    assert "not written" in refused("cam", "upload", str(table))
    assert not line.executed()


# ---- bytes that never end ------------------------------------------------------------------------


@pytest.mark.parametrize("endless", ["00", "ff", "01 03", "55" * 40])
@pytest.mark.parametrize(
    "command",
    ["identify", "status", "log", "diff", "index", "stop", "set pitch_um=11111", "conformance"],
)
def test_bytes_that_never_end_do_not_keep_the_tool(line: DirtyLine, endless: str, command: str):
    line.endless = bytes.fromhex(endless)
    line.carry = lambda sent, honest: []
    began_s = line.now_s
    done = levelwind(*command.split())
    assert done.exit_code == 1
    assert line.now_s - began_s < 5.0
    assert "ytes" in done.stderr


def test_bytes_that_never_end_in_the_middle_end_the_conformance_suite(line: DirtyLine):
    carry = line.carry

    def until_files(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        if len(line.sent) == 400:
            line.endless = b"\x00"
        return carry(sent, honest)

    line.carry = until_files
    done = levelwind("conformance")
    assert done.exit_code == 1
    assert "do not end" in done.stderr
    assert len(line.sent) < 410


# ---- conformance ---------------------------------------------------------------------------------


class Interrupted:
    """Ctrl-C at one request of a conformance run."""

    def __init__(self, at: Callable[[Sent], bool]) -> None:
        self._at = at
        self.done = False

    def __call__(self, sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        answer = honest(sent.frame)
        if not self.done and self._at(sent):
            self.done = True
            raise KeyboardInterrupt
        return [(0.0, answer)] if answer else []


def test_listen_only_mode_does_not_outlive_ctrl_c(line: DirtyLine):
    line.carry = Interrupted(lambda sent: sent.frame[1:4] == b"\x08\x00\x04")
    assert levelwind("conformance", "--case", "listen only").exit_code == 130
    assert line.carry.done
    assert "UNINDEXED" in said("status")


def test_listen_only_mode_does_not_outlive_an_impatient_ctrl_c(line: DirtyLine):
    pressed: list[Sent] = []

    def carry(sent: Sent, honest: Callable[[bytes], bytes]) -> Pieces:
        # The request that ends the mode is lost the first time, and there Ctrl-C comes again.
        lost = len(pressed) == 1 and sent.frame[1:4] == b"\x08\x00\x01"
        answer = b"" if lost else honest(sent.frame)
        if lost or (not pressed and sent.frame[1:4] == b"\x08\x00\x04"):
            pressed.append(sent)
            os.kill(os.getpid(), signal.SIGINT)
        return [(0.0, answer)] if answer else []

    line.carry = carry
    assert levelwind("conformance", "--case", "listen only").exit_code == 130
    assert len(pressed) == 2
    line.carry = clean
    assert "UNINDEXED" in said("status")


def test_what_ctrl_c_cuts_off_is_put_back(line: DirtyLine):
    before = line.world.value("encoder_pulses_per_rev")
    cut = 0
    for nth in range(1, 40):
        writes = []

        def at(sent: Sent, writes: list[Sent] = writes, nth: int = nth) -> bool:
            if sent.executed and not sent.reading and sent.frame[1] in (6, 16, 22, 23):
                writes.append(sent)
            return len(writes) == nth

        line.carry = Interrupted(at)
        options = ["conformance", "--scratch-register", str(SCRATCH), "--case", "FC"]
        if levelwind(*options).exit_code != 130:
            break
        cut += 1
        assert line.world.value("encoder_pulses_per_rev") == before, f"write {nth}"
    assert cut > 10


def test_a_mute_controller_may_be_in_listen_only_mode(line: DirtyLine):
    line.world.line(sealed(bytes([1, 8, 0, 4, 0, 0])), 0.01)
    assert "listen only" in refused("stop")
    assert "listen only" in refused("conformance")


def test_conformance_passes_through_a_line_with_echo(line: DirtyLine):
    plain = json.loads(levelwind("conformance", "--case", "FC", "--json").stdout)
    line.carry = echoing
    echoed = json.loads(levelwind("conformance", "--case", "FC", "--json").stdout)
    assert echoed["cases"] == plain["cases"]
    assert sum(case["result"] == "pass" for case in plain["cases"]) > 50


# ---- two programs at one port --------------------------------------------------------------------


def test_a_port_is_opened_by_one_program_only():
    far, near = pty.openpty()
    try:
        wanted = Line(os.ttyname(near))
        with open_port(wanted):
            with pytest.raises(ToolError, match="in use by another program"):
                open_port(wanted)
            for command in ("status", "conformance"):
                told = refused(command, "--port", wanted.port)
                assert "in use by another program" in told
            simulator = [str(native.find(native.SIMULATOR)), "--port", wanted.port]
            ended = subprocess.run(simulator, capture_output=True, timeout=20, check=False)
            assert ended.returncode == 1
            assert b"busy" in ended.stderr
        open_port(wanted).close()
    finally:
        os.close(far)
        os.close(near)
