"""A real studio in a process of its own, and a real Chromium that opens it."""

from __future__ import annotations

import os
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page

WAIT_ms = 15_000
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "browser" in item.path.parts:
            item.add_marker(pytest.mark.browser)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One Chromium for all tests."""
    if CHROMIUM is None:
        if os.environ.get("CI"):
            pytest.fail("CI needs Chromium: run make web-tools")
        pytest.skip("Chromium is not installed: run make web-tools")
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=WAIT_ms)

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--autoplay-policy=no-user-gesture-required"]
        )
        yield chromium
        chromium.close()


@pytest.fixture
def start_studio(tmp_path: Path) -> Iterator[Callable[..., RunningStudio]]:
    """Yield a function that starts a studio on sources, its project below a fresh folder."""
    running: list[RunningStudio] = []

    def start(*sources: Path) -> RunningStudio:
        running.append(RunningStudio(tmp_path / "project", sources))
        return running[-1]

    yield start
    for studio in running:
        studio.stop(signal.SIGKILL)  # an orderly end takes half a second, and tests of the studio try it


@pytest.fixture
def studio(start_studio: Callable[..., RunningStudio]) -> RunningStudio:
    """A studio with an empty project."""
    return start_studio()


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    """A browser profile of its own; any request that would leave the machine fails the test."""
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    context.set_default_timeout(WAIT_ms)
    left: list[str] = []
    context.on("request", lambda request: left.append(request.url) if not _local(request.url) else None)
    yield context
    context.close()
    assert left == []


def _fault(message: ConsoleMessage) -> bool:
    """Return whether a message is a fault, not what Chromium logs for every answer to a person's mistake."""
    return message.type == "error" and "status of 422" not in message.text


def _local(url: str) -> bool:
    return url.startswith(("http://127.0.0.1:", "ws://127.0.0.1:", "data:", "blob:http://127.0.0.1:"))


@pytest.fixture
def page(context: BrowserContext, studio: RunningStudio) -> Iterator[Page]:
    """The studio's first page, ready; what the page throws or complains of fails the test."""
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("console", lambda message: wrong.append(message.text) if _fault(message) else None)
    # file choosers are caught from the start: a key pressed at once opened the system's before they were
    page.on("filechooser", lambda _chooser: None)
    page.goto(studio.address)
    page.wait_for_selector("html[data-ready]")
    yield page
    assert wrong == []
