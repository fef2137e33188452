# SPDX-License-Identifier: Apache-2.0
"""The Thing Description, consumed by node-wot over its Modbus binding: values, and an action."""

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.map_table import POINTS, Command
from served import Served

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "wot"
SCRIPT = ROOT / "tests" / "serve" / "masters" / "wot.js"
PACKAGES = ("@node-wot/core@0.8.16", "@node-wot/binding-modbus@0.8.16")
BEYOND_IT = {point.name for point in POINTS.values() if point.type == "i64"}
"""Its decoder ends at 48 bits."""


def fetch() -> None:
    if not shutil.which("npm"):
        pytest.skip("no npm")
    if not (FOLDER / "node_modules" / "@node-wot" / "binding-modbus").is_dir():
        FOLDER.mkdir(parents=True, exist_ok=True)
        npm = ["npm", "install", "--silent", "--no-audit", "--no-fund", "--ignore-scripts"]
        done = subprocess.run(
            [*npm, "--prefix", FOLDER, *PACKAGES], capture_output=True, timeout=400, check=False
        )
        if done.returncode != 0:
            pytest.skip(f"npm cannot fetch {PACKAGES}")


def test_every_property_and_an_action(start: Callable[..., Served], tmp_path: Path) -> None:
    fetch()
    served = start()
    served.index()
    served.turn_back()
    description = tmp_path / "td.json"
    told = (ROOT / "modbus_map" / "tags_wot_td.json").read_text()
    description.write_text(told.replace("127.0.0.1:1502", f"127.0.0.1:{served.gate}"))
    shutil.copy(SCRIPT, FOLDER / "wot.js")  # it looks for its modules beside it

    def consume(*actions: str) -> dict[str, object]:
        done = subprocess.run(
            ["node", "wot.js", description, *actions],
            cwd=FOLDER, capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        values = json.loads(done.stdout)
        return {name: value for name, value in values.items() if name not in BEYOND_IT}

    served.compare(consume)
    consume("stop")
    with served.device() as device:
        assert device.value("command_code") == Command.STOP
