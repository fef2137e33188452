# SPDX-License-Identifier: Apache-2.0
"""Every command of the tool, wherever its output goes: no traceback, and nothing cut that matters.

The commands are those that the tool has: a new one without a line here fails.
"""

import signal
import subprocess
from pathlib import Path

import pytest
import typer
from levelwind.cli import app
from levelwind.serve.recorder import Launches
from on_terminal import TERMINALS, leaves, on_a_terminal, words
from served import wait
from slave import Slave, bring_to_rest
from test_tool import LEVELWIND, ROOT, environment

# Where brackets would be markup, they are a name.
BRACKETS = "[bold]brackets[/bold] [/no]"


COMMANDS = sorted(leaves(typer.main.get_command(app)))
ARGUMENTS = {
    "identify": "",
    "status": "",
    "watch": "--csv {out}.csv --seconds 0.3",
    "log": "--last 3",
    "index": "",
    "reacquire": "",
    "stop": "",
    "clear-fault": "",
    "acknowledge": "",
    "set-rope": "950",
    "mode": "centre",
    "jog": "plus --for 0.2",
    "trim": "",
    "get": "",
    "set": "pitch_um=12000",
    "diff": "",
    "apply": "",
    "revert": "",
    "save": "",
    "factory": "motion",
    "unlock": "1",
    "lock": "",
    "line": "--new-unit 1",
    "backup": "{out}.yaml",
    "restore": "{backup}",
    "run": "{script}",
    "map": "",
    "plan": "--pitch-mm 12",
    "lay": "--rope-mm 5 --patterns 30 --plot {out}.png",
    "rope": "--fit 0/650 --turns 250 --set rope_diameter_um=5000 "
    "--set drum_core_diameter_um=764000",
    "replay": "--drum 9 --cam {table}",
    "sim": "--port {out}",
    "launch": "{profile}",
    "demo": "--speed max --out {out}",
    "conformance": "--read-only --case FC04",
    "cam check": "{table}",
    "cam plot": "{table} {out}.png",
    "cam from-levelwind": "{out}.csv",
    "cam upload": "{table}",
    "cam activate": "{table}",
    "cam discard": "",
    "cam download": "{out}.csv",
    "serve": "--simulator --listen 127.0.0.1:0",
    "commission": "--resume {commissioning} --answers {stop}",
    "report verify": "{report}",
    "report write": "{commissioning}",
    "launches list": "--record {record}",
    "launches show": "1 --record {record} --plot {out}.png",
    "launches export": "1 --record {record}",
}
# They run until Ctrl-C, and say when they are up.
SERVERS = {"sim": "ready {}/out", "serve": "ready http://127.0.0.1:"}
FIRST = {
    "acknowledge": "index",
    "diff": "set pitch_um=12500",
    "launch": "index",
    "set-rope": "run {described}",
    "cam discard": "cam upload {table}",
    "cam download": "cam activate {table}",
}
# There is no code; the drum rests; somebody stops it; nobody has accepted it.
FAILS = {"lock", "reacquire", "commission", "report verify"}
SILENT = {"lock", "reacquire", "report verify"}  # on standard output
# What they print is the same in every run, digits included.
STEADY = {
    *("identify", "get", "map", "plan", "lay", "rope", "diff", "cam check", "replay", "trim"),
    *("launches list", "launches show", "launches export"),
}


def test_no_command_is_forgotten() -> None:
    assert set(ARGUMENTS) == set(COMMANDS)


def record_a_launch(record: Path) -> None:
    """As `levelwind serve` does, of its own simulator."""
    server = subprocess.Popen(
        [*LEVELWIND, "serve", *ARGUMENTS["serve"].split(), "--speed", "10", "--record", record],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert server.stdout.readline().startswith("ready ")
        wait(lambda: any(one["ended"] for one in Launches(record).list()), 60)
    finally:
        server.send_signal(signal.SIGINT)
        server.wait()


def begin_commissioning(folder: Path, port: str) -> dict[str, str]:
    """The first step, its report, and answers that stop before the second one."""
    stop = folder / "stop.yaml"
    stop.write_text(
        "levelwind_answers: 1\nanswers: {identify.from_factory: n, contacts.begin: s}\n"
    )
    done = subprocess.run(
        [*LEVELWIND, "commission", "--report", folder / "report", "--answers", stop],
        env=environment(port), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "The carriage stands." in done.stdout, done.stdout + done.stderr
    kept = folder / "report" / "commissioning.json"
    subprocess.run([*LEVELWIND, "report", "write", kept], env=environment(port), check=True)
    report = folder / "report" / "report.json"
    return {"stop": str(stop), "commissioning": str(kept), "report": str(report)}


@pytest.fixture(scope="module")
def files(port: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What the commands read."""
    folder = tmp_path_factory.mktemp(BRACKETS.replace("/", "_"))
    table = folder / f"{BRACKETS.replace('/', '_')}.csv"
    table.write_text("0;0\n1000;100\n2000;0\n")
    profile = folder / "profile.csv"
    profile.write_text("time_s,drum_rpm\n0,0\n0.5,10\n1,0\n")
    script = folder / "script.yaml"
    script.write_text(f"- note: '{BRACKETS}'\n- stop\n")
    described = folder / "described.yaml"
    described.write_text(
        "- set: {rope_diameter_um: 5000, drum_core_diameter_um: 380000, "
        "rope_packing_permille: 750}\n- apply\n"
    )
    backup = folder / "backup.yaml"
    subprocess.run([*LEVELWIND, "backup", backup], env=environment(port), check=True)
    record = folder / "launches.sqlite"
    record_a_launch(record)
    return {
        "table": str(table),
        "profile": str(profile),
        "script": str(script),
        "described": str(described),
        "backup": str(backup),
        "record": str(record),
        **begin_commissioning(folder, port),
    }


def settings(port: str, **changes: str) -> dict[str, str]:
    kept = {k: v for k, v in environment(port).items() if k not in ("COLUMNS", "PYTHONUNBUFFERED")}
    return kept | changes


class Line:
    """A command with its arguments."""

    def __init__(self, command: str, port: str, names: dict[str, str]) -> None:
        self.port = port
        self.names = names
        self.first = self.given(FIRST[command]) if command in FIRST else None
        self.arguments = [*LEVELWIND, *command.split(), *self.given(ARGUMENTS[command])]

    def given(self, text: str) -> list[str]:
        return [part.format(**self.names) for part in text.split()]

    def prepare(self) -> list[str]:
        """The command line, on a slave that was told what must come before."""
        if self.first:
            line = [*LEVELWIND, *self.first]
            done = subprocess.run(line, env=settings(self.port), capture_output=True, check=False)
            assert done.returncode == 0, done.stderr
        return self.arguments


@pytest.fixture
def line(request: pytest.FixtureRequest, port: str, files: dict[str, str], tmp_path: Path) -> Line:
    command = request.node.callspec.params["command"]
    rest = Slave(port)
    bring_to_rest(rest)
    rest.close()
    return Line(command, port, {**files, "out": str(tmp_path / "out")})


@pytest.mark.parametrize("command", [c for c in COMMANDS if c not in SERVERS])
def test_what_a_pipe_gets_is_on_every_terminal_whole(command: str, line: Line, port: str) -> None:
    piped = subprocess.run(
        line.prepare(), env=settings(port), cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert piped.returncode == (1 if command in FAILS else 0), piped.stdout + piped.stderr
    assert "Traceback" not in piped.stderr
    digits = command in STEADY
    said = words(piped.stdout + piped.stderr, digits=digits)
    for columns, changes in TERMINALS.values():
        env = settings(port, **changes)
        status, shown = on_a_terminal(line.prepare(), columns, env)
        assert "Traceback" not in shown
        assert status == piped.returncode, shown
        missing = said - words(shown, digits=digits)
        assert not missing, f"{sorted(missing)} in\n{shown}"


@pytest.mark.parametrize("command", COMMANDS)
def test_a_full_disk_is_one_line(command: str, line: Line, port: str) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            line.prepare(), env=settings(port), cwd=ROOT, stdout=full, stderr=subprocess.PIPE,
            text=True, timeout=60, check=False,
        )  # fmt: skip
    assert "Traceback" not in done.stderr
    assert done.returncode == 1
    said = done.stderr.splitlines()
    if command not in SILENT:
        assert "cannot be written: No space left on device" in said[-1]
    assert all(text.startswith(("levelwind: ", "lw_sim: ", "- ")) for text in said), said


@pytest.mark.parametrize("command", SERVERS)
def test_a_server_on_a_terminal(command: str, line: Line, port: str, tmp_path: Path) -> None:
    for columns, changes in TERMINALS.values():
        env = settings(port, **changes)
        status, shown = on_a_terminal(line.arguments, columns, env, ctrl_c_at=b"ready")
        assert status == 0
        assert SERVERS[command].format(tmp_path) in shown
