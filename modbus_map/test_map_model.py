# SPDX-License-Identifier: Apache-2.0
"""Mistakes in registers.yaml are found, and the message names them."""

import copy
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import emit_pictures  # noqa: E402
import map_model  # noqa: E402

RAW = yaml.safe_load((FOLDER / "registers.yaml").read_text(encoding="utf-8"))


def point(raw: dict, name: str) -> dict:
    return next(p for block in raw["registers"] for p in block["points"] if p["name"] == name)


def block(raw: dict, name: str) -> dict:
    return next(b for b in raw["registers"] if b["block"] == name)


MISTAKES: list[tuple[str, Callable[[dict], object], str]] = [
    ("unknown key", lambda r: point(r, "pitch_um").update(maximum=5), "'maximum' was unexpected"),
    ("no text", lambda r: point(r, "pitch_um").pop("text"), "'text' is a required property"),
    (
        "detail of an unknown enum",
        lambda r: r["enums"]["event"]["values"]["fault_set"].update(detail="faults"),
        "enum event: the detail of fault_set: no enum faults",
    ),
    ("unknown type", lambda r: point(r, "pitch_um").update(type="u64"), "'u64' is not one of"),
    (
        "duplicate name",
        lambda r: point(r, "overshoot_um").update(name="pitch_um"),
        "pitch_um: the name is used more than once",
    ),
    (
        "a register named as a coil",
        lambda r: point(r, "pitch_um").update(name="stop"),
        "stop: the name is used more than once",
    ),
    (
        "overlap in a block",
        lambda r: point(r, "screw_lead_um").update(address=111),
        "screw_lead_um and microsteps_per_rev: both hold the holding register 112",
    ),
    (
        "overlap of blocks",
        lambda r: point(r, "trim_minus_um").update(address=100),
        "both hold the holding register 100",
    ),
    (
        "overlap with a mirror",
        lambda r: block(r, "parameters")["mirrors"][0].update(address_offset=300),
        "both hold the input register 40",
    ),
    (
        "not sorted",
        lambda r: block(r, "status")["points"].reverse(),
        "block status: the points are not sorted",
    ),
    ("beyond 65535", lambda r: point(r, "bench_profile").update(address=65500), "65619"),
    (
        "default outside",
        lambda r: point(r, "pitch_um").update(default=9),
        "pitch_um: 9 is outside its limits 10 to 100000",
    ),
    (
        "default not allowed",
        lambda r: point(r, "baud_rate").update(default=9601),
        "baud_rate: the default 9601 is not one of",
    ),
    ("no default", lambda r: point(r, "pitch_um").pop("default"), "needs a default"),
    (
        "no limits",
        lambda r: [point(r, "pitch_um").pop(key) for key in ("min", "max")],
        "pitch_um: a writable point needs min and max",
    ),
    (
        "limits of a read-only point",
        lambda r: point(r, "state").update(min=0, max=12),
        "state: cannot be written",
    ),
    (
        "limit too large for its type",
        lambda r: point(r, "jog_hold_ms").update(max=70000),
        "jog_hold_ms: the limits 50 to 70000",
    ),
    ("u32 above INT32_MAX", lambda r: point(r, "pitch_um").update(max=2**31), "2147483647"),
    ("i64 writable", lambda r: point(r, "pitch_um").update(type="i64"), "i64 cannot be writable"),
    (
        "unknown enum",
        lambda r: point(r, "mode").update(enum="modes"),
        "mode: there is no enum modes",
    ),
    (
        "limits wider than the enum",
        lambda r: point(r, "mode").update(min=0, max=3),
        "mode: the limits 0 to 3 let values through",
    ),
    (
        "enum value twice",
        lambda r: r["enums"]["fault"]["values"]["none"].update(value=1),
        "enum fault: the value 1 is used more than once",
    ),
    (
        "gap in the discrete inputs",
        lambda r: r["bits"]["discrete"].pop(3),
        "discrete: the bits must count 0, 1, 2",
    ),
    (
        "coil without a command",
        lambda r: r["bits"]["coil"][0].update(command="home"),
        "coil index: there is no command home",
    ),
]


@pytest.mark.parametrize(
    ("mistake", "message"), [m[1:] for m in MISTAKES], ids=[m[0] for m in MISTAKES]
)
def test_a_mistake_is_found(mistake: Callable[[dict], object], message: str) -> None:
    raw = copy.deepcopy(RAW)
    mistake(raw)
    with pytest.raises(map_model.MapError) as caught:
        map_model.check(raw)
    assert message in "\n".join(caught.value.args)


def test_enum_limits_come_from_its_values() -> None:
    map_ = map_model.check(RAW)
    mode = next(p for b in map_.blocks for p in b.points if p.name == "mode")
    assert (mode.min, mode.max) == (0, 2)


def test_a_drifted_file_is_named(tmp_path: Path) -> None:
    shutil.copytree(FOLDER, tmp_path / "modbus_map")
    generate = [sys.executable, str(tmp_path / "modbus_map" / "generate.py")]
    assert subprocess.run(generate, check=False, capture_output=True).returncode == 0
    assert subprocess.run([*generate, "--check"], check=False, capture_output=True).returncode == 0
    drifted = tmp_path / "doc" / "registers.md"
    drifted.write_text(drifted.read_text() + "x")
    check = subprocess.run([*generate, "--check"], check=False, capture_output=True, text=True)
    assert check.returncode == 1
    assert check.stderr.splitlines() == [
        "doc/registers.md is not what modbus_map/registers.yaml makes. "
        "Run: python3 modbus_map/generate.py"
    ]


def test_a_state_that_the_picture_does_not_show_is_found() -> None:
    raw = copy.deepcopy(RAW)
    raw["enums"]["state"]["values"]["waiting"] = {"value": 99, "text": "New"}
    with pytest.raises(map_model.MapError, match="differ: waiting"):
        emit_pictures.states_svg(map_model.check(raw))


def test_an_enum_with_gaps_lets_no_value_between_through():
    raw = copy.deepcopy(RAW)
    raw["enums"]["mode"]["values"]["centre"]["value"] = 5
    points = [p for b in map_model.check(raw).blocks for p in b.points]
    assert next(p for p in points if p.name == "mode").allowed == [0, 1, 5]
