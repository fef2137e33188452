# SPDX-License-Identifier: Apache-2.0
"""The wheel: the whole tool with its compiled core, away from the source tree."""

import os
import re
import socket
import subprocess
import sys
import time
import urllib.request
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*command: object, **options: object) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=600, check=False, **options
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    run(
        *(sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", folder),
        ROOT / "host_tools" / "python",
        env={**os.environ, "HATCH_BUILD_HOOKS_ENABLE": "true"},  # as ./dev wheel
    )
    found = list(folder.glob("levelwind-*.whl"))
    assert len(found) == 1
    return found[0]


def test_what_is_in_it(wheel: Path) -> None:
    assert "-py3-none-" in wheel.name
    names = zipfile.ZipFile(wheel).namelist()
    for name in (
        *("_native/lw_sim", "_native/liblw_native.so", "profiles/field_setup.yaml"),
        *("serve/page/page.js", "serve/page/index.html", "map_table.py"),
    ):
        assert f"levelwind/{name}" in names
    assert not [name for name in names if "test" in name]


def test_it_runs_without_the_source_tree(wheel: Path, tmp_path: Path) -> None:
    """Into an environment of its own, in a folder of its own: the demonstration, and the server."""
    run(sys.executable, "-m", "venv", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    run(python, "-m", "pip", "install", "--quiet", f"{wheel}[serve]")
    clean = {name: value for name, value in os.environ.items() if not name.startswith("LEVELWIND")}
    clean |= {"PATH": f"{python.parent}:/usr/bin:/bin"}
    done = run(python.parent / "levelwind", "demo", "--out", "out", cwd=tmp_path, env=clean)
    assert "FAILED" not in done.stdout
    assert (tmp_path / "out" / "launch.png").stat().st_size > 10_000
    where = run(
        python, "-c", "import levelwind; print(levelwind.__file__)", cwd=tmp_path, env=clean
    )
    assert str(tmp_path) in where.stdout
    serves(python.parent / "levelwind", tmp_path, clean)
    project = (ROOT / "host_tools" / "python" / "pyproject.toml").read_text()
    (needed,) = re.findall(r"^serve = \[\n(.*?)^\]", project, re.DOTALL | re.MULTILINE)
    oldest = [f"{name}=={version}" for name, version in re.findall(r'"(.+)>=(.+)"', needed)]
    assert "uvicorn" in str(oldest)
    run(python, "-m", "pip", "install", "--quiet", *oldest)
    serves(python.parent / "levelwind", tmp_path, clean, pings=True)


def hangs_up_on_who_does_not_answer_pings(port: int) -> None:
    """A page whose cable is pulled must not keep its place."""
    with socket.create_connection(("127.0.0.1", port), 5) as page:
        head = f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: Upgrade\r\n"
        head += "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
        page.sendall(f"{head}{'A' * 22}==\r\n\r\n".encode())
        assert page.recv(12) == b"HTTP/1.1 101"
        end = time.monotonic() + 20
        while page.recv(4096):
            assert time.monotonic() < end, "it stays"


def serves(tool: Path, folder: Path, environment: dict[str, str], pings: bool = False) -> None:
    """The page and the numbers."""
    server = subprocess.Popen(
        [tool, "serve", "--simulator", "--listen", "127.0.0.1:0"],
        stdout=subprocess.PIPE, text=True, cwd=folder, env=environment,
    )  # fmt: skip
    try:
        assert server.stdout is not None
        said = server.stdout.readline()
        assert said.startswith("ready http://127.0.0.1:")
        url = said.split()[1]
        with urllib.request.urlopen(f"{url}metrics", timeout=10) as answer:
            assert b"levelwind_up" in answer.read()
        if pings:
            hangs_up_on_who_does_not_answer_pings(int(url.rstrip("/").rpartition(":")[2]))
    finally:
        server.terminate()
        server.wait(20)
