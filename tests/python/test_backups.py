# SPDX-License-Identifier: Apache-2.0
"""Backup files: complete, checked, and readable by people."""

from pathlib import Path

import pytest
import yaml
from levelwind.errors import ToolError
from levelwind.files import backups
from levelwind.line.points import PARAMETERS
from levelwind.map_table import MAP_VERSION
from levelwind.show.output import json_value

DEFAULTS = {p.name: json_value(p, p.default) for p in PARAMETERS}


def written(folder: Path, document: object) -> Path:
    path = folder / "backup.yaml"
    path.write_text(yaml.safe_dump(document), encoding="utf-8")
    return path


def document(**changes: object) -> dict[str, object]:
    return {"levelwind_backup": MAP_VERSION, "firmware": "1.2.3", "parameters": DEFAULTS | changes}


def test_a_backup_comes_back_with_names_for_enumerations(tmp_path: Path):
    values = backups.read(
        written(tmp_path, document(index_switch="minus", pitch_um=11_000)), "1.2.3"
    )
    assert values == {p.name: p.default for p in PARAMETERS} | {
        "index_switch": 1,
        "pitch_um": 11_000,
    }


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ([], "is no backup"),
        ({"levelwind_backup": 99, "parameters": DEFAULTS}, "has map version 99"),
        ({"levelwind_backup": MAP_VERSION}, "parameters"),
        (document(wat=1), "unknown wat"),
        (document(pitch_um=1), "pitch_um=1 is outside its limits"),
        ({"levelwind_backup": MAP_VERSION, "parameters": {}}, "missing baud_rate, missing"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, content: object, message: str):
    with pytest.raises(ToolError, match=message):
        backups.read(written(tmp_path, content), "1.2.3")


@pytest.mark.parametrize(("firmware", "lines"), [("1.2.3", 0), ("1.3.0", 1)])
def test_other_firmware_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], firmware: str, lines: int
):
    backups.read(written(tmp_path, document()), firmware)
    said = capsys.readouterr().err
    assert len(said.splitlines()) == lines
    assert ("firmware 1.2.3, this controller has 1.3.0" in said) == bool(lines)
