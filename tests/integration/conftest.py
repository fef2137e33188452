# SPDX-License-Identifier: Apache-2.0
"""The integration suite talks Modbus to a running slave, whichever it is.

--target sim                 starts the simulator (default)
--target native_sim          starts the firmware, built for Zephyr's native_sim
--target board               starts the firmware for the Nucleo on the board of tests/board
--target qemu                starts the firmware, built for mps2/an385, in QEMU
--target serial:/dev/ttyX    a slave that is there already; it must have the bench block
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from slave import RawLine, Simulator, Slave, bring_to_rest, start


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--target", default="sim", help="sim, native_sim, board, qemu, or serial:PATH")


@pytest.fixture(scope="session")
def target(request: pytest.FixtureRequest) -> str:
    return request.config.getoption("--target")


@pytest.fixture(scope="module")
def simulator(
    request: pytest.FixtureRequest, target: str, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Simulator | None]:
    """One for a module, which may give the simulator SIMULATOR_OPTIONS."""
    if target.startswith("serial:"):
        yield None
        return
    folder = tmp_path_factory.mktemp(target)
    options = getattr(request.module, "SIMULATOR_OPTIONS", ())
    running = start(target, folder, folder / "parameters.bin", fast=True, options=options)
    yield running
    if running.process.poll() is None:
        assert running.stop() == 0


@pytest.fixture
def own_simulator(target: str, tmp_path: Path) -> Iterator[Callable[..., Simulator]]:
    """Starts programs of the test's own, and ends what the test leaves running."""
    if target.startswith("serial:"):
        pytest.skip("needs a program of its own")
    running = []

    def start_one(storage: Path = tmp_path / "parameters.bin") -> Simulator:
        running.append(start(target, tmp_path, storage))
        return running[-1]

    yield start_one
    for simulator in running:
        simulator.process.kill()
        simulator.process.wait()


@pytest.fixture(scope="module")
def port(target: str, simulator: Simulator | None) -> str:
    return str(simulator.port) if simulator else target.removeprefix("serial:")


@pytest.fixture
def slave(port: str) -> Iterator[Slave]:
    """The slave at rest: nothing moves, factory parameters staged and active."""
    connected = Slave(port)
    try:
        bring_to_rest(connected)
        yield connected
    finally:  # or the port stays locked for all who come next
        connected.close()


@pytest.fixture
def raw(port: str) -> Iterator[RawLine]:
    line = RawLine(port)
    yield line
    line.close()
