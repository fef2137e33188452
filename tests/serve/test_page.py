# SPDX-License-Identifier: Apache-2.0
"""The operator's page in a browser: what it shows, when it says that it does not know."""

import re
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from levelwind.line.device import Device
from levelwind.line.live import flag, read_live
from levelwind.line.parameter_sets import replace_set
from levelwind.map_table import BenchCommand, Fault, Flag, Mode, State
from playwright.sync_api import Locator, Page, expect
from served import PIN, Served, wait

Start = Callable[..., Served]
Open = Callable[..., Page]
Shot = Callable[[Page, str], None]
STALE_MS = 2000


def permit(page: Page) -> str:
    return page.locator("#permit").get_attribute("data-state") or ""


def lose_synchronization(served: Served) -> None:
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 400_000})
        wait(lambda: read_live(device)["state"] == State.TRACKING)
        device.write({"bench_stall": 1})
        wait(lambda: flag(read_live(device), Flag.LOS), 20, "LOS")
        device.write({"bench_stall": 0, "bench_drum_speed_millirpm": 0})
        wait(lambda: flag(read_live(device), Flag.DRUM_AT_REST))


def test_permit_inhibits_and_numbers(start: Start, open_page: Open, shot: Shot) -> None:
    served = start()
    page = open_page(served)
    expect(page.locator("#permit-word")).to_have_text("NO LAUNCH")
    expect(page.locator("#inhibits")).to_contain_text("The position is unknown: the key Index")
    expect(page.locator("#unknown")).to_be_visible()
    shot(page, "unindexed")
    with served.device() as device:
        replace_set(device, {"rope_diameter_um": 5_000})
    served.index()
    expect(page.locator("#permit-word")).to_have_text("LAUNCH PERMITTED")
    expect(page.locator("#inhibits li")).to_have_count(0)
    expect(page.locator("#state")).to_have_text("tracking")
    expect(page.locator("#index-age")).to_contain_text("s ago")
    expect(page.locator("#log-rows")).to_contain_text("Indexing succeeded")
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 300_000})
        expect(page.locator("#next-reversal")).to_contain_text(
            re.compile("next reversal: (plus|minus), in")
        )
        expect(page.locator("#rope-speed")).to_have_text(re.compile(r"\+1\d\.\d m/s"))
        first = page.locator("#block").evaluate("b => b.style.left")
        page.wait_for_function(
            "left => document.getElementById('block').style.left !== left", arg=first
        )
        device.write({"bench_drum_speed_millirpm": 0})
    expect(page.locator("#lay-words")).to_contain_text("turns, highest", timeout=10_000)
    shot(page, "permitted_1280")


def test_los_cannot_be_hidden(start: Start, open_page: Open, shot: Shot) -> None:
    served = start("--allow-commands")
    served.index()
    page = open_page(served)
    lose_synchronization(served)
    alarm = page.locator("#los")
    expect(alarm).to_contain_text("the rope may be laid wrong")
    expect(alarm).to_contain_text(
        re.compile(r"type [12][+-], .* at [+-]\d+\.\d+ mm, \d+\.\d s after power-up")
    )
    expect(alarm).to_contain_text("Look at the rope first")
    expect(page.locator("#permit-word")).to_have_text("NO LAUNCH")
    expect(page.locator("#position")).to_have_text(re.compile("uncertain|unknown"))
    shot(page, "los_1280")
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    expect(page.locator("#keys")).to_be_visible()
    # Every key but Index, in turn; then from the bottom of the page.
    for key in page.locator("button[data-act]").all():
        if key.get_attribute("data-act") != "index" and key.is_visible():
            key.click()
            expect(alarm).to_be_visible()
    page.keyboard.press("Escape")
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    on_top = """() => document.getElementById('los')
        .contains(document.elementFromPoint(innerWidth / 2, 20))"""
    page.wait_for_function(on_top)
    page.set_viewport_size({"width": 360, "height": 640})
    page.wait_for_function(on_top)
    shot(page, "los_360")
    with served.device() as device:
        device.write({"mode": Mode.TRACK})
    served.index(permitted=False)  # rope was laid standing: nobody has acknowledged it
    expect(alarm).to_be_hidden()


def test_fault_with_cause_and_remedy(start: Start, open_page: Open, shot: Shot) -> None:
    served = start()
    served.index()
    page = open_page(served)
    with served.device() as device:
        device.write({"bench_overtravel_plus": 1})
        cause, _, remedy = Fault.OVERTRAVEL_PLUS.text.partition(". ")
        expect(page.locator("#fault-cause")).to_have_text(cause)
        expect(page.locator("#fault-remedy")).to_have_text(remedy)
        expect(page.locator("#switch-plus")).to_have_text("plus: OVERTRAVEL")
        shot(page, "fault_1280")
        device.write({"bench_overtravel_plus": 0})


@pytest.mark.parametrize("how", ["killed", "stopped", "pty removed"])
def test_old_data_is_no_data(start: Start, open_page: Open, shot: Shot, how: str) -> None:
    served = start()
    served.index()
    page = open_page(served)
    expect(page.locator("#permit-word")).to_have_text("LAUNCH PERMITTED")
    began = time.monotonic()
    if how == "killed":
        served.kill()
    elif how == "stopped":  # the connection stands, and says nothing: a cable pulled
        served.signal(signal.SIGSTOP)
    else:
        served.simulator.end()
    expect(page.locator("#permit-word")).to_have_text("NO DATA", timeout=STALE_MS)
    assert time.monotonic() - began < STALE_MS / 1000
    assert permit(page) == "nodata"
    expect(page.locator("#nodata-reason")).not_to_have_text("")
    expect(page.locator("body")).to_have_class(re.compile("stale"))
    shot(page, f"no_data_{how.replace(' ', '_')}")
    if how == "killed":
        served.start()
    elif how == "stopped":
        served.signal(signal.SIGCONT)
    else:
        served.start_simulator()
    expect(page.locator("#permit")).not_to_have_attribute("data-state", "nodata", timeout=10_000)


def test_the_device_restarts(start: Start, open_page: Open) -> None:
    served = start()
    served.index()
    page = open_page(served)
    expect(page.locator("#permit-word")).to_have_text("LAUNCH PERMITTED")
    with served.device() as device:
        device.write({"bench_command": BenchCommand.POWER_CUT})
    expect(page.locator("#inhibits")).to_contain_text("The position is unknown", timeout=10_000)
    expect(page.locator("#log-rows tr").first).to_contain_text("2", timeout=10_000)


def test_pin(start: Start, open_page: Open) -> None:
    served = start("--allow-commands")
    page = open_page(served)
    expect(page.locator("#pin-form")).to_be_visible()
    expect(page.locator("#keys")).to_be_hidden()
    page.fill("#pin", "0000")
    page.press("#pin", "Enter")
    expect(page.locator("#answer")).to_have_text("Wrong PIN.")
    expect(page.locator("#keys")).to_be_hidden()
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    page.click("[data-act=index]")
    expect(page.locator("#permit-word")).to_have_text("LAUNCH PERMITTED", timeout=30_000)
    page.click("#leave")
    expect(page.locator("#keys")).to_be_hidden()


def test_without_commands_the_page_can_only_look(start: Start, open_page: Open) -> None:
    page = open_page(start())
    expect(page.locator("#permit-word")).to_have_text("NO LAUNCH")
    expect(page.locator("#commands")).to_be_hidden()


def parameter(page: Page, name: str) -> Locator:
    """The field of a parameter, with the keys unlocked."""
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    expect(page.locator("#keys")).to_be_visible()
    page.click("#parameters summary")
    page.fill("#filter", name)
    return page.locator(f"input[data-name={name}]")


def test_parameters(start: Start, open_page: Open, shot: Shot) -> None:
    served = start("--allow-commands")
    page = open_page(served)
    field = parameter(page, "pitch_um")
    field.fill("9")
    page.click("#stage")
    expect(page.locator("#parameter-answer")).to_contain_text("pitch_um=9 is outside its limits")
    field.fill("11000")
    page.click("#stage")
    expect(page.locator("tr.differs")).to_contain_text("pitch_um")
    page.click("#parameter-keys [data-act=apply]")
    expect(page.locator("#parameter-answer")).to_have_text("apply: done.")
    page.click("#parameter-keys [data-act=save]")
    expect(page.locator("#parameter-answer")).to_have_text("save: done.")
    expect(page.locator("tr.differs")).to_have_count(0)
    page.fill("#filter", "reversal_plus_um")
    page.locator("input[data-name=reversal_plus_um]").fill("99000")
    page.click("#stage")
    expect(page.locator("#parameter-answer")).to_contain_text("staged")
    page.click("#parameter-keys [data-act=apply]")
    expect(page.locator("#parameter-answer")).to_contain_text("must be at least")
    shot(page, "parameters")
    with served.device() as device:
        assert device.value("pitch_um") == 11_000


def test_typing_goes_on_when_the_table_is_drawn_again(start: Start, open_page: Open) -> None:
    served = start("--allow-commands")
    page = open_page(served)
    field = parameter(page, "pitch_um")
    field.fill("11")
    page.evaluate("readParameters()")
    page.keyboard.type("000")
    expect(field).to_have_value("11000")
    page.click("#stage")
    expect(page.locator("#parameter-answer")).to_contain_text("staged")


def test_launches_with_their_pictures(start: Start, open_page: Open, tmp_path: Path) -> None:
    served = start("--record", str(tmp_path / "launches.sqlite"))
    served.index()
    page = open_page(served)
    page.click("#launches summary")
    expect(page.locator("#recorder")).to_have_text("waiting for a launch")
    with served.device() as device:
        device.write({"bench_drum_speed_millirpm": 200_000})
        expect(page.locator("#recorder")).to_contain_text("recording this launch")
        device.write({"bench_drum_speed_millirpm": 0})
    page.click("text=picture of 1", timeout=15_000)
    page.wait_for_function("() => document.getElementById('launch-picture').naturalWidth > 400")


LEAVING = {
    "let go": lambda page, served: page.mouse.up(),
    "slid off": lambda page, served: page.mouse.move(5, 5),
    "lost focus": lambda page, served: page.evaluate("dispatchEvent(new Event('blur'))"),
    "hidden": lambda page, served: page.evaluate(
        "document.dispatchEvent(new Event('visibilitychange'))"
    ),
    "other key": lambda page, served: page.keyboard.press("Tab"),
    "page left": lambda page, served: page.goto("about:blank"),
    "page closed": lambda page, served: page.close(),
    "connection lost": lambda page, served: page.evaluate("socket.close()"),
    "script hangs": lambda page, served: page.evaluate(
        "setTimeout(() => { for (const end = Date.now() + 2500; Date.now() < end;); }, 0)"
    ),
    "server killed": lambda page, served: served.kill(),
}


def press_on(page: Page, key: str) -> None:
    """Where it is now: what stands above grows with what the page has to say."""
    page.locator(key).hover()
    page.mouse.down()


def hold(device: Device, press: Callable[[], None], release: Callable[[], None]) -> None:
    """Hold a jog key. The page may let go at once: the key has moved, or its data is old."""
    for last in (False, False, True):
        press()
        try:
            wait(lambda: read_live(device)["state"] == State.JOGGING, 3, "jogs")
        except AssertionError:
            release()
            if last:
                raise
        else:
            return


@pytest.mark.parametrize("how", LEAVING)
def test_jog_lets_go(start: Start, open_page: Open, how: str) -> None:
    served = start("--allow-commands")
    served.index()
    page = open_page(served)
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    with served.device() as device:
        device.write({"mode": Mode.CENTRE})
        wait(lambda: read_live(device)["state"] == State.CENTRED, 30)
        hold(device, lambda: press_on(page, "[data-jog='1']"), page.mouse.up)
        LEAVING[how](page, served)
    if how == "server killed":
        served.start()
    with served.device() as device:
        wait(lambda: read_live(device)["state"] != State.JOGGING, 1.5, "let go")
        place_um = read_live(device)["position_um"]
        assert place_um < 70_000, "the travel's end has stopped it, not the page"


def test_a_held_jog_key_keeps_its_place(start: Start, open_page: Open) -> None:
    served = start("--allow-commands")
    served.index()
    page = open_page(served)
    page.fill("#pin", PIN)
    page.press("#pin", "Enter")
    key = page.locator("[data-jog='1']")
    with served.device() as device:
        device.write({"mode": Mode.CENTRE})
        wait(lambda: read_live(device)["state"] == State.CENTRED, 30)
        hold(device, lambda: press_on(page, "[data-jog='1']"), page.mouse.up)
        before, after = key.evaluate(
            """async (key) => {
              const frame = () => new Promise(requestAnimationFrame);
              const before = key.getBoundingClientRect().top;
              const reason = document.createElement("p");
              reason.textContent = "A reason that was not there.";
              document.querySelector("main").prepend(reason);
              for (let i = 0; i < 10; i++) await frame();
              return [before, key.getBoundingClientRect().top];
            }"""
        )
        assert after == pytest.approx(before, abs=1)
        expect(key).to_have_class("held")
        page.mouse.up()
        wait(lambda: read_live(device)["state"] != State.JOGGING, 1.5, "let go")


def test_keyboard_and_labels(start: Start, open_page: Open) -> None:
    served = start("--allow-commands")
    served.index()
    page = open_page(served)
    page.focus("#pin")
    page.keyboard.type(PIN)
    page.keyboard.press("Enter")
    expect(page.locator("#keys")).to_be_visible()
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll('button, input, [role=img], section, [role=region]')]
        .filter((e) => !(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim()))
        .map((e) => e.outerHTML)"""
    )
    assert unnamed == []
    reached = set()
    for _ in range(60):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                "document.activeElement.dataset.act || document.activeElement.dataset.jog || ''"
            )
        )
    assert {"stop", "index", "follow", "1", "-1", "acknowledge"} <= reached
    with served.device() as device:
        device.write({"mode": Mode.CENTRE})
        wait(lambda: read_live(device)["state"] == State.CENTRED, 30)
        page.focus("[data-jog='-1']")
        hold(device, lambda: page.keyboard.down(" "), lambda: page.keyboard.up(" "))
        page.keyboard.up(" ")
        wait(lambda: read_live(device)["state"] != State.JOGGING, 1.5, "let go")


@pytest.mark.parametrize("width", [360, 1920])
def test_width(start: Start, open_page: Open, shot: Shot, width: int) -> None:
    served = start("--allow-commands")
    served.index()
    page = open_page(served, width, 760 if width == 360 else 1080)
    expect(page.locator("#permit-word")).to_have_text("LAUNCH PERMITTED")
    page.click("#parameters summary")
    expect(page.locator("#parameter-rows tr").first).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    expect(page.locator("#log-rows")).to_contain_text("Indexing succeeded")
    hidden_px = page.locator("#log .scroll").evaluate("e => e.scrollWidth - e.clientWidth")
    assert hidden_px <= 0, "nothing of the log is cut off"
    tall = page.locator("#permit-word").evaluate("e => parseFloat(getComputedStyle(e).fontSize)")
    assert tall >= (32 if width == 360 else 100)
    shot(page, f"width_{width}")
