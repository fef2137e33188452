# SPDX-License-Identifier: Apache-2.0
"""Core, native library and simulator as Windows programs: by mingw-w64, run by wine."""

import os
import re
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from levelwind.core import layout, native
from levelwind.line.device import Device
from levelwind.line.port import Line
from levelwind.map_table import Flag
from served import TOOL, RawTcp, free_port, wait

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "host_tools" / "python" / "src" / "levelwind"
CROSS = ROOT / "cmake" / "mingw-w64.cmake"
COMPILER = "x86_64-w64-mingw32-gcc"
WINE = shutil.which("wine64") or shutil.which("wine")
needs_wine = pytest.mark.skipif(WINE is None, reason="no wine: apt-get install wine64 wine")
pytestmark = pytest.mark.skipif(
    shutil.which(COMPILER) is None, reason="no mingw-w64: apt-get install gcc-mingw-w64-x86-64"
)


def run(*command: object, **options: object) -> str:
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=300, check=False, **options
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("windows")
    run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", f"-DCMAKE_TOOLCHAIN_FILE={CROSS}",
        "-DLW_TOOL_ONLY=ON")  # fmt: skip
    run("cmake", "--build", folder)
    return folder


@pytest.fixture(scope="module")
def wine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Surroundings of wine: a Windows of its own, that asks nobody for anything."""
    surroundings = {
        **os.environ,
        "WINEPREFIX": str(tmp_path_factory.mktemp("wine")),
        "WINEDEBUG": "-all",
        "WINEDLLOVERRIDES": "mscoree,mshtml,winemenubuilder.exe=",
        "DISPLAY": "",
    }
    yield surroundings
    subprocess.run(["wineserver", "--kill"], env=surroundings, check=False, capture_output=True)


def called_functions() -> set[str]:
    """What the tool calls of the native library."""
    text = "".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    return set(re.findall(r"\.(lw_native_\w+)", text))


def test_they_need_nothing_but_windows(built: Path) -> None:
    for name in ("lw_sim.exe", "liblw_native.dll"):
        assert (built / name).read_bytes().startswith(b"MZ")
        dump = run("x86_64-w64-mingw32-objdump", "-p", built / name)
        needed = {line.split()[-1].upper() for line in dump.splitlines() if "DLL Name" in line}
        assert needed <= {"KERNEL32.DLL", "MSVCRT.DLL", "WS2_32.DLL"}, "what every Windows has"


@needs_wine
def test_the_library_is_what_the_tool_expects(
    built: Path, wine: dict[str, str], tmp_path: Path
) -> None:
    include = ROOT / "lib" / "lw_core" / "include"
    program = tmp_path / "library.exe"
    run(COMPILER, "-Wall", "-Werror", "-I", include, "-o", program,
        Path(__file__).with_name("windows_library.c"))  # fmt: skip
    functions = called_functions()
    assert "lw_native_derive" in functions
    said = run(WINE, program, "liblw_native.dll", *functions, cwd=built, env=wine).splitlines()
    assert (
        said[-1]
        == f"screw_lead_mm {native.library().lw_native_machine_default(b'screw_lead_mm'):.3f}"
    )
    here = [
        f"{kind} {name} {offset} {size}".replace("  ", " ")
        for kind, members in layout.exported(native.library(), "lw_layout_native").items()
        for name, (offset, size) in members.items()
    ]
    assert sorted(line.replace("  ", " ") for line in said[:-1]) == sorted(here)


@needs_wine
def test_the_simulator_serves_the_tool(built: Path, wine: dict[str, str], tmp_path: Path) -> None:
    """Indexed, wound out and in, parameters kept over a restart; two clients at a time."""
    address = f"127.0.0.1:{free_port()}"

    def start() -> subprocess.Popen[str]:
        simulator = subprocess.Popen(
            [WINE, built / "lw_sim.exe", "--tcp", address, "--storage", "kept", "--speed", "4"],
            stdout=subprocess.PIPE, text=True, cwd=tmp_path, env=wine,
        )  # fmt: skip
        assert simulator.stdout is not None
        assert simulator.stdout.readline().strip() == f"ready tcp://{address}"
        return simulator

    simulator = start()
    port = ("--port", f"tcp://{address}")
    try:
        run(TOOL, "save", *port)
        assert "tracking" in run(TOOL, "index", *port)
        with Device(Line(f"tcp://{address}")) as device:
            other = RawTcp(int(address.rpartition(":")[2]))
            for speed in (-300_000, 300_000, 0):
                before = device.value("net_edges")
                device.write({"bench_drum_speed_millirpm": speed})
                wait(lambda before=before, speed=speed: (
                    device.value("drum_at_rest") if speed == 0
                    else abs(device.value("net_edges") - before) > 20_000
                ), 60, f"the drum at {speed}")  # fmt: skip
                assert other.request(bytes([4, 0, 100, 0, 1]))[:2] == bytes([4, 2])
            other.close()
            assert device.value("flags") >> Flag.LAUNCH_PERMIT & 1
            assert not device.value("flags") >> Flag.LOS & 1
    finally:
        simulator.send_signal(signal.SIGKILL)
        simulator.wait(20)
    simulator = start()
    try:
        with Device(Line(f"tcp://{address}")) as device:
            assert not device.value("flags") >> Flag.DEFAULTS_LOADED & 1, "what was saved is there"
    finally:
        simulator.kill()
        simulator.wait(20)
