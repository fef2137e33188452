# SPDX-License-Identifier: Apache-2.0
"""Masters in other languages, through the gateway: what they read is what the line says.

Their compilers take both cores for a minute: beside tests in real time they would make those late.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from served import Served
from slave import RawLine

pytestmark = pytest.mark.skipif(
    "LEVELWIND_LANGUAGES" not in os.environ,
    reason="fetches and compiles Node, Go, Rust and Java: LEVELWIND_LANGUAGES=1",
)
MASTERS = Path(__file__).parent / "masters"
BUILD = Path(__file__).resolve().parents[2] / "build"
# Nothing here changes while nobody does anything; the last three are refused.
READS = [(2, 0, 42), (1, 0, 8), (3, 110, 60), (4, 0, 10), (4, 50, 1), (3, 110, 126), (1, 900, 1)]


def fetched(*command: object, **options: object) -> bool:
    done = subprocess.run(
        list(map(str, command)), capture_output=True, timeout=400, check=False, **options
    )
    return done.returncode == 0


def node(port: int, wanted: list[str]) -> list[object]:
    if not shutil.which("npm"):
        pytest.skip("no npm")
    folder = BUILD / "npm"
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "node_modules" / "modbus-serial").is_dir() and not fetched(
        *("npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", folder),
        "modbus-serial@8",
    ):
        pytest.skip("npm cannot fetch modbus-serial")
    return ["node", MASTERS / "read.js", port, *wanted]


def go(port: int, wanted: list[str]) -> list[object]:
    if not shutil.which("go"):
        pytest.skip("no Go")
    folder = BUILD / "go"
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(MASTERS / "read.go", folder / "main.go")
    if not (folder / "master").is_file():
        (folder / "go.mod").unlink(missing_ok=True)
        if not (
            fetched("go", "mod", "init", "master", cwd=folder)
            and fetched("go", "mod", "tidy", cwd=folder)
            and fetched("go", "build", "-o", "master", ".", cwd=folder)
        ):
            pytest.skip("Go cannot fetch simonvetter/modbus")
    return [folder / "master", port, *wanted]


def rust(port: int, wanted: list[str]) -> list[object]:
    if not shutil.which("cargo"):
        pytest.skip("no Rust")
    folder = BUILD / "rust"
    (folder / "src").mkdir(parents=True, exist_ok=True)
    shutil.copy(MASTERS / "read.rs", folder / "src" / "main.rs")
    if not (folder / "target" / "debug" / "master").is_file():
        (folder / "Cargo.toml").write_text(
            '[package]\nname = "master"\nversion = "0.0.0"\nedition = "2021"\n[workspace]\n'
        )
        if not (
            fetched(
                *("cargo", "add", "tokio-modbus@0.17", "--no-default-features"),
                *("--features", "tcp-sync"),
                cwd=folder,
            )
            and fetched("cargo", "build", cwd=folder)
        ):
            pytest.skip("cargo cannot fetch tokio-modbus")
    return [folder / "target" / "debug" / "master", port, *wanted]


def java(port: int, wanted: list[str]) -> list[object]:
    if not (shutil.which("mvn") and shutil.which("javac")):
        pytest.skip("no Java with Maven")
    folder = BUILD / "java"
    if not (folder / "Read.class").is_file():
        pom = ("mvn", "-q", "-B", "-f", MASTERS / "pom.xml")
        jars = folder / "jars"
        if not (
            fetched(*pom, "dependency:copy-dependencies", f"-DoutputDirectory={jars}")
            and fetched("javac", "-cp", f"{jars}/*", "-d", folder, MASTERS / "Read.java")
        ):
            pytest.skip("Maven cannot fetch digitalpetri's modbus")
    return ["java", "-cp", f"{folder}:{folder / 'jars'}/*", "Read", port, *wanted]


@pytest.mark.parametrize("master", [node, go, rust, java])
def test_they_read_what_the_line_says(
    start: Callable[..., Served], master: Callable[[int, list[str]], list[object]]
) -> None:
    served = start(write=False)
    wanted = [",".join(map(str, read)) for read in READS]
    command = master(served.gate, wanted)
    done = subprocess.run(
        list(map(str, command)),
        capture_output=True, text=True, timeout=60, check=False,
        env={**os.environ, "NODE_PATH": str(BUILD / "npm" / "node_modules")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    served.stop()
    line = RawLine(str(served.port))
    for read, told in zip(READS, json.loads(done.stdout.splitlines()[-1]), strict=True):
        function, address, count = read
        answer = line.request(
            bytes([function]) + address.to_bytes(2, "big") + count.to_bytes(2, "big")
        )
        expected = f"exception {answer[1]}" if answer[0] & 0x80 else answer[2:].hex()
        assert told == expected, read
    line.close()
