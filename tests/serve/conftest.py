# SPDX-License-Identifier: Apache-2.0
"""A server for each module, or one of the test's own."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright
from served import Served

OUT = Path(__file__).resolve().parents[2] / "out" / "page"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Served]]:
    """Starts servers, and ends what the test leaves running."""
    running: list[Served] = []

    def start_one(*options: str, **arguments: object) -> Served:
        folder = tmp_path / str(len(running))
        folder.mkdir()
        running.append(Served(folder, *options, **arguments))
        return running[-1]

    yield start_one
    for served in running:
        served.close()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    if CHROMIUM is None:
        pytest.skip("no chromium: apt-get install chromium")
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    """Opens the page of a server; afterwards: no error on its console, no other host asked."""
    wrong: list[str] = []
    contexts = []

    def open_one(served: Served, width: int = 1280, height: int = 900) -> Page:
        context = browser.new_context(viewport={"width": width, "height": height})
        contexts.append(context)
        page = context.new_page()
        mine = (served.url, served.url.replace("http", "ws", 1), "data:", "blob:")

        def console(message) -> None:
            # The server that a test has killed, and answers that refuse, are no fault of the page.
            expected = ("ERR_CONNECTION_REFUSED", "WebSocket connection", "status of 4")
            if message.type == "error" and not any(e in message.text for e in expected):
                wrong.append(message.text)

        page.on("console", console)
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda r: None if r.url.startswith(mine) else wrong.append(r.url))
        page.on("websocket", lambda w: None if w.url.startswith(mine) else wrong.append(w.url))
        page.goto(served.url)
        return page

    yield open_one
    for context in contexts:
        context.close()
    assert not wrong, wrong


@pytest.fixture
def shot() -> Callable[[Page, str], None]:
    """Keeps a screenshot in out/page."""
    OUT.mkdir(parents=True, exist_ok=True)
    return lambda page, name: page.screenshot(path=OUT / f"{name}.png", full_page=True) and None
