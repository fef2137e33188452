# SPDX-License-Identifier: Apache-2.0
"""`levelwind lay` and `levelwind rope` on a controller: what it holds, and what it counts."""

import json
import subprocess
from pathlib import Path

import pytest
from levelwind.cli import app
from levelwind.map_table import Command
from slave import Slave
from test_tool import LEVELWIND, environment, output
from typer.testing import CliRunner

NUMBERS = ("--patterns", "0", "--json")
HELD = {"pitch_um": 10_100, "rope_diameter_um": 5000, "drum_core_diameter_um": 763_944}


def told(port: str, *arguments: str) -> dict:
    """What a command of this process says, as JSON."""
    done = CliRunner(env={"LEVELWIND_PORT": port}).invoke(app, list(arguments))
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def refused(port: str, *arguments: str) -> str:
    done = CliRunner(env={"LEVELWIND_PORT": port}).invoke(app, list(arguments))
    assert done.exit_code == 1
    return done.stderr


@pytest.fixture
def held(slave: Slave) -> Slave:
    """A slave at rest that holds another pitch, and a rope."""
    for name, value in HELD.items():
        assert slave.write(name, value) == 0
    slave.command(Command.APPLY)
    return slave


@pytest.fixture
def at(held: Slave) -> str:
    """Its port, free for the tool."""
    held.close()
    return held.port


def test_the_active_set_of_the_device_is_laid(held: Slave, tmp_path: Path) -> None:
    assert held.write("pitch_um", 9000) == 0  # staged only
    held.close()
    laid = told(held.port, "lay", "--from-device", *NUMBERS)
    by_hand = [part for name, um in HELD.items() for part in ("--set", f"{name}={um}")]
    assert told(held.port, "lay", *by_hand, *NUMBERS) == laid
    backup = tmp_path / "set.yaml"
    output(held.port, "backup", str(backup))
    assert told(held.port, "lay", str(backup), *NUMBERS) == laid
    changed = told(held.port, "lay", "--from-device", "--set", "pitch_um=12000", *NUMBERS)
    assert changed["period_edges"] == 81_558


def test_a_trim_is_laid_as_it_is(held: Slave) -> None:
    untrimmed = [part for name, um in HELD.items() for part in ("--set", f"{name}={um}")]
    assert held.write("trim_plus_um", 200) == 0
    assert held.write("trim_minus_um", -100) == 0
    held.close()
    trimmed = told(held.port, "lay", "--from-device", *NUMBERS)
    places = ("--set", "reversal_plus_um=80200", "--set", "reversal_minus_um=-80100")
    assert trimmed == told(held.port, "lay", *untrimmed, *places, *NUMBERS)
    assert trimmed != told(held.port, "lay", *untrimmed, *NUMBERS)


def test_the_controller_counts_the_turns_of_a_fit(at: str) -> None:
    """Some 7 revolutions between two presses of Enter; the lengths are made up to fit them."""
    line = [*LEVELWIND, "rope", "--from-device", "--fit", "600/624", "--json"]
    with subprocess.Popen(
        line,
        env=environment(at) | {"PYTHONUNBUFFERED": "1"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stdin is not None
        assert running.stdout is not None
        assert running.stderr is not None
        assert "600 m" in running.stderr.readline()
        running.stdin.write("\n")
        running.stdin.flush()
        # It has counted once it asks for the second length, and has let go of the port.
        assert "624 m" in running.stderr.readline()
        slave = Slave(at)
        before = slave.read("net_edges")
        slave.write("bench_drum_acceleration_millirpm_per_s", 1_000_000)
        slave.write("bench_drum_speed_millirpm", 100_000)
        slave.wait(lambda: slave.read("net_edges") - before >= 7 * 2880)
        slave.write("bench_drum_speed_millirpm", 0)
        slave.wait(lambda: slave.read("bench_drum_actual_millirpm") == 0)
        turned = (slave.read("net_edges") - before) / 2880
        slave.close()
        running.stdin.write("\n")
        running.stdin.flush()
        answer, said = running.stdout.read(), running.stderr.read()
        assert answer, said
        counted = json.loads(answer)
        assert running.wait() == 0
    assert counted["turns"] == pytest.approx(turned, abs=1e-4)
    given = ("--from-device", "--turns", str(turned), "--json")
    by_hand = told(at, "rope", "--fit", "600/624", *given)
    assert counted["rope_packing_permille"] == by_hand["rope_packing_permille"]


def test_nobody_presses_enter(at: str) -> None:
    done = subprocess.run(
        [*LEVELWIND, "rope", "--from-device", "--fit", "0/100"],
        env=environment(at),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "by --turns" in done.stderr


def test_a_controller_without_a_rope_diameter(held: Slave) -> None:
    assert held.write("rope_diameter_um", 0) == 0
    held.command(Command.APPLY)
    held.close()
    assert "rope_diameter_um is 0" in refused(held.port, "lay", "--from-device")
    fit = ("--fit", "0/100", "--turns", "40")
    assert "Not known: rope_diameter_um." in refused(held.port, "rope", "--from-device", *fit)
