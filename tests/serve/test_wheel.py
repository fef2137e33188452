# SPDX-License-Identifier: Apache-2.0
"""The wheel: the whole tool with its compiled core, away from the source tree."""

import os
import subprocess
import sys
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
    server = subprocess.Popen(
        [python.parent / "levelwind", "serve", "--simulator", "--listen", "127.0.0.1:0"],
        stdout=subprocess.PIPE, text=True, cwd=tmp_path, env=clean,
    )  # fmt: skip
    try:
        assert server.stdout is not None
        assert server.stdout.readline().startswith("ready http://127.0.0.1:")
    finally:
        server.terminate()
        server.wait(20)
