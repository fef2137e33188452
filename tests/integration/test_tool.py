"""The command `levelwind`, run as a user runs it, against a running slave."""

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
from levelwind.map_table import Command, State
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


def test_identify_and_status(at: str) -> None:
    identity = json.loads(output(at, "identify", "--json"))
    assert identity["self_test"] == 0x12345678
    assert "levelwind" in output(at, "identify")
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
    output(at, "trim", "--plus-um", "-100")
    assert json.loads(output(at, "trim", "--json"))["trim_plus_um"] == -100
    output(at, "stop")


def test_jog_into_a_switch_ends_well(at: str) -> None:
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


def test_a_killed_simulator_is_told(own_simulator: Callable[..., Simulator]) -> None:
    running = own_simulator()
    with watching(str(running.port)) as process:
        running.stop(signal.SIGKILL)
        _, said = process.communicate(timeout=20)
    assert process.returncode == 1
    assert b"Traceback" not in said
    assert b"gone" in said or b"No answer" in said


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
