# SPDX-License-Identifier: Apache-2.0
"""The commissioning as a page: who may lead it, that it is the command's, that leaving it stops."""

import time
import urllib.error
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.cli import app
from levelwind.commission import guide, session
from levelwind.commission.dialogue import STATE
from levelwind.commission.session import Finding, Result, Session
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.map_table import BenchCommand, Flag, SwitchContacts, SwitchFault
from levelwind.serve.guard import PinFile
from playwright.sync_api import Page, expect
from served import PIN, Served, wait
from typer.testing import CliRunner

Start = Callable[..., Served]
Open = Callable[..., Page]
Shot = Callable[[Page, str], None]
NAMES = [step.name for step in guide.STEPS]
STANDS_S = 1.5
STILL_S = 0.3
AWAITED_S = 5.0
FINDING = Finding("x.known", "The <b>screw</b> is long.", "Nothing.", wrong=False)


@pytest.fixture
def served(start: Start, tmp_path: Path) -> Served:
    folder = tmp_path / "winch"
    folder.mkdir()
    return start("--allow-commands", "--commission", str(folder), speed="3")


def done_until(folder: Path, step: str) -> None:
    """A commissioning whose steps before this one are done."""
    before = NAMES[: NAMES.index(step)]
    results = {
        name: Result(done=True, at="2026-01-01 10:00:00", told={"Lead, mm": "20"},
                     measured={"way, mm": 12.5}, findings=[FINDING])
        for name in before
    }  # fmt: skip
    Session(folder / STATE, results=results, begun=session.now()).save()


def lead(open_page: Open, served: Served, width: int = 1280) -> Page:
    """The page, with the PIN given."""
    page = open_page(served, width)
    page.goto(served.url + "commission")
    open_commands(page)
    return page


def open_commands(page: Page) -> None:
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    expect(page.locator("#begin")).to_be_enabled()


def shows(page: Page, place: str, text: str) -> None:
    """It is there to be read; looked for at every frame."""
    page.wait_for_function(
        """([place, text]) => [...document.querySelectorAll(place)]
        .some((at) => !at.closest("[hidden]") && at.textContent.includes(text))""",
        arg=[place, text],
        timeout=8000,
    )


def press(page: Page, choice: str, asked: str) -> None:
    """A key of the question that is asked; it must be this one."""
    shows(page, "#question-text", asked)
    page.click(f"[data-choice={choice}]")


def push(device: Device, place_mm: float) -> None:
    """The machine's hand on the carriage."""
    device.write({"bench_argument": round(1000 * place_mm)})
    device.write({"bench_command": BenchCommand.PLACE_CARRIAGE})


def is_moving(device: Device) -> bool:
    return flag(read_live(device), Flag.MOVING)


def test_the_pin_one_leader_and_typed_values(
    served: Served, open_page: Open, shot: Shot, tmp_path: Path
) -> None:
    page = open_page(served)
    page.click("#commissioning a")
    expect(page.locator("#begin")).to_be_disabled()
    page.evaluate("tell({ begin: true })")
    shows(page, "#answer", "Give the PIN first.")
    page.evaluate("ask('/api/act', { name: 'stop' }).then((said) => set('answer', said.text))")
    shows(page, "#answer", "Give the PIN first.")
    open_commands(page)
    page.click("#begin")
    shows(page, "#step-title", "1 of 9  Identity")
    looker = lead_too(page, served)
    looker.evaluate("tell({ begin: true })")
    shows(looker, "#answer", "under way already")
    looker.evaluate("tell({ number: 1, answer: 'g' })")
    looker.goto(served.url)
    shows(looker, "#commissioning", "Commissioning is under way")
    looker.click("[data-act=index]")
    shows(looker, "#answer", "only Stop carriage and trims")
    shows(page, "#question-text", "Begin this step?")
    looker.click("[data-act=stop]")
    looker.close()  # a page behind another one is drawn once a second
    shows(page, "#ended", "Stop carriage was pressed.")
    done_until(tmp_path / "winch", "stepper")
    page.set_viewport_size({"width": 360, "height": 760})
    page.reload()
    shows(page, "#begin", "Go on with step 4")
    page.click("#begin")
    shows(page, "#step-moves", "The key Stop carriage stops it.")
    press(page, "g", "Begin this step?")
    shows(page, "#question-text", "the screw's lead")
    expect(page.locator("#field")).to_have_value("20")
    for bad in ("far", "nan"):
        page.fill("#field", bad)
        page.press("#field", "Enter")
        shows(page, "#answer", f"{bad} is no number.")
    page.fill("#field", "10,5")
    page.click("#take")
    shows(page, "#question-text", "Microsteps")
    shows(page, "#said", "10.5")
    page.click("#steps summary >> nth=0")
    assert "<b>screw</b>" in page.locator("#steps").inner_text()
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    expect(page.locator("#stop")).to_be_in_viewport()
    page.evaluate("scrollTo(0, 0)")
    shot(page, "commission_360")
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    page.set_viewport_size({"width": 1280, "height": 900})
    shot(page, "commission_1280")


def lead_too(page: Page, served: Served) -> Page:
    """Another page of the same browser: it has the session, and does not lead."""
    other = page.context.new_page()
    other.goto(served.url + "commission")
    shows(other, "#waiting", "Another page leads")
    return other


def test_two_steps_by_hand(served: Served, open_page: Open, shot: Shot, tmp_path: Path) -> None:
    page = lead(open_page, served)
    page.click("#begin")
    with served.device() as device:
        device.write({"bench_switch_minus_fault": int(SwitchFault.NC_WIRE_BROKEN)})
        shows(page, "#step-moves", "What will move: Nothing.")
        press(page, "g", "Begin this step?")
        press(page, "y", "factory values")
        shows(page, "#step-title", "2 of 9  Switches")
        press(page, "g", "Begin this step?")
        press(page, "pair", "How is a limit switch wired")
        press(page, "done", "to the middle by hand")
        shows(page, "#step-findings", "The minus limit switch, released, shows neither contact")
        shows(page, "#step-findings", "What to do: The wire of its NC")
        shot(page, "commission_wrong_1280")
        device.write({"bench_switch_minus_fault": 0})
        press(page, "r", "Mended?")
        press(page, "g", "Begin this step?")
        press(page, "pair", "How is a limit switch wired")
        press(page, "done", "to the middle by hand")
        for side, place_mm in (("PLUS", 79.4), ("MINUS", -79.4)):
            shows(page, "#request", f"Press the {side} limit switch")
            push(device, place_mm)
            shows(page, "#request", "Let go of it.")
            push(device, 0)
        press(page, "n", "overtravel switches?")
        press(page, "done", "to the middle again")
    shows(page, "#step-title", "3 of 9  Encoder")
    held = session.load(tmp_path / "winch" / STATE)
    assert [name for name, result in held.results.items() if result.done] == NAMES[:2]
    assert held.values["switch_contacts"] == SwitchContacts.NO_NC_PAIR
    assert held.results["contacts"].measured["plus limit switch"].endswith("both wires")
    assert (tmp_path / "winch" / "before.yaml").is_file()
    expect(page.locator("#steps li").nth(1)).to_contain_text("✓ done")


AWAY: dict[str, Callable[[Page, Served], object]] = {
    "stop key": lambda page, served: page.click("#stop"),
    "commands closed": lambda page, served: page.evaluate("ask('/api/leave', {})"),
    "page closed": lambda page, served: page.close(),
    "server ended": lambda page, served: served.stop(),
    "server killed": lambda page, served: served.kill(),
}
INDEXING_S = 20.0


def test_whoever_leaves_stops_the_carriage_and_it_goes_on(
    served: Served, open_page: Open, tmp_path: Path
) -> None:
    done_until(tmp_path / "winch", "line")
    page = lead(open_page, served)
    for way, leave in AWAY.items():
        shows(page, "#begin", "Go on with step 8")
        page.click("#begin")
        press(page, "g", "Begin this step?")
        with served.device() as device:
            wait(lambda device=device: is_moving(device), AWAITED_S, "indexes")
        leave(page, served)
        if way.startswith("server"):
            served.start()
        with served.device() as device:
            # By itself it indexes again and again; an indexing that nobody stops ends at a switch.
            limit_s = INDEXING_S if way == "server killed" else STANDS_S
            wait(lambda device=device: not is_moving(device), limit_s, f"stands: {way}")
            looked = time.monotonic()
            while time.monotonic() - looked < STILL_S:
                assert not is_moving(device), f"goes on: {way}"
            assert flag(read_live(device), Flag.INDEXED) == (way == "server killed")
        held = session.load(tmp_path / "winch" / STATE)
        assert [name for name in NAMES if name in held.results] == NAMES[:7]
        if way == "stop key":
            shows(page, "#ended", "was pressed. The carriage stands.")
        elif way == "page closed":
            page = lead(open_page, served)
        else:
            open_commands(page)
    page.click("#begin")
    press(page, "l", "Begin this step?")
    shows(page, "#steps li", "left out, not measured")
    press(page, "g", "Begin this step?")  # then a question, and the carriage follows the drum
    shows(page, "#question-text", "Haul in slowly")
    with served.device() as device:
        assert flag(read_live(device), Flag.TRACKING)
        page.close()
        wait(lambda: not flag(read_live(device), Flag.TRACKING), STANDS_S, "follows no more")


def test_report_links_stay_in_the_folder(served: Served, open_page: Open, tmp_path: Path) -> None:
    def status_of(name: str) -> int:
        try:
            served.get(f"commission/report/{name}")
        except urllib.error.HTTPError as error:
            return error.code
        return 200

    folder = tmp_path / "winch"
    done_until(folder, "line")
    held = session.load(folder / STATE)
    held.active = {"pitch_um": 1}
    (folder / "report.html").write_text("<style>p { color: red }</style><p>A report.")
    (tmp_path / "secret.pdf").write_text("secret")
    (folder / "report.pdf").symlink_to(tmp_path / "secret.pdf")
    assert status_of("report.html") == 200
    for name in (
        "report.pdf", STATE, "before.yaml", "report.json", "..%2fsecret.pdf", "../secret.pdf",
        "..%2freport.html", f"%2f{tmp_path}%2fsecret.pdf", "", ".", "report.html%00",
    ):  # fmt: skip
        assert status_of(name) in (400, 404), name
    page = open_page(served)
    page.goto(served.url + "commission")
    expect(page.locator("#reports a")).to_have_text(["Report, HTML"])
    with page.context.expect_page() as opened:
        page.click("#reports a")
    expect(opened.value.locator("p")).to_have_css("color", "rgb(255, 0, 0)")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--port", "x"], "--commission: its steps move the carriage; give --allow-commands"),
        (["--simulator", "--allow-commands"], "the demonstration drives this winch"),
    ],
)
def test_where_it_cannot_be_offered(options: list[str], said: str, tmp_path: Path) -> None:
    PinFile(tmp_path / "pin.json").set(PIN)
    given = [*options, "--commission", str(tmp_path), "--pin-file", str(tmp_path / "pin.json")]
    refused = CliRunner().invoke(app, ["serve", *given])
    assert refused.exit_code == 1
    assert said in str(refused.exception) + refused.output
