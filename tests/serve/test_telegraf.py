# SPDX-License-Identifier: Apache-2.0
"""The configuration for Telegraf, read by Telegraf: its fields have the controller's values.

Its plugin alone takes some minutes to compile: LEVELWIND_INTEGRATIONS=1 fetches it by Go, and what
has been built is used again.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.map_table import POINTS, Flag
from served import Served

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "telegraf"
SOURCE = ROOT / "tests" / "serve" / "masters" / "telegraf.go"
MODULE = "github.com/influxdata/telegraf@v1.33.0"


def build() -> Path:
    program = FOLDER / "telegraf"
    if not program.is_file():
        if "LEVELWIND_INTEGRATIONS" not in os.environ or not shutil.which("go"):
            pytest.skip("LEVELWIND_INTEGRATIONS=1 fetches Telegraf by Go")
        FOLDER.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE, FOLDER / "main.go")
        for words in ("mod init telegraf", f"get {MODULE}", "mod tidy", "build -o telegraf ."):
            subprocess.run(["go", *words.split()], cwd=FOLDER, check=True)
    return program


def test_it_reads_what_the_controller_says(start: Callable[..., Served], tmp_path: Path) -> None:
    program = build()
    served = start()
    served.index()
    served.turn_back()
    told = (ROOT / "modbus_map" / "tags_telegraf.conf").read_text()
    assert "127.0.0.1:1502" in told
    configuration = tmp_path / "telegraf.conf"
    configuration.write_text(told.replace("127.0.0.1:1502", f"127.0.0.1:{served.gate}"))

    def gather() -> dict[str, object]:
        done = subprocess.run(
            [program, configuration], capture_output=True, text=True, timeout=60, check=False
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    still = served.compare(gather)
    assert still > {"state", "position_um", "launch_inhibit", "span_error_um", "net_edges"}
    inputs = {p.name for p in POINTS.values() if p.space == "input" and 100 <= p.address < 900}
    assert gather().keys() - {flag.label for flag in Flag} == inputs
