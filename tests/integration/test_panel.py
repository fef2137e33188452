"""The example of an operator panel: what it shows, and that it comes back after a cut line."""

import subprocess
from collections.abc import Callable, Iterator

import pytest
from levelwind.map_table import Command, Fault, Flag
from slave import NATIVE_DIR, Simulator, Slave


class Panel:
    """The running program; what it says is read line by line."""

    def __init__(self, port: str) -> None:
        self.process = subprocess.Popen(
            [str(NATIVE_DIR / "levelwind_panel"), port, "N"], stdout=subprocess.PIPE, text=True
        )

    def wait_for(self, *texts: str) -> None:
        """Read until a line contains one of the texts, then the others in any order."""
        missing = set(texts)
        assert self.process.stdout is not None
        for _ in range(80):
            line = self.process.stdout.readline()
            missing -= {text for text in missing if text in line}
            if not missing:
                return
        raise AssertionError(f"the panel never said {missing}")


@pytest.fixture
def panels() -> Iterator[Callable[[str], Panel]]:
    running: list[Panel] = []

    def start(port: str) -> Panel:
        running.append(Panel(port))
        return running[-1]

    yield start
    for panel in running:
        panel.process.kill()
        panel.process.wait()


def test_comes_back_after_the_line_was_cut(
    own_simulator: Callable[..., Simulator], panels: Callable[[str], Panel], target: str
) -> None:
    if target != "sim":
        pytest.skip("only the simulator has the same port again")
    simulator = own_simulator()
    panel = panels(str(simulator.port))
    panel.wait_for("Position unknown", "no launch")
    assert simulator.stop() == 0
    panel.wait_for("no data")
    panel.wait_for("no data: cannot open")
    own_simulator()
    panel.wait_for("level wind controller")
    panel.wait_for("Position unknown")


def test_shows_fault_and_loss_of_synchronization(
    slave: Slave, panels: Callable[[str], Panel]
) -> None:
    slave.command(Command.INDEX)
    slave.write("bench_drum_speed_millirpm", 400_000)
    slave.wait(lambda: slave.read("position_um") > 0)
    slave.write("bench_stall", 1)
    slave.wait(lambda: slave.flag(Flag.LOS))
    slave.write("bench_stall", 0)
    slave.write("bench_overtravel_plus", 1)
    slave.wait(lambda: slave.read("fault") == Fault.OVERTRAVEL_PLUS)
    slave.close()
    panel = panels(slave.port)
    panel.wait_for("THE ROPE MAY BE LAID WRONG: LOS type", f"FAULT: {Fault.OVERTRAVEL_PLUS.text}")
    panel.process.kill()
    panel.process.wait()
    after = Slave(slave.port)
    after.write("bench_overtravel_plus", 0)
    after.close()
