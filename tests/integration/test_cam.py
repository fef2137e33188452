# SPDX-License-Identifier: Apache-2.0
"""A cam table over the line: loaded by the tool, followed, changed as it runs, kept."""

from collections.abc import Callable
from math import cos, pi
from pathlib import Path

from levelwind.cam.table import Table
from levelwind.files import cam_files
from levelwind.map_table import (
    BenchCommand,
    CamBankState,
    CamInterpolation,
    Command,
    Flag,
    Result,
    State,
)
from rational_cam import RationalCam
from slave import Simulator, Slave
from test_life import turn_drum
from test_restart import reconnect
from test_tool import output, refusal

# As many rows as fit; the stepper can follow both at these speeds.
HILL = Table(tuple((40 * i, round(2_000 * (1 - cos(2 * pi * i / 255)))) for i in range(256)))
PIT = Table(((0, 0), (5_000, -2_000), (15_000, 0)), CamInterpolation.TRAPEZOID)
# One that asks for 4.01 steps per edge in its second row.
STEEP = Table(((0, 0), (500, 100), (600, 501), (2_000, 0)))


def write_table(path: Path, table: Table) -> str:
    path.write_text("\n".join(f"{master}, {slave}" for master, slave in table.rows))
    return str(path)


def cam_on(slave: Slave) -> None:
    """Index in the middle, follow the table in force."""
    for name, value in {"motion_profile": 1, "park_at": 1, "park_position_um": 0}.items():
        assert slave.write(name, value) == 0
    assert slave.command(Command.APPLY) == Result.DONE
    assert slave.command(Command.INDEX) == Result.DONE
    slave.wait(lambda: slave.read("state") == State.TRACKING)


def banks(slave: Slave) -> tuple[int, int]:
    return slave.read("cam_bank_0_state"), slave.read("cam_bank_1_state")


def check_follows(slave: Slave, model: RationalCam, looks: int = 20) -> None:
    """Whatever the drum does, position and odometer of one moment belong together."""
    for _ in range(looks):
        at = slave.read_run("net_edges", "position_usteps")
        assert at["position_usteps"] == model.usteps(at["net_edges"])


def run_tool(slave: Slave, *arguments: str) -> str:
    """The tool while this side is silent."""
    slave.close()
    try:
        return output(slave.port, *arguments)
    finally:
        assert slave.client.connect()


def test_a_table_from_the_file_to_the_carriage(slave: Slave, tmp_path: Path) -> None:
    assert "256 rows checked" in run_tool(
        slave, "cam", "upload", write_table(tmp_path / "hill.csv", HILL)
    )
    assert CamBankState.READY in banks(slave)
    assert "In force" in run_tool(slave, "cam", "activate")
    cam_on(slave)
    turn_drum(slave, 150_000)
    slave.wait(lambda: slave.read("cam_cycles") > 1)
    check_follows(slave, RationalCam(HILL))

    # As it runs: one that is refused, and one that comes into force at the end of the cycle.
    slave.close()
    said = refusal(slave.port, "cam", "upload", write_table(tmp_path / "steep.csv", STEEP))
    assert "Row 2" in said
    assert "4010" in said
    assert slave.client.connect()
    check_follows(slave, RationalCam(HILL))
    run_tool(
        *(slave, "cam", "upload", write_table(tmp_path / "pit.csv", PIT)), "--interp", "trapezoid"
    )
    turn_drum(slave, -100_000)
    slave.wait(lambda: slave.read("bench_drum_speed_millirpm") == -100_000)
    check_follows(slave, RationalCam(HILL))
    cycle = HILL.rows[-1][0]
    slave.wait(lambda: slave.read("net_edges") % cycle > 0.8 * cycle)
    joint = slave.read("net_edges") // cycle * cycle
    assert slave.command(Command.CAM_ACTIVATE) == Result.DONE
    assert CamBankState.QUEUED in banks(slave)
    check_follows(slave, RationalCam(HILL), looks=3)
    slave.wait(lambda: CamBankState.QUEUED not in banks(slave))
    turn_drum(slave, 150_000)
    slave.wait(lambda: slave.read("net_edges") > joint + cycle)
    turn_drum(slave, 0)
    slave.wait(lambda: slave.flag(Flag.DRUM_AT_REST))
    at = slave.read_run("net_edges", "position_usteps")
    assert at["position_usteps"] == RationalCam(PIT).usteps(at["net_edges"] - joint)
    assert slave.flag(Flag.LAUNCH_PERMIT)
    assert abs(slave.read("bench_carriage_um") - slave.read("position_um")) < 300


def test_what_is_in_force_is_there_after_a_power_cut(slave: Slave, tmp_path: Path) -> None:
    for version, table in enumerate((HILL, PIT), 3):
        path = write_table(tmp_path / f"table_{version}.csv", table)
        run_tool(slave, "cam", "activate", path, "--version", str(version))
        slave.wait(lambda: slave.read("cam_stored") == 1)
    boots = slave.read("boots")
    slave.write("bench_command", BenchCommand.POWER_CUT)
    reconnect(slave, lambda slave: slave.read("boots") == boots + 1)
    assert (slave.read("cam_version"), slave.read("cam_rows")) == (4, len(PIT.rows))
    assert slave.read("cam_stored") == 1
    again = tmp_path / "again.csv"
    assert "table_4, version 4: 3 rows" in run_tool(slave, "cam", "download", str(again))
    assert "5000,-2000" in again.read_text()
    # And the one before it.
    assert slave.command(Command.CAM_ACTIVATE) == Result.DONE
    assert (slave.read("cam_version"), slave.read("cam_rows")) == (3, len(HILL.rows))


def test_an_upload_is_what_download_next_reads_also_before_anything_is_in_force(
    own_simulator: Callable[..., Simulator], tmp_path: Path
) -> None:
    port = str(own_simulator().port)
    table = tmp_path / "table.csv"
    assert "No table is in force" in refusal(port, "cam", "download", str(table))
    assert "No table was uploaded" in refusal(port, "cam", "download", "--next", str(table))
    assert not table.exists()
    output(port, "cam", "upload", write_table(tmp_path / "hill.csv", HILL))
    assert "256 rows" in output(port, "cam", "download", "--next", str(table))
    assert cam_files.read(table) == HILL.rows
    output(port, "cam", "activate")
    # And whichever bank is in force.
    for uploaded, in_force in ((PIT, HILL), (HILL, PIT)):
        output(port, "cam", "upload", write_table(tmp_path / "next.csv", uploaded))
        output(port, "cam", "download", "--next", str(table))
        assert cam_files.read(table) == uploaded.rows
        output(port, "cam", "download", str(table))
        assert cam_files.read(table) == in_force.rows
        output(port, "cam", "activate")
