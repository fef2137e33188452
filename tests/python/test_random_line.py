# SPDX-License-Identifier: Apache-2.0
"""Every command of the tool over a line that echoes, glitches, cuts and loses at random.

After each command the machine behind the line is asked what is really so, and the tool is judged
by it: it ends in time, sends nothing twice that is no reading, and says neither that something was
done that was not, nor that something was not done that was. LEVELWIND_LINE_REQUESTS says how many
requests go over the line.
"""

import json
import os
import random
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from levelwind.conformance.line import sealed
from levelwind.line.points import PARAMETERS
from levelwind.map_table import POINTS, CamBankState, Mode, State
from python.dirty_line import DirtyLine, RandomLine, Sent, connect, levelwind
from world import World

REQUESTS = int(os.environ.get("LEVELWIND_LINE_REQUESTS", "900"))
SEEDS = 3
LOST_S = 1.7
"""A request without an answer: the time-out, the time of the frames, and a late answer's."""
ANSWERED_S = 1.0
SETS = ("", "active.", "stored.")
OWNED_UP = re.compile(
    "may have been done|Before that was done|It was done|refused|failed|"
    "Reverted: nothing is staged|was not in order|"
    "1/3 set pitch_um"  # the last: a script's step that was done
)
RELEASE = sealed(bytes([1, 16, 0, POINTS["jog"].address, 0, 1, 2, 0, 0]))
"""Of the jog: sent however it ends."""
PROFILE = "time_s,edges_per_s\n0,0\n0.5,2000\n1,0\n"
TABLES = ("0 0\n1440 3000\n2880 0\n", "0 0\n1000 1000\n5000 -2000\n8000 0\n")


def snapshot(world: World) -> dict[str, int]:
    """What can be written, and what is in force."""
    names = [f"{copy}{point.name}" for copy in SETS for point in PARAMETERS]
    names += ["mode", "trim_plus_um", "trim_minus_um", "cam_bank_0_state", "cam_bank_1_state"]
    return world.read(*names)


def parameters(values: dict[str, int], copy: str) -> dict[str, int]:
    return {point.name: values[f"{copy}{point.name}"] for point in PARAMETERS}


def sent_again(sent: list[Sent]) -> list[str]:
    """What is no reading, had no answer, and was sent once more."""
    lost: set[bytes] = set()
    again = []
    for request in sent:
        if request.frame in lost:
            again.append(request.frame.hex(" "))
        if not request.reading and not request.delivered:
            lost.add(request.frame)
    return again


@dataclass
class Move:
    """A command of the tool, how long it may take on a good line, and what its success means."""

    arguments: list[str]
    own_s: float = 5.0
    done: Callable[[dict[str, int], dict[str, int], str], bool] = lambda before, after, said: True


class Player:
    """Chooses commands by the numbers of a seed, and judges each."""

    def __init__(self, line: DirtyLine, folder: Path, seed: int) -> None:
        self.line = line
        self.random = random.Random(seed)
        self.folder = folder
        self.commands: Counter[str] = Counter()
        self.outcomes: Counter[str] = Counter()
        self.requests = 0
        (folder / "profile.csv").write_text(PROFILE)
        for number, table in enumerate(TABLES):
            (folder / f"table{number}.txt").write_text(table)
        script = [{"set": {"pitch_um": 11_500}}, "apply", {"wait": {"until": {"staged": 0}}}]
        (folder / "script.yaml").write_text(yaml.safe_dump(script))

    def choose(self) -> Move:
        world, folder = self.line.world, self.folder
        pitch = self.random.randint(9_000, 13_000)
        pulses = self.random.choice([360, 500, 512])
        side = self.random.choice(["plus", "minus"])
        mode = self.random.choice(["track", "centre", "off"])
        trim = self.random.randint(-300, 300)
        scope = self.random.choice(["motion", "line", "all"])
        table = str(folder / f"table{self.random.randrange(len(TABLES))}.txt")
        backup, copy = folder / "backup.yaml", folder / "copy.txt"

        def value(name: str, wanted: int) -> Callable[..., bool]:
            return lambda before, after, said: after[name] == wanted

        def stays(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            return before == after

        def same(left: str, right: str) -> Callable[..., bool]:
            return lambda before, after, said: parameters(after, left) == parameters(after, right)

        def read_right(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            shown = json.loads(said)["pitch_um"]
            return before == after and all(
                shown[name] == after[f"{copy}pitch_um"]
                for name, copy in (("staged", ""), ("active", "active."), ("stored", "stored."))
            )

        def log_right(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            numbers = [event["sequence"] for event in json.loads(said)["events"]]
            return numbers == list(range(numbers[0], numbers[-1] + 1))

        def backed_up(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            kept = yaml.safe_load(backup.read_text())["parameters"]["pitch_um"]
            return kept == after["active.pitch_um"]

        def restored(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            kept = yaml.safe_load(backup.read_text())["parameters"]["pitch_um"]
            return kept == after["active.pitch_um"] == after["pitch_um"]

        def downloaded(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            rows = [row.split() for row in copy.read_text().splitlines()]
            rows = [row for row in rows if row and row[0].lstrip("-").isdigit()]
            return rows in [[row.split() for row in text.splitlines()] for text in TABLES]

        def uploaded(before: dict[str, int], after: dict[str, int], said: str) -> bool:
            return CamBankState.READY in (after["cam_bank_0_state"], after["cam_bank_1_state"])

        moves = [
            Move(["identify"], done=stays),
            Move(["status"], done=stays),
            Move(["status", "--json"], done=lambda b, a, said: bool(json.loads(said)["state"])),
            Move(["get", "pitch_um", "--json"], done=read_right),
            Move(["diff"], done=stays),
            Move(["log", "--json"], done=log_right),
            Move(["set", f"pitch_um={pitch}"], done=value("pitch_um", pitch)),
            Move(
                [
                    "set",
                    f"encoder_pulses_per_rev={pulses}",
                    f"pitch_um={pitch}",
                    f"index_switch={side}",
                ],
                done=lambda b, a, said: (
                    (a["encoder_pulses_per_rev"], a["pitch_um"]) == (pulses, pitch)
                ),
            ),
            Move(["apply"], done=same("", "active.")),
            Move(["revert"], done=same("", "active.")),
            Move(["save"], done=same("active.", "stored.")),
            Move(["factory", scope]),
            Move(["trim", "--plus-um", str(trim)], done=value("trim_plus_um", trim)),
            Move(["mode", mode], done=value("mode", Mode[mode.upper()])),
            Move(["stop"], done=lambda b, a, said: world.state != State.TRACKING),
            Move(["clear-fault"]),
            Move(["index"], 60.0, done=lambda b, a, said: "indexed" in world.flags),
            Move(["jog", side, "--for", "0.2"], 8.0),
            Move(["backup", str(backup)], done=backed_up),
            Move(["cam", "upload", table], done=uploaded),
            Move(["cam", "activate"]),
            Move(["cam", "discard"]),
            Move(["cam", "download", str(copy)], done=downloaded),
            Move(["watch", "--seconds", "0.3", "--csv", str(folder / "watch.csv")], done=stays),
            Move(["run", str(folder / "script.yaml")], 40.0, done=value("active.pitch_um", 11_500)),
            Move(["launch", str(folder / "profile.csv"), "--json"], 45.0),
        ]
        if backup.exists():
            moves.append(Move(["restore", str(backup)], done=restored))
            moves.append(Move(["restore", str(backup), "--save"], done=same("active.", "stored.")))
        return self.random.choice(moves)

    def play(self, move: Move) -> None:
        line = self.line
        line.sent.clear()
        line.settle()
        before = snapshot(line.world)
        began_s = line.now_s
        result = levelwind(*move.arguments)
        took_s = line.now_s - began_s
        line.settle()
        after = snapshot(line.world)
        self.requests += len(line.sent)
        self.commands[
            " ".join(move.arguments[:2]) if move.arguments[0] == "cam" else move.arguments[0]
        ] += 1
        told = result.stdout + result.stderr
        case = f"{' '.join(move.arguments)}: exit {result.exit_code} after {took_s:.1f} s\n{told}"
        assert result.exit_code in (0, 1), (case, result.exception)
        assert isinstance(result.exception, SystemExit | None), (case, result.exception)
        # In time.
        lost = [sent for sent in line.sent if not sent.delivered]
        assert took_s <= move.own_s + LOST_S * len(lost) + ANSWERED_S * len(line.sent), case
        # Nothing twice.
        again = sent_again(line.sent)
        assert not again, f"{case}\nsent again: {again}"
        # What it says is so.
        if result.exit_code == 0:
            self.outcomes["done"] += 1
            assert move.done(before, after, result.stdout), f"{case}\nit is not so"
            return
        self.outcomes[
            next(
                (text for text in ("may have been", "Put back", "refused") if text in told),
                "failed",
            )
        ] += 1
        if "Put back" in told:
            assert parameters(after, "active.") == parameters(before, "active."), case
            assert parameters(after, "") == parameters(after, "active."), case
        else:
            acts = [sent.frame.hex(" ") for sent in line.executed() if sent.frame != RELEASE]
            assert not acts or OWNED_UP.search(told), f"{case}\nbut done: {acts}"


@pytest.mark.parametrize("seed", range(SEEDS))
def test_no_command_says_what_is_not_so_on_a_line_that_fails_at_random(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, seed: int
):
    line = connect(monkeypatch)
    line.carry = RandomLine(seed)
    player = Player(line, tmp_path, seed)
    while player.requests < REQUESTS / SEEDS:
        player.play(player.choose())
    print(f"{player.requests} requests; {dict(player.outcomes)}; {dict(player.commands)}")
    assert player.outcomes["done"] > 0
    assert player.outcomes["may have been"] > 0
