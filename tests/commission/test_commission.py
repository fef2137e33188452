# SPDX-License-Identifier: Apache-2.0
"""A winch is commissioned from factory values by answers alone; what is wrong in it is named in the
right step; whatever ends the tool, the carriage stands, and the work goes on."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from levelwind.commission import repeat, report, session, verify
from levelwind.commission.bench import Index, WrongError
from levelwind.commission.guide import STEPS
from levelwind.errors import ToolError
from levelwind.map_table import Command, SwitchFault
from machines import some
from winch import KilledError, Winch, ended_with
from world import PlantFault, World

NAMES = [step.name for step in STEPS]
END_STOP_UM = 90_000
LAUNCH_EDGES_PER_S = 34_000


@pytest.fixture
def winch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Winch:
    started = Winch(World(), tmp_path, monkeypatch)
    started.session.save()
    return started


def test_from_factory_values_to_a_launch_without_a_typed_register(winch: Winch) -> None:
    held = winch.go_on()
    world = winch.world
    assert all(held.results[name].done for name in NAMES)
    values = held.active
    again_mm = held.results["geometry"].measured["indexed again, the other switch off by, mm"]
    assert again_mm == pytest.approx(0, abs=0.06)
    assert values["switch_plus_um"] == pytest.approx(78_400, abs=200)
    assert values["switch_minus_um"] == pytest.approx(-78_400, abs=200)
    assert values["microsteps_per_rev"] == 2000
    assert values["switch_delay_us"] == pytest.approx(1500, rel=0.1)
    assert "not_accepted" not in world.flags
    assert "dirty" not in world.flags
    assert world.permit

    top_um, slips = 0.0, world.truth.pole_slips  # those of the pull-out
    world.drum(LAUNCH_EDGES_PER_S)
    for _ in range(2000):
        world.run(0.01)
        top_um = max(top_um, abs(world.truth.carriage_um))
    world.stop_drum()
    assert "los" not in world.flags
    assert world.truth.pole_slips == slips
    assert values["reversal_plus_um"] < top_um < values["flange_plus_um"]


def test_the_report_names_who_has_accepted_what_and_binds(winch: Winch) -> None:
    held = winch.go_on()
    paths = report.write(held, winch.folder)
    document, page, pdf = (path.read_bytes() for path in paths)
    assert pdf.startswith(b"%PDF-")
    assert b"ACCEPTED by A. Builder" in page
    assert all(step.title.encode() in page for step in STEPS)
    assert json.loads(document)["accepted_crc"] == held.accepted_crc
    for path in paths:
        assert verify.differences(verify.load(path), winch.device) == []

    changed = json.loads(document)
    changed["parameters"]["pitch_um"] += 1
    assert any("it was changed" in d for d in verify.differences(changed, winch.device))
    unsigned = json.loads(document) | {"accepted_crc": 0}
    assert "never signed" in verify.differences(unsigned, winch.device)[0]
    winch.world.command(Command.STOP)
    winch.world.apply(pitch_um=held.active["pitch_um"] + 100)
    found = verify.differences(json.loads(document), winch.device)
    assert [d.split(":")[0] for d in found] == ["pitch_um"]
    assert "not_accepted" in winch.world.flags


def test_what_was_left_out_stands_in_the_report(winch: Winch) -> None:
    winch.answers |= {"pull_out.begin": "l", "line.begin": "l"}
    held = winch.go_on()
    _, page, _ = report.write(held, winch.folder)
    assert "NOT MEASURED: Pull-out, Line." in page.read_text()


def test_a_commissioning_that_was_not_accepted_says_so(winch: Winch) -> None:
    winch.answers |= {"accept": "n"}
    with pytest.raises(ToolError, match="Not accepted"):
        winch.go_on()
    assert "not_accepted" in winch.world.flags
    _, page, _ = report.write(winch.session, winch.folder)
    assert "must not launch" in page.read_text()


# ---- wrong machines ----------------------------------------------------------------------------


def bench(**values: int) -> Callable[[Winch], None]:
    """Broken from the beginning."""
    return lambda winch: winch.world.write(**values)


def answers(**given: object) -> Callable[[Winch], None]:
    """The person sees or says something else; __ stands for a point."""
    return lambda winch: winch.answers.update({n.replace("__", "."): a for n, a in given.items()})


def at(step: str, *faults: tuple[PlantFault, int]) -> Callable[[Winch], None]:
    """Breaks when a step begins."""

    def break_it(winch: Winch) -> None:
        path = winch.session.path

        def watch(_: bytes) -> None:
            done = session.load(path).results if path.exists() else {}
            if NAMES.index(step) <= len(done):
                winch.client.watch = lambda _: None
                for fault, argument in faults:
                    winch.world.inject(fault, argument)

        winch.client.watch = watch

    return break_it


def each_index(fault: PlantFault, *usteps: int) -> Callable[[Winch], None]:
    """While it is repeated, the carriage is moved against its motor before every indexing."""

    def break_it(winch: Winch) -> None:
        path, count = winch.session.path, 0

        def watch(pdu: bytes) -> None:
            nonlocal count
            index = bytes([16, 0, 0, 0, 1, 2, 0, Command.INDEX])
            if pdu == index and path.exists() and len(session.load(path).results) == 5:
                count += 1
                if count > 1:
                    winch.world.inject(fault, usteps[count % len(usteps)])

        winch.client.watch = watch

    return break_it


STUCK = int(SwitchFault.STUCK_ACTUATED)
DEAD = int(SwitchFault.STUCK_RELEASED)
NO, NC, SHORT = (int(f) for f in (SwitchFault.NO_WIRE_BROKEN, SwitchFault.NC_WIRE_BROKEN,
                                  SwitchFault.SHORTED))  # fmt: skip

WRONG: dict[str, tuple[Callable[[Winch], None], str, str]] = {
    "plus NC wire broken": (bench(bench_switch_plus_fault=NC), "contacts", "plus_at_rest"),
    "minus NC wire broken": (bench(bench_switch_minus_fault=NC), "contacts", "minus_at_rest"),
    "plus NO wire broken": (bench(bench_switch_plus_fault=NO), "contacts", "plus_pressed"),
    "minus NO wire broken": (bench(bench_switch_minus_fault=NO), "contacts", "minus_pressed"),
    "plus shorted": (bench(bench_switch_plus_fault=SHORT), "contacts", "plus_at_rest"),
    "plus stuck": (bench(bench_switch_plus_fault=STUCK), "contacts", "plus_actuated_at_rest"),
    "minus dead": (bench(bench_switch_minus_fault=DEAD), "contacts", "minus_dead"),
    "overtravel stuck": (bench(bench_overtravel_minus=1), "contacts", "overtravel_minus_stuck"),
    "overtravel dead": (
        answers(contacts__overtravel_plus__press={"place_mm": 85}), "contacts",
        "overtravel_plus_dead",
    ),
    "minus pressed for plus": (
        answers(contacts__plus__press={"place_mm": -79.4}), "contacts", "swapped",
    ),
    "channel A dead": (bench(bench_encoder_a_fault=1), "encoder", "channel"),
    "channel B dead": (bench(bench_encoder_b_fault=2), "encoder", "channel"),
    "channel A loose": (bench(bench_encoder_a_fault=3), "encoder", "channel"),
    "no encoder": (
        bench(bench_encoder_a_fault=1, bench_encoder_b_fault=1), "encoder", "channel",
    ),
    "illegal transitions": (
        answers(encoder__forward={"turn": 1, "bench": {
            "bench_argument": 30, "bench_command": "illegal_transitions"}}),
        "encoder", "illegal",
    ),
    "lost pulses": (
        answers(encoder__back={"turn": -1, "bench": {
            "bench_argument": 60, "bench_command": "lose_pulses"}}),
        "encoder", "lost",
    ),
    "another nameplate": (answers(encoder__pulses=400), "encoder", "pulses"),
    "half the pulses": (answers(encoder__pulses=180), "encoder", "pulses"),
    "another ratio": (answers(encoder__ratio=5), "encoder", "ratio"),
    "motor without current": (at("stepper", (PlantFault.STALL_MS, -1)), "stepper", "still"),
    "other microsteps told": (answers(stepper__microsteps=1600), "stepper", "microsteps"),
    "other lead told": (answers(stepper__lead_mm=13), "stepper", "unusual"),
    "carriage blocked": (at("geometry", (PlantFault.STALL_MS, -1)), "geometry", "no_switch"),
    "plus switch dead later": (
        at("geometry", (PlantFault.LIMIT_PLUS, DEAD)), "geometry", "overtravel",
    ),
    "no room": (answers(geometry__room_plus_mm=0.02), "geometry", "set"),
    "coupling slips": (each_index(PlantFault.SLIP_USTEPS, -40), "repeat", "coupling"),
    "carriage jumps": (each_index(PlantFault.SLIP_USTEPS, -40, 40), "repeat", "coupling"),
    "weak for such a rope": (answers(geometry__rope_m_per_s=60), "pull_out", "weak"),
    "rope heaps up": (answers(rope__ends="n"), "rope", "rope.ends"),
}  # fmt: skip


@pytest.mark.parametrize("name", some(list(WRONG), 3))
def test_what_is_wrong_is_named_in_its_step(winch: Winch, name: str) -> None:
    break_it, step, code = WRONG[name]
    world, reached_um = winch.world, [0.0]
    winch.client.after = lambda: reached_um.append(abs(world.truth.carriage_um))
    break_it(winch)
    assert ended_with(winch) == (step, code if "." in code else f"{step}.{code}")
    world.run(3.0)
    assert "moving" not in world.flags
    assert max(reached_um) < END_STOP_UM - 500
    assert "not_accepted" in world.flags


def test_noise_on_the_line_is_named(winch: Winch) -> None:
    def watch(_: bytes) -> None:
        nonlocal count
        count += 1
        if count % 40 == 0 and len(session.load(winch.session.path).results) == 7:
            winch.world.line(bytes([1, 4, 0, 100, 0, 8, 0xAA, 0x55]), 0.02)  # a CRC that is wrong

    count = 0
    winch.client.watch = watch
    assert ended_with(winch) == ("line", "line.noise")


def indexings(plus_um: Sequence[float], minus_um: Sequence[float]) -> list[Index]:
    """What the controller tells where its switches are at these places: 10 um a step."""
    frames = zip([0.0, *plus_um], plus_um, minus_um, strict=False)
    return [Index(3000 + round((plus - last) / 10), round(minus - plus))
            for last, plus, minus in frames]  # fmt: skip


STILL = [0.0] * 10
WANDERS = [100.0 * i for i in range(10)]
LOOSE = [0, 300, -200, 250, -300, 100, -100, 280, -260, 40.0]


@pytest.mark.parametrize(
    ("plus_um", "minus_um", "code"),
    [
        (STILL, STILL, None),
        (WANDERS, STILL, "repeat.plus_drift"),
        (STILL, WANDERS, "repeat.minus_drift"),
        (WANDERS, WANDERS, "repeat.coupling"),
        (LOOSE, STILL, "repeat.plus_loose"),
        (STILL, LOOSE, "repeat.minus_loose"),
        (LOOSE, LOOSE, "repeat.coupling"),
    ],
)
@pytest.mark.parametrize("known", [2998, 3000, 3002])  # the steps of a traverse: to a few
def test_what_is_loose_is_told_apart(
    plus_um: list[float], minus_um: list[float], code: str | None, known: int
) -> None:
    found = repeat.places(indexings(plus_um, minus_um), known, 10.0)
    sides = {"plus": found.index, "minus": found.other}
    if code is None:
        repeat.judge(sides)
        return
    with pytest.raises(WrongError) as wrong:
        repeat.judge(sides)
    assert wrong.value.finding.code == code


def test_a_repeated_step_goes_on_once_it_is_mended(winch: Winch) -> None:
    winch.world.write(bench_switch_plus_fault=NC)
    winch.answers |= {
        "contacts.again": {"answer": "r", "bench": {"bench_switch_plus_fault": "none"}},
        "encoder.begin": "s",
    }
    with pytest.raises(ToolError, match="Stopped"):
        winch.go_on()
    assert winch.session.results["contacts"].done


# ---- killed ------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", some(NAMES[::-1], 3))
def test_killed_in_any_step_the_carriage_stands_and_it_goes_on(
    winch: Winch, step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing that the tool does at its end arrives: as by kill -9, or a closed laptop."""
    path, world = winch.session.path, winch.world
    requests, most = 0, 5 if step == "identify" else 60

    def watch(_: bytes) -> None:
        nonlocal requests
        done = session.load(path).results if path.exists() else {}
        if len(done) == NAMES.index(step) and requests >= 0:
            requests += 1
        moving = requests > 5 and "moving" in world.flags
        if moving or requests > most or requests < 0:
            requests = -1
            raise KilledError

    winch.client.watch = watch
    with pytest.raises(KilledError):
        winch.go_on()
    world.run(40.0)  # an indexing that runs goes to its own end
    at_um = world.truth.carriage_um
    world.run(2.0)
    assert "moving" not in world.flags
    assert world.truth.carriage_um == pytest.approx(at_um, abs=1)
    assert abs(at_um) < END_STOP_UM - 1000

    again = Winch(world, tmp_path, monkeypatch)
    again.session = session.load(path)
    assert len(again.session.results) == NAMES.index(step)
    assert again.go_on().accepted_by == "A. Builder"
    assert "not_accepted" not in world.flags


@pytest.mark.parametrize("step", ["stepper", "rope"])
def test_ctrl_c_stops_the_carriage_at_once(winch: Winch, step: str) -> None:
    world, path = winch.world, winch.session.path

    def watch(_: bytes) -> None:
        if len(session.load(path).results) == NAMES.index(step) and "moving" in world.flags:
            winch.client.watch = lambda _: None
            raise KeyboardInterrupt

    winch.client.watch = watch
    with pytest.raises(KeyboardInterrupt):
        winch.go_on()
    world.run(0.4)  # the ramp; a jog by itself would go on for half a second, an indexing for ten
    assert "moving" not in world.flags


def test_the_controller_forgets_and_what_was_found_is_put_back(winch: Winch) -> None:
    winch.answers |= {"repeat.begin": "s"}
    with pytest.raises(ToolError, match="Stopped"):
        winch.go_on()
    found = winch.session.active
    winch.world.write(bench_command=4)  # power_cut: nothing was saved
    winch.world.run(1.0)
    assert winch.world.value("active.pitch_um") != found["pitch_um"]
    winch.answers |= {"pull_out.begin": "l", "line.begin": "l", "repeat.begin": "g"}
    assert winch.go_on().active["pitch_um"] == found["pitch_um"]


# ---- files -------------------------------------------------------------------------------------


def test_files_that_are_none_are_named(tmp_path: Path, winch: Winch) -> None:
    torn = tmp_path / "torn.json"
    torn.write_text('{"levelwind_commissioning": 1')
    with pytest.raises(ToolError, match=r"torn\.json: no JSON"):
        session.load(torn)
    torn.write_text('{"levelwind_commissioning": 1, "results": {"a": 1}}')
    with pytest.raises(ToolError, match="incomplete"):
        session.load(torn)
    torn.write_text("{}")
    with pytest.raises(ToolError, match="is no commissioning"):
        session.load(torn)
    with pytest.raises(ToolError, match="is no report"):
        verify.load(torn)
    winch.answers |= {"contacts.wiring": "both"}
    with pytest.raises(ToolError, match=r"contacts\.wiring: both: give one of pair, no, nc"):
        winch.go_on()
    winch.answers |= {"contacts.wiring": "pair", "contacts.middle": {"push_mm": 0}}
    with pytest.raises(ToolError, match="push_mm is none of bench, place_mm"):
        winch.go_on()
