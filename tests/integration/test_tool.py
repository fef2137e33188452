# SPDX-License-Identifier: Apache-2.0
"""The command `levelwind`, run as a user runs it, against a running slave."""

import hashlib
import json
import os
import pty
import select
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from board.machine import IMAGE
from levelwind.map_table import Command, Flag, State
from slave import NATIVE_DIR, Simulator, Slave, bring_to_rest

ROOT = Path(__file__).parents[2]
LEVELWIND = [sys.executable, "-c", "from levelwind.cli import main; main()"]


def environment(port: str) -> dict[str, str]:
    return {
        **os.environ,
        "LEVELWIND_PORT": port,
        "LEVELWIND_NATIVE_DIR": str(NATIVE_DIR),
        "COLUMNS": "100",
        "TERM": "xterm",
    }


def levelwind(port: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*LEVELWIND, *arguments],
        env=environment(port),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def output(port: str, *arguments: str) -> str:
    """What a command prints; it must end well."""
    done = levelwind(port, *arguments)
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout


def refusal(port: str, *arguments: str) -> str:
    """What a command that must fail says: on stderr, without a traceback."""
    done = levelwind(port, *arguments)
    assert done.returncode == 1, f"{arguments}: {done.stdout}{done.stderr}"
    assert "Traceback" not in done.stderr
    assert len(done.stderr.strip().splitlines()) <= 3
    return done.stderr


@pytest.fixture
def at(slave: Slave) -> str:
    """The port of a slave at rest, free for the tool."""
    slave.close()
    return slave.port


def test_identify_and_status(at: str, target: str) -> None:
    identity = json.loads(output(at, "identify", "--json"))
    assert identity["self_test"] == 0x12345678
    image = None
    if target == "board":
        image = hashlib.sha256(IMAGE.read_bytes()).hexdigest()[:16]
    assert identity["image"] == image
    assert "levelwind" in output(at, "identify")
    assert f"image {image or 'not known'}" in output(at, "identify")
    status = json.loads(output(at, "status", "--json"))
    assert status["state"] == "unindexed"
    assert status["launch_permit"] is False
    assert "UNINDEXED" in output(at, "status")


def test_set_diff_apply_save_revert(at: str) -> None:
    output(at, "set", "pitch_um=12500", "handover_direction=minus")
    difference = output(at, "diff")
    assert "pitch_um" in difference
    assert "12500" in difference
    output(at, "apply")
    output(at, "save")
    output(at, "set", "pitch_um=10000")
    output(at, "revert")
    row = json.loads(output(at, "get", "pitch_um", "--json"))["pitch_um"]
    assert [row[copy] for copy in ("staged", "active", "stored")] == [12_500] * 3


def test_refused_values_name_value_and_limit(at: str) -> None:
    said = refusal(at, "set", "pitch_um=99999999")
    assert "pitch_um" in said
    assert "99999999" in said
    assert "100000" in said
    output(at, "set", "switch_plus_um=81000")
    said = refusal(at, "apply")
    assert "switch_plus" in said
    assert "81000" in said
    assert "80000" in said
    assert "no_such" in refusal(at, "set", "no_such=1")


def test_index_jog_mode_and_trim(at: str) -> None:
    assert "Indexed" in output(at, "index")
    output(at, "jog", "plus", "--for", "0.2")
    assert "centre" in output(at, "mode", "centre")
    slave = Slave(at)
    slave.wait(lambda: slave.read("state") == State.CENTRED)  # the jog runs out first
    slave.close()
    output(at, "trim", "--plus-um", "-100")
    assert json.loads(output(at, "trim", "--json"))["trim_plus_um"] == -100
    output(at, "stop")


def test_index_at_several_rates_proposes_the_delay_of_the_switches(at: str) -> None:
    assert "give two" in refusal(at, "index", "--rates", "20000")
    assert "100 to 50000" in refusal(at, "index", "--rates", "20000,99")
    output(at, "set", "pitch_um=12500")
    assert "levelwind diff" in refusal(at, "index", "--rates", "20000,40000")
    output(at, "revert")
    said = output(at, "index", "--rates", "20000,40000")
    # The millisecond and a half that the simulated switches tell late.
    proposed_us = int(said.split("switch_delay_us=")[-1].split("`")[0])
    assert 1_300 <= proposed_us <= 1_800, said
    rate = json.loads(output(at, "get", "index_rate_edges_per_s", "--json"))
    assert rate["index_rate_edges_per_s"]["active"] == 10_000
    assert "UNINDEXED" in output(at, "status")


def test_clear_fault_says_what_still_stands(at: str) -> None:
    assert "no fault" in output(at, "clear-fault")
    output(at, "set", "bench_switch_plus_fault=shorted")
    assert "plus limit switch is still faulty" in refusal(at, "clear-fault")
    output(at, "set", "bench_switch_plus_fault=none")
    assert "Cleared: wiring fault of the plus" in output(at, "clear-fault")


def test_jog_into_a_switch_ends_well(at: str) -> None:
    output(at, "jog", "plus", "--for", "1")  # off the minus switch, if it stands there
    assert "unindexed" in output(at, "jog", "minus", "--for", "60")


def test_backup_and_restore_all_or_nothing(at: str, tmp_path: Path) -> None:
    good = tmp_path / "good.yaml"
    output(at, "set", "pitch_um=12500")
    output(at, "apply")
    output(at, "backup", str(good))
    output(at, "factory", "all")
    output(at, "apply")
    bad = tmp_path / "bad.yaml"
    bad.write_text(good.read_text().replace("switch_plus_um: 78400", "switch_plus_um: 81000"))
    assert "switch_plus_um" in refusal(at, "restore", str(bad))
    assert json.loads(output(at, "get", "pitch_um", "--json"))["pitch_um"]["active"] == 12_000
    output(at, "restore", str(good))
    assert json.loads(output(at, "get", "pitch_um", "--json"))["pitch_um"]["active"] == 12_500


def test_run_a_setup_script(at: str, tmp_path: Path) -> None:
    output(at, "run", str(ROOT / "profiles" / "field_setup.yaml"))
    bad = tmp_path / "bad.yaml"
    bad.write_text("- set: {no_such_register: 1}\n")
    assert "no_such_register" in refusal(at, "run", str(bad))
    failing = tmp_path / "failing.yaml"
    failing.write_text("- expect: {pitch_um: 1}\n")
    assert "pitch_um" in refusal(at, "run", str(failing))


def test_text_of_the_user_is_printed_as_it_is(at: str, tmp_path: Path) -> None:
    text = "[bold]x[/bold] [/nope] [red] :winch: \\[a]"
    folder = tmp_path / "[bold]folder["  # and a closing tag with the names in it
    folder.mkdir()
    script = folder / "x] [script].yaml"
    script.write_text(f"- note: '{text}'\n- set: {{pitch_um: 12500}}\n- expect: {{pitch_um: 10}}\n")
    done = levelwind(at, "run", str(script))
    assert f"# {text}\n" in done.stdout
    assert str(script) in done.stderr
    assert "12500" in output(at, "get", "pitch_um")
    backup = folder / "green].yaml"
    assert str(backup) in output(at, "backup", str(backup))
    table = folder / "].$x$.csv"
    table.write_text("0;0\n1000;100\n2000;0\n")
    name = "[b]$a_b[/b]"
    assert f"{name}: 3 rows" in output(at, "cam", "upload", str(table), "--name", name)
    output(at, "cam", "activate")
    assert name in output(at, "cam", "download", str(tmp_path / "again.csv"))
    output(at, "cam", "plot", str(table), str(tmp_path / "[p].png"))
    port = folder / "port]"
    port.symlink_to(at)
    assert str(port) in output(str(port), "identify")
    assert str(port) in refusal(str(port), "identify", "--unit", "9", "--timeout", "0.1")


def test_a_damaged_record_is_told_until_it_is_written_anew(
    target: str, own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    if target != "sim":
        pytest.skip("only the simulator keeps its slots in a file")
    storage = tmp_path / "parameters.bin"
    first = own_simulator(storage)
    port = str(first.port)
    assert "A stored" not in output(port, "status")
    for pitch_um in (11_000, 12_500):
        output(port, "set", f"pitch_um={pitch_um}")
        output(port, "apply")
        output(port, "save")
    first.stop()
    content = bytearray(storage.read_bytes())
    content[4096 + 30] ^= 1  # in the second slot, which holds what was saved last
    storage.write_bytes(content)
    port = str(own_simulator(storage).port)
    assert json.loads(output(port, "get", "pitch_um", "--json"))["pitch_um"]["active"] == 11_000
    said = " ".join(output(port, "status").split())
    assert "A stored parameters record is damaged: an older set may be in force" in said
    assert json.loads(output(port, "status", "--json"))["slot_1"] == "damaged"
    output(port, "save")
    assert "damaged" not in output(port, "status")


@pytest.mark.parametrize("column", ["rope_m_per_s", "drum_rpm", "motor_rpm", "edges_per_s"])
def test_launch_profiles(at: str, tmp_path: Path, column: str) -> None:
    speed = {"rope_m_per_s": 4, "drum_rpm": 100, "motor_rpm": 600, "edges_per_s": 4800}[column]
    profile = tmp_path / "profile.csv"
    profile.write_text(f"time_s,{column}\n0,0\n1,{speed}\n4,{speed}\n5,{-speed / 2}\n7,0\n")
    output(at, "index")
    before = Slave(at)
    start = before.read("net_edges")
    before.close()
    json.loads(output(at, "launch", str(profile), "--json"))
    after = Slave(at)
    assert after.read("state") == State.TRACKING
    # The area under the profile: 3.667 s forward and 1.333 s at half the speed backward.
    expected = 4800 * (0.5 + 3 + 2 / 3 * 0.5 - 0.5 * (1 / 3 * 0.5 + 2 * 0.5))
    assert abs(after.read("net_edges") - start - expected) < 15
    after.close()


def test_replay_is_the_compiled_law(at: str) -> None:
    runs = ["--drum", "+20000,-3000,+200000", "--json"]
    law = ["--ka", "23", "--nr", "1187", "--lplus", "8000", "--lminus", "-8000"]
    there = json.loads(output(at, "replay", *law, *runs))
    assert {"m", "u", "pos", "steps", "pulses", "min_pos", "max_pos", "edges"} <= set(there)
    assert there["edges"] == 223_000
    assert there["pos"] == there["m"] >> 16 == there["steps"]
    state = ["--m", str(there["m"]), "--u", str(there["u"])]
    back = json.loads(output(at, "replay", *law, *state, "--drum", "-217000", "--json"))
    assert (back["m"], back["u"]) == (0, 27_301)
    assert "--nr" in refusal(at, "replay", "--ka", "23", "--nr", "0", *law[4:], *runs)


def test_no_port_no_answer_wrong_unit(at: str, tmp_path: Path) -> None:
    assert "no port" in refusal(str(tmp_path / "missing"), "status")
    assert "--unit" in refusal(at, "status", "--unit", "9", "--timeout", "0.2")


def read_until(descriptor: int, wanted: bytes) -> None:
    """Read what a running command prints until it has printed this."""
    seen = b""
    while wanted not in seen:
        assert select.select([descriptor], [], [], 30)[0], f"nothing more shown after {seen!r}"
        more = os.read(descriptor, 4096)
        assert more, f"ended after {seen!r}"
        seen += more


@contextmanager
def watching(port: str) -> Iterator[subprocess.Popen[bytes]]:
    """`status --watch` on a terminal, after its first picture."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [*LEVELWIND, "status", "--watch"],
        env=environment(port),
        stdout=theirs,
        stderr=subprocess.PIPE,
    )
    os.close(theirs)
    read_until(ours, b"UNINDEXED")
    drain = threading.Thread(target=read_to_the_end, args=(ours,), daemon=True)
    drain.start()
    try:
        yield process
    finally:
        process.kill()
        drain.join(10)
        os.close(ours)


def read_to_the_end(descriptor: int) -> None:
    with suppress(OSError):
        while os.read(descriptor, 4096):
            pass


def test_watching_without_a_terminal_prints_every_change(
    own_simulator: Callable[..., Simulator],
) -> None:
    port = str(own_simulator().port)
    slave = Slave(port)
    bring_to_rest(slave)
    assert slave.write("command", Command.INDEX) == 0
    slave.close()
    process = subprocess.Popen(
        [*LEVELWIND, "status", "--watch"], env=environment(port), stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    try:
        read_until(process.stdout.fileno(), b"Indexing: ")
        read_until(process.stdout.fileno(), b" TRACKING ")
    finally:
        process.kill()
        process.communicate()


def test_a_terminated_launch_stops_the_drum(at: str) -> None:
    ours, theirs = pty.openpty()
    profile = str(ROOT / "profiles" / "ground_launch.csv")
    process = subprocess.Popen([*LEVELWIND, "launch", profile], env=environment(at), stdout=theirs)
    os.close(theirs)
    try:
        read_until(ours, b" 10%")
        process.terminate()
        read_to_the_end(ours)
        assert process.wait(30) == 130
    finally:
        process.kill()
        os.close(ours)
    slave = Slave(at)
    assert slave.read("bench_profile_running") == 0
    assert slave.read("bench_drum_speed_millirpm") == 0
    slave.close()


def test_ctrl_c_ends_watching_without_a_traceback(at: str) -> None:
    with watching(at) as process:
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=10)
    assert process.returncode == 130
    assert b"Traceback" not in said


def test_an_ignored_hangup_stays_ignored(at: str) -> None:
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        ["sh", "-c", "trap '' HUP; exec \"$@\"", "sh", *LEVELWIND, "status", "--watch"],
        env=environment(at),
        stdout=theirs,
    )
    os.close(theirs)
    try:
        read_until(ours, b"UNINDEXED")
        process.send_signal(signal.SIGHUP)
        for _ in range(3):
            read_until(ours, b"UNINDEXED")
        assert process.poll() is None
    finally:
        process.kill()
        process.wait()
        os.close(ours)


@contextmanager
def watched(port: str, *, terminal: bool) -> Iterator[int]:
    """What `status --watch` shows, to be read from this descriptor."""
    ours, theirs = pty.openpty() if terminal else os.pipe()
    process = subprocess.Popen(
        [*LEVELWIND, "status", "--watch"], env=environment(port), stdout=theirs
    )
    os.close(theirs)
    try:
        yield ours
        assert process.poll() is None
    finally:
        process.kill()
        process.wait()
        os.close(ours)


@pytest.mark.parametrize("terminal", [True, False], ids=["terminal", "pipe"])
def test_watching_goes_dark_without_data_and_goes_on_when_it_answers_again(
    target: str, own_simulator: Callable[..., Simulator], terminal: bool
) -> None:
    running = own_simulator()
    with watched(str(running.port), terminal=terminal) as shown:
        read_until(shown, b"UNINDEXED")
        running.process.send_signal(signal.SIGSTOP)
        read_until(shown, b"NO DATA: take it as NOT PERMITTED")
        running.process.send_signal(signal.SIGCONT)
        read_until(shown, b"UNINDEXED")
        running.stop(signal.SIGKILL)
        read_until(shown, b"NO DATA: take it as NOT PERMITTED")
        if target == "sim":  # the others come back at another port
            again = own_simulator()
            read_until(shown, b"UNINDEXED")
            assert again.stop() == 0


def test_a_launch_with_nothing_permitted_ends_with_exit_status_1(at: str, tmp_path: Path) -> None:
    profile = tmp_path / "short.csv"
    profile.write_text("time_s,drum_rpm\n0,0\n1,60\n2,60\n3,0\n")
    assert "Asked for off" in output(at, "mode", "off")
    done = levelwind(at, "launch", str(profile))
    assert done.returncode == 1
    assert "launch permit never given" in done.stderr
    assert "Asked for track" in output(at, "mode", "track")
    output(at, "index")
    output(at, "launch", str(profile))


def test_rope_laid_while_the_carriage_stood_is_told_and_acknowledged(at: str) -> None:
    assert "No rope was laid" in output(at, "acknowledge")
    output(at, "index")
    output(at, "set", "bench_drum_speed_millirpm=100000")
    output(at, "stop")
    slave = Slave(at)
    slave.wait(lambda: slave.flag(Flag.ROPE_LAID_STANDING))
    slave.write("bench_drum_speed_millirpm", 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    slave.close()
    said = " ".join(output(at, "status").replace("│", " ").split())
    assert "DRUM TURNS OF ROPE WERE LAID WHILE THE CARRIAGE STOOD" in said
    assert "then `levelwind index`, then `levelwind acknowledge`" in said
    assert "index first" in refusal(at, "acknowledge")
    output(at, "index")
    assert json.loads(output(at, "status", "--json"))["launch_permit"] is False
    assert "Acknowledged:" in output(at, "acknowledge")
    output(at, "mode", "track")
    slave = Slave(at)
    slave.wait(lambda: slave.flag(Flag.LAUNCH_PERMIT))
    slave.close()


def test_an_overtravel_switch_with_a_broken_wire_is_named(at: str) -> None:
    slave = Slave(at)
    slave.write("bench_switch_minus_fault", 2)  # the carriage on the other switch
    slave.write("bench_overtravel_plus", 1)
    slave.close()
    try:
        assert "Plus overtravel switch" in refusal(at, "index")
    finally:
        slave = Slave(at)
        slave.write("bench_switch_minus_fault", 0)
        slave.write("bench_overtravel_plus", 0)
        slave.close()


def test_a_refusal_is_said_without_the_protocol(at: str) -> None:
    output(at, "set", "bench_drum_speed_millirpm=10000")
    slave = Slave(at)
    slave.wait(lambda: not slave.flag(Flag.DRUM_AT_REST))
    slave.close()
    assert refusal(at, "index").strip() == "levelwind: The drum must be at rest for this"
    output(at, "set", "bench_drum_speed_millirpm=0")


def test_levelwind_sim_says_ready_and_ends_on_ctrl_c(tmp_path: Path) -> None:
    port = tmp_path / "port"
    process = subprocess.Popen(
        [*LEVELWIND, "sim", "--port", str(port), "--speed", "max", "--seed", "7"],
        env=environment(""),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == f"ready {port}\n"
    try:
        slave = Slave(str(port))
        assert slave.read("self_test") == 0x12345678
        slave.close()
    finally:
        process.send_signal(signal.SIGINT)
    rest, said = process.communicate(timeout=10)
    assert (rest, said) == ("", "")
    assert not port.exists()
    assert not port.is_symlink()


def test_a_second_simulator_leaves_the_first_ones_port_alone(
    target: str, own_simulator: Callable[..., Simulator]
) -> None:
    if target != "sim":
        pytest.skip("only the simulator makes its port")
    first = own_simulator()
    second = subprocess.run(
        [*LEVELWIND, "sim", "--port", str(first.port)],
        env=environment(""),
        capture_output=True,
        text=True,
        timeout=20,
        check=False,
    )
    assert second.returncode == 1
    assert "another simulator" in second.stderr
    slave = Slave(str(first.port))
    assert slave.read("self_test") == 0x12345678
    slave.close()


def test_a_second_simulator_keeps_off_the_first_ones_storage_and_trace(
    target: str, own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    if target != "sim":
        pytest.skip("only the simulator has files of its own")
    storage = tmp_path / "parameters.bin"
    first = own_simulator(storage)
    output(str(first.port), "set", "pitch_um=12500")
    output(str(first.port), "apply")
    output(str(first.port), "save")
    trace = tmp_path / "trace.csv"
    trace.write_text("kept")
    second = [*("sim", "--trace", str(trace)), "--storage", str(storage)]
    said = refusal(str(tmp_path / "second"), *second)
    assert f"--storage {storage}: another simulator" in said
    assert "another simulator" in refusal(str(first.port), *second[:3])
    assert trace.read_text() == "kept"
    assert first.stop() == 0
    assert json.loads(output(str(own_simulator(storage).port), "get", "pitch_um", "--json"))[
        "pitch_um"
    ]["stored"] == 12_500  # fmt: skip


def test_numbers_of_the_simulator_are_decimal(tmp_path: Path) -> None:
    port = tmp_path / "port"
    process = subprocess.Popen(
        [NATIVE_DIR / "lw_sim", "--port", port, "--unit", "010"], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == f"ready {port}\n"
    try:
        assert "levelwind" in output(str(port), "identify", "--unit", "10")
    finally:
        process.kill()
        process.communicate()


def test_the_demonstration(tmp_path: Path) -> None:
    done = subprocess.run(
        [*LEVELWIND, "demo", "--speed", "max", "--out", str(tmp_path)],
        env=environment(""),
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "FAILED" not in done.stdout
    assert (tmp_path / "launch.png").read_bytes().startswith(b"\x89PNG")
