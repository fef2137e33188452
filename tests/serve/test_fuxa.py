# SPDX-License-Identifier: Apache-2.0
"""The project for FUXA, in FUXA: it takes it, reads every tag, and draws the panel.

FUXA is a quarter of a gigabyte and compiles its own SQLite: LEVELWIND_INTEGRATIONS=1 fetches it by
npm, and what has been fetched is used again.
"""

import json
import os
import shutil
import subprocess
import urllib.parse
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect
from served import Served, free_port, wait

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "fuxa"
PROJECT = ROOT / "modbus_map" / "tags_fuxa.json"
PACKAGES = ("@frangoteam/fuxa@1.3.4", "modbus-serial@8")
NODE = Path("/usr")  # its headers, which SQLite's binding is compiled with


def fetch() -> Path:
    main = FOLDER / "node_modules" / "@frangoteam" / "fuxa" / "main.js"
    binding = FOLDER / "node_modules" / "sqlite3" / "build" / "Release" / "node_sqlite3.node"
    if not binding.is_file():
        if "LEVELWIND_INTEGRATIONS" not in os.environ or not shutil.which("npm"):
            pytest.skip("LEVELWIND_INTEGRATIONS=1 fetches FUXA by npm")
        FOLDER.mkdir(parents=True, exist_ok=True)
        npm = ["npm", "--silent", "--prefix", str(FOLDER)]
        flags = ["--no-audit", "--no-fund", "--ignore-scripts"]
        subprocess.run([*npm, "install", *flags, *PACKAGES], check=True)
        subprocess.run(
            [*npm, "rebuild", "sqlite3"],
            env={
                **os.environ,
                "npm_config_nodedir": str(NODE),
                "npm_config_build_from_source": "1",
            },
            check=True,
        )
    return main


@pytest.fixture
def fuxa(tmp_path: Path) -> Iterator[str]:
    main, port = fetch(), free_port()
    folder = tmp_path / "fuxa"
    folder.mkdir()
    said = (tmp_path / "fuxa.log").open("w")
    process = subprocess.Popen(
        ["node", str(main), "--port", str(port), "--userDir", str(folder)],
        stdout=said, stderr=said,
    )  # fmt: skip
    url = f"http://127.0.0.1:{port}"

    def answers() -> bool:
        assert process.poll() is None, (tmp_path / "fuxa.log").read_text()
        try:
            return bool(ask(f"{url}/api/version"))
        except OSError:
            return False

    wait(answers, 60, "FUXA")
    yield url
    process.kill()
    process.wait()


def ask(url: str, body: bytes | None = None) -> bytes:
    request = urllib.request.Request(url, body, {"content-type": "application/json"})
    with urllib.request.urlopen(request, timeout=10) as answer:
        return answer.read()


def test_the_panel(
    start: Callable[..., Served], fuxa: str, browser: Browser, tmp_path: Path
) -> None:
    served = start()
    served.index()
    served.turn_back()
    project = json.loads(PROJECT.read_text())
    device = project["devices"]["levelwind"]
    device["property"]["address"] = f"127.0.0.1:{served.gate}"
    ask(f"{fuxa}/api/project", json.dumps(project).encode())
    by_name = {tag["name"]: tag for tag in device["tags"].values()}
    ids = urllib.parse.quote(json.dumps(list(device["tags"])))

    def values() -> dict[str, float | None]:
        read = json.loads(ask(f"{fuxa}/api/getTagValue?ids={ids}"))
        return {tag["id"].removeprefix("levelwind_"): tag["value"] for tag in read}

    wait(lambda: None not in values().values(), 20, "every tag")

    def read() -> dict[str, object]:
        """What it has read after now, in the map's units: it asks again and again by itself."""
        for _ in range(2):
            seen = values()["uptime_ms"]
            wait(lambda seen=seen: values()["uptime_ms"] != seen, what="a round of all tags")
        scaled = {name: tag["divisor"] for name, tag in by_name.items() if tag["divisor"] != 1}
        told = {name: value for name, value in values().items() if name not in scaled}
        assert scaled.keys() > {"position_um", "rope_on_drum_mm"}
        return told

    still = served.compare(read)
    assert still > {"state", "launch_inhibit", "span_error_um", "ka", "net_edges", "slot_7"}
    told = values()
    with served.device() as line:
        for name in ("position_um", "rope_on_drum_mm", "rope_out_mm"):
            assert told[name] == round(line.value(name) / 1000, 1), name

    page = browser.new_page(viewport={"width": 1280, "height": 900})
    wrong: list[str] = []
    page.on("console", lambda message: message.type == "error" and wrong.append(message.text))
    page.goto(f"{fuxa}/home")
    said = "{} option:checked"
    expect(page.locator(said.format("#S-HXS_launch_permit"))).to_have_text("LAUNCH PERMITTED")
    expect(page.locator("#VAL_position_um text")).to_have_text(str(told["position_um"]))
    (ROOT / "out").mkdir(exist_ok=True)
    page.screenshot(path=ROOT / "out" / "fuxa.png")
    assert wrong == []
    served.kill()
    expect(page.locator(said.format("#S-HXS_map_version"))).to_have_text("▲ NO DATA", timeout=20000)
    expect(page.locator(said.format("#S-HXS_launch_permit"))).to_have_text("▲ NO LAUNCH")
    page.close()
