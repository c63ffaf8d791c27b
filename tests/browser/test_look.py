"""Every page, three widths, both themes: no text cut, covered or outside, nothing logged, axe clean."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.browser.accessibility import audit
from tests.browser.boxes import faults, record
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SIZES = ((1440, 900), (1024, 768), (390, 844))
PAGES = (
    "home",
    "library",
    "library?over=builtin%3Amx-clear&over=builtin%3Amx-red",
    "edit",
    "edit/builtin:mx-clear",
    "press/builtin:mx-clear",
    "live/compensate",
    "live/capture",
    "live/tune",
    "live/device",
    "programs",
    "programs/shipped:multi-level",
    "optimize",
    "studies",
)
BUSY = {"edit/builtin:mx-clear": ".edit-points"}
"""Pages that go on asking, such as what a rig can follow, and what shows that they stand."""
NARROW = "overflow: hidden; white-space: nowrap"
PLANTED = {
    "cut": (("p", f"width: 60px; {NARROW}", "a line that is cut by its box"),),
    "outside": (("p", "position: absolute; left: 100vw; margin-left: -20px", "beyond"),),
    "over each other": (("p", "", "one line"), ("p", "margin-top: -15px", "another line")),
    "too wide": (("button", "width: 40px; white-space: nowrap", "a long name"),),
}
"""Tag, style and text of what each kind of fault is made of."""
DRAWN = """() => {
  const canvas = document.createElement("canvas");
  canvas.id = "planted";
  document.querySelector(".home").append(canvas);
  canvas.getContext("2d").fillText("beyond its edge", canvas.width - 20, 40);
}"""
PLANT = """parts => {
  const host = document.createElement("div");
  host.id = "planted";
  for (const [tag, style, text] of parts) {
    const part = document.createElement(tag);
    part.style.cssText = style;
    part.textContent = text;
    host.append(part);
  }
  document.querySelector(".home").append(host);
}"""


@pytest.fixture(scope="module")
def look(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, list[str]]]:
    """One page of one studio for all of them, and what it logs."""
    studio = RunningStudio(tmp_path_factory.mktemp("look") / "project")
    context = browser.new_context()
    context.set_default_timeout(15_000)
    page = context.new_page()
    record(page)
    logged: list[str] = []
    page.on("pageerror", lambda error: logged.append(str(error)))
    page.on("console", lambda line: logged.append(line.text) if line.type == "error" else None)
    page.goto(studio.address)
    page.wait_for_selector("html[data-ready]")
    yield page, logged
    context.close()
    studio.stop()


def settled(page: Page) -> None:
    """Wait until what a change of size or theme asks for is drawn."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


@pytest.mark.parametrize("address", PAGES)
def test_no_text_is_cut_covered_or_outside(look: tuple[Page, list[str]], address: str) -> None:
    page, logged = look
    page.goto(f"{page.url.partition('#')[0]}#/{address}")
    page.wait_for_selector(f"main[data-page={address.partition('/')[0].partition('?')[0]}]")
    if address in BUSY:
        page.wait_for_selector(BUSY[address])
    else:
        page.wait_for_load_state("networkidle")
    found: list[str] = []
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
            settled(page)
            found += [f"{width} {scheme}: {line}" for line in faults(page)]
    # wide pages are audited in test_accessibility
    found += [f"axe: {line}" for line in audit(page)] + logged
    logged.clear()
    assert found == []


@pytest.mark.parametrize("kind", PLANTED)
def test_a_planted_fault_is_found(look: tuple[Page, list[str]], kind: str) -> None:
    page, _ = look
    page.goto(f"{page.url.partition('#')[0]}#/home")
    page.wait_for_selector(".card polyline")
    page.evaluate(PLANT, PLANTED[kind])
    found = faults(page)
    page.evaluate("document.getElementById('planted').remove()")
    assert any(line.startswith(kind) for line in found)
    assert faults(page) == []


def test_a_word_that_a_plot_cuts_is_found(look: tuple[Page, list[str]]) -> None:
    page, _ = look
    page.goto(f"{page.url.partition('#')[0]}#/home")
    page.wait_for_selector(".card polyline")
    page.evaluate(DRAWN)
    found = faults(page)
    page.evaluate("document.getElementById('planted').remove()")
    assert len(found) == 1
    assert found[0].startswith('cut in a plot: "beyond its edge"')
