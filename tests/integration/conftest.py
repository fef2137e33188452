"""The integration suite talks Modbus to a running slave, whichever it is.

--target sim                 starts the simulator (default)
--target serial:/dev/ttyX    a slave that is there already; it must have the bench block
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from slave import RawLine, Simulator, Slave, bring_to_rest, start_simulator


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--target", default="sim", help="sim, or serial:PATH")


@pytest.fixture(scope="session")
def target(request: pytest.FixtureRequest) -> str:
    return request.config.getoption("--target")


@pytest.fixture(scope="module")
def simulator(target: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Simulator | None]:
    if target != "sim":
        yield None
        return
    running = start_simulator(
        tmp_path_factory.mktemp("sim"),
        "--speed",
        "10",
        "--storage",
        str(tmp_path_factory.mktemp("storage") / "parameters.bin"),
    )
    yield running
    if running.process.poll() is None:
        assert running.stop() == 0


@pytest.fixture
def own_simulator(target: str) -> Iterator[Callable[..., Simulator]]:
    """Starts simulators of the test's own, and ends what the test has left running."""
    if target != "sim":
        pytest.skip("needs a simulator of its own")
    running = []

    def start(folder: Path, *options: str) -> Simulator:
        running.append(start_simulator(folder, *options))
        return running[-1]

    yield start
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
    bring_to_rest(connected)
    yield connected
    connected.close()


@pytest.fixture
def raw(port: str) -> Iterator[RawLine]:
    line = RawLine(port)
    yield line
    line.close()
