# SPDX-License-Identifier: Apache-2.0
"""The compiled simulator as a process."""

import os
import signal
import subprocess
import threading
from pathlib import Path

from levelwind.core import native
from levelwind.errors import ToolError
from levelwind.simulate.machine import Machine

START_LIMIT_S = 10.0
END_LIMIT_S = 10.0


def arguments(
    port: str | None,
    speed: str | None = None,
    seed: int | None = None,
    storage: Path | None = None,
    trace: Path | None = None,
    unit: int | None = None,
    frame_silence_ms: int | None = None,
    tcp: str | None = None,
    machine: Machine | None = None,
    as_parameters: bool = False,
) -> list[str]:
    """The command line of lw_sim: at a port, or at ADDRESS:PORT for Modbus TCP."""
    given = {
        "port": port,
        "tcp": tcp,
        "speed": speed,
        "seed": seed,
        "storage": storage,
        "trace": trace,
        "unit": unit,
        "frame-silence-ms": frame_silence_ms,
    }
    line = [str(native.find(native.SIMULATOR))]
    for name, value in given.items():
        if value is not None:
            line += [f"--{name}", str(value)]
    if as_parameters:
        line.append("--as-parameters")
    return line + (machine.arguments() if machine else [])


def become(line: list[str]) -> None:
    """Run the simulator in place of this process: its output, signals and exit status."""
    try:
        os.execv(line[0], line)
    except OSError as error:
        raise ToolError(f"{line[0]} cannot be started: {error.strerror}.") from error


class Simulator:
    """A simulator in the background; leaving the `with` block ends it."""

    def __init__(self, line: list[str]) -> None:
        # Away from the terminal: Ctrl-C reaches only the tool, which ends the simulator in order.
        self._process = subprocess.Popen(
            line, stdout=subprocess.PIPE, text=True, start_new_session=True
        )
        guard = threading.Timer(START_LIMIT_S, self._process.kill)
        guard.start()
        try:
            first = self._process.stdout.readline() if self._process.stdout else ""
        finally:
            guard.cancel()
        if not first.startswith("ready "):
            self.end()
            raise ToolError("The simulator did not start.")
        self.port = first.removeprefix("ready ").strip()

    def __enter__(self) -> "Simulator":
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    def end(self) -> int:
        """Ask it to end, so that its files are complete; its exit status."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
        try:
            return self._process.wait(END_LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            return self._process.wait()

    def wait(self) -> int:
        """Until it ends by itself."""
        return self._process.wait()
