# SPDX-License-Identifier: Apache-2.0
"""The command line: usage, messages, exit status, and what needs no controller."""

import json
from pathlib import Path

import pytest
from levelwind.cli import COMMANDS, app
from levelwind.core.ideal_screw import USTEP, Screw, State
from levelwind.line.device import Device
from levelwind.map_table import POINTS
from levelwind.simulate import simulator
from typer.testing import CliRunner

PROTOTYPE = ["--ka", "23", "--nr", "1187", "--lplus", "8000", "--lminus", "-8000"]


def levelwind(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.mark.parametrize(
    "command", [[], *[[name] for panel in COMMANDS.values() for name in panel]]
)
def test_every_command_has_help(command: list[str]):
    result = levelwind(*command, "--help")
    assert result.exit_code == 0
    assert "Usage" in result.output


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["mode", "fast"],
        ["status", "--unit", "248"],
        ["status", "--line", "7E1"],
        ["jog", "plus", "--for", "0"],
        ["replay", "--ka", "1"],
        ["plan", "--reversal-mm", "4"],
    ],
)
def test_wrong_usage_is_status_2(arguments: list[str]):
    assert levelwind(*arguments).exit_code == 2


def test_a_missing_port_is_one_line_and_status_1():
    result = levelwind("status", "--port", "/dev/no-such-port")
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.startswith("levelwind: There is no port /dev/no-such-port.")
    assert len(result.stderr.splitlines()) == 1


def test_the_port_can_come_from_the_environment(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LEVELWIND_PORT", "/dev/from-environment")
    assert "/dev/from-environment" in levelwind("status").stderr


def test_a_file_is_no_port(tmp_path: Path):
    path = tmp_path / "file"
    path.touch()
    result = levelwind("identify", "--port", str(path))
    assert result.exit_code == 1
    assert "is no serial port" in result.stderr


def test_ctrl_c_is_status_130(monkeypatch: pytest.MonkeyPatch):
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Device, "__init__", interrupted)
    result = levelwind("status")
    assert result.exit_code == 130
    assert "Traceback" not in result.output


def test_map_json_is_the_whole_map():
    table = json.loads(levelwind("map", "--json").stdout)
    assert {row["name"] for row in table} == set(POINTS)


def test_map_filters_by_name():
    rows = levelwind("map", "--csv", "pitch_um").stdout.splitlines()
    assert rows[0].startswith("name,space,address")
    assert [row.split(",")[0] for row in rows[1:]] == ["pitch_um"]


def test_map_refuses_what_matches_nothing():
    assert levelwind("map", "zzz").exit_code == 1


def test_plan_derives_the_example_of_the_law():
    document = json.loads(levelwind("plan", "--json").stdout)
    assert document["derived"]["ka"] * document["derived"]["nr"] == document["derived"]["ks"]
    assert document["derived"]["ks"] == pytest.approx(12 / 20 * 2000 / 2880 * USTEP, rel=5e-4)
    assert document["at_rope_speed"]["edges_per_s"] == pytest.approx(24_000)


def test_plan_takes_millimetres_and_registers(tmp_path: Path):
    picture = tmp_path / "plan.png"
    result = levelwind(
        *("plan", "--pitch-mm", "11", "--ratio", "5/1", "--reversal-mm", "+80.2/-79.5"),
        *("--set", "overshoot_um=2000", "--plot", str(picture), "--json"),
    )
    parameters = json.loads(result.stdout)["parameters"]
    assert parameters["pitch_um"] == 11_000
    assert (parameters["encoder_ratio_numerator"], parameters["overshoot_um"]) == (5, 2000)
    assert (parameters["reversal_plus_um"], parameters["reversal_minus_um"]) == (80_200, -79_500)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_plan_sets_what_was_given_also_where_it_is_the_factory_value():
    shown = levelwind("plan", "--pitch-mm", "12", "--overshoot-mm", "2", "--ratio", "4/1").stdout
    assert shown.splitlines()[-1] == (
        "levelwind set pitch_um=12000 overshoot_um=2000 "
        "encoder_ratio_numerator=4 encoder_ratio_denominator=1"
    )


def test_demo_into_a_file_is_one_line(tmp_path: Path):
    path = tmp_path / "file"
    path.touch()
    result = levelwind("demo", "--out", str(path))
    assert result.exit_code == 1
    assert result.stderr.splitlines() == [
        f"levelwind: --out {path}: no folder can be made there: File exists."
    ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--pitch-mm", "50"], "more than one step per encoder edge"),
        (["--pitch-mm", "500"], "pitch_um=500000 is outside its limits"),
        (
            ["--reversal-mm", "70/-80", "--switch-mm", "78.4/-78.4"],
            "switch_plus_um = 78400 um, must be less than 70000 um",
        ),
        (["--set", "mode=track"], "mode is no parameter"),
    ],
)
def test_plan_says_what_is_wrong(arguments: list[str], message: str):
    result = levelwind("plan", *arguments)
    assert result.exit_code == 1
    assert message in result.stderr


def test_replay_is_the_ideal_screw(tmp_path: Path):
    picture = tmp_path / "replay.png"
    result = levelwind(
        *("replay", *PROTOTYPE, "--drum", "+20000,-3000,+200000", "--json", "--plot", str(picture))
    )
    document = json.loads(result.stdout)
    screw = Screw(23, 1187, 8000, -8000)
    ideal = screw.orbit(State(0, screw.ks)).after(20_000 - 3_000 + 200_000)
    assert (document["m"], document["u"], document["pos"]) == (ideal.m, ideal.u, ideal.pos_usteps)
    assert document["steps"] == ideal.pos_usteps
    assert document["edges"] == 223_000
    assert document["max_pos"] == 8247
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (["--nr", "2850"], r"Ks) is 65550, limits 1 to 65535"),
        (["--ka", "0"], "--ka is 0, limits 1 to 65535"),
        (["--lminus", "7999"], "--lminus is 7999, limits -32767 to 7998"),
        (["--lplus", "32700"], "--lplus plus overshoot is 32948"),
        (["--u", "30000"], "--u is 30000, limits -27301 to 27301"),
        (["--u", "24"], "a multiple of Ka, 23"),
        (["--m", "2000000000"], "--m is 2000000000"),
        (["--drum", "12,x"], "'x' is no number of edges"),
    ],
)
def test_replay_refuses_by_name_value_and_limit(changed: list[str], message: str):
    result = levelwind("replay", *PROTOTYPE, "--drum", "1", *changed)
    assert result.exit_code == 1
    assert message in result.stderr


def test_sim_passes_its_options_on(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    lines: list[list[str]] = []
    monkeypatch.setattr(simulator, "become", lines.append)
    (tmp_path / "lw_sim").touch()
    monkeypatch.setenv("LEVELWIND_NATIVE_DIR", str(tmp_path))
    levelwind("sim", "--port", "p", "--speed", "max", "--seed", "3", "--unit", "9")
    assert lines == [
        [str(tmp_path / "lw_sim"), "--port", "p", "--speed", "max", "--seed", "3", "--unit", "9"]
    ]
