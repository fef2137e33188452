"""Three independent masters, pymodbus, libmodbus (the C client) and mbpoll, see the same slave."""

import os
import re
import subprocess

import pytest
from levelwind.map_table import POINTS
from slave import TEST_DIR, UNIT, Slave

REGISTERS = [
    "self_test",
    "map_version",
    "state",
    "nr",
    "ks",
    "reversal_minus_usteps",
    "overshoot_actual_um",
    "encoder_pulses_per_rev",
    "reversal_minus_um",
    "baud_rate",
]


MBPOLL = ["mbpoll", "-m", "rtu", "-a", str(UNIT), "-b", "19200", "-P", "none", "-0", "-1", "-q"]


def mbpoll(port: str, *options: str, write: str = "") -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*MBPOLL, "-o", "2", *options, port, *write.split()],
        capture_output=True,
        text=True,
        timeout=20,
        check=False,
    )


def mbpoll_read(port: str, name: str) -> int:
    point = POINTS[name]
    kind = {"input": "3", "holding": "4"}[point.space]
    options = ["-t", f"{kind}:int", "-B"] if point.words == 2 else ["-t", kind]
    answer = mbpoll(port, *options, "-r", str(point.address))
    assert answer.returncode == 0, answer.stdout + answer.stderr
    match = re.search(rf"\[{point.address}\]:\s+(-?\d+)(?: \((-\d+)\))?", answer.stdout)
    assert match, answer.stdout
    value = int(match[1])
    return value - 0x10000 if point.type == "i16" and value > 0x7FFF else value


@pytest.mark.parametrize("name", REGISTERS)
def test_mbpoll_and_pymodbus_agree(slave: Slave, name: str) -> None:
    expected = slave.read(name)
    slave.close()
    value = mbpoll_read(slave.port, name)
    assert value & 0xFFFFFFFF == expected & 0xFFFFFFFF


def test_mbpoll_changes_a_parameter_and_is_refused(slave: Slave) -> None:
    slave.close()
    address = str(POINTS["encoder_pulses_per_rev"].address)
    good = mbpoll(slave.port, "-t", "4", "-r", address, write="500")
    assert good.returncode == 0, good.stdout + good.stderr
    bad = mbpoll(slave.port, "-t", "4", "-r", address, write="0")
    assert bad.returncode != 0
    assert "Illegal data value" in bad.stdout + bad.stderr
    missing = mbpoll(slave.port, "-t", "4", "-r", "50", write="1")
    assert "Illegal data address" in missing.stdout + missing.stderr
    again = Slave(slave.port)
    assert again.read("encoder_pulses_per_rev") == 500
    again.close()


def test_libmodbus_client(slave: Slave) -> None:
    """The tests of the C client, run against this slave."""
    slave.close()
    done = subprocess.run(
        [str(TEST_DIR / "test_client")],
        env={**os.environ, "LEVELWIND_PORT": slave.port},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"^[1-9]\d* Tests 0 Failures 0 Ignored", done.stdout, re.M), done.stdout
