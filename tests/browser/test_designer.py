"""What a designer does in a day, from the first page to the last, as one story."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote

import pytest
from playwright.sync_api import expect

from fdvv.model.file import load_model
from tests.browser.editing import FORCE, drag, number, scales
from tests.browser.pressing import DOWN, UP, presses, ready
from tests.studio.running import RunningStudio
from tests.support.buttons import write_cycle

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page

POINT, STEPS = 4, 50


def forces(page: Page) -> list[float]:
    rows = page.locator(".edit-points tbody tr")
    return [number(rows.nth(i).locator("td").nth(FORCE).inner_text()) for i in range(rows.count())]


def found_by_typing(page: Page, words: str) -> None:
    """Find a measured switch and open it in the editor, by keys alone."""
    page.keyboard.press("/")
    page.keyboard.type(words)
    expect(page.locator(".lib-row:not([hidden])")).to_have_count(1, timeout=40_000)
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="Edit", exact=True)).to_be_focused()
    page.keyboard.press("Enter")
    page.wait_for_selector(".edit-points")


def edited_and_undone(page: Page) -> tuple[list[float], list[float]]:
    """Drag a point, nudge it fifty times, take the nudges back; return forces before and after."""
    before, to_screen = forces(page), scales(page)
    x_mm = number(page.locator(".edit-points tbody tr").nth(POINT).locator("td").nth(1).inner_text())
    start, end = to_screen(x_mm, before[POINT]), to_screen(x_mm, before[POINT] + 9)
    drag(page, start, (0.0, end[1] - start[1]))
    dragged = forces(page)
    assert dragged[POINT] == pytest.approx(before[POINT] + 9, abs=0.6)
    page.locator(".edit-plot").focus()
    for n in range(STEPS):
        page.keyboard.press("ArrowLeft" if n % 2 else "ArrowRight")
        page.keyboard.press("ArrowUp")
    assert forces(page) != dragged
    while forces(page) != dragged:
        page.keyboard.press("Control+z")
    return before, dragged


def test_a_designer_finds_edits_presses_renders_and_keeps_a_button(
    context: BrowserContext, start_studio: Callable[..., RunningStudio], tmp_path: Path
) -> None:
    bench = tmp_path / "bench"
    bench.mkdir()
    write_cycle(bench / "Gateron Yellow.csv", added_cN=3, seed=1)
    write_cycle(bench / "Silent Linear Red.csv", added_cN=9, seed=2)
    studio = start_studio(bench)
    page = context.new_page()
    page.goto(f"{studio.address}#/library")
    page.wait_for_selector("html[data-ready=library]")

    found_by_typing(page, "yellow")
    before, dragged = edited_and_undone(page)
    expect(page.locator(".edit-saved")).to_have_text("saved")
    assert "own%3A" in page.url
    kept = next((studio.project / "buttons").glob("*.fdvv.json"))
    assert load_model(kept).of("press")[0].control_points_cN.tolist() == pytest.approx(dragged, abs=1e-4)
    assert before != dragged

    own = page.url.partition("#/edit/")[2]
    page.goto(f"{studio.base}/#/press/{own}")
    ready(page)
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")
    page.wait_for_selector(UP)
    presses(page, 1)

    page.goto(f"{studio.base}/#/live/compensate")
    page.get_by_label("Button", exact=True).select_option(unquote(own))
    page.get_by_text("Advanced").click()
    speeds = page.get_by_label("Speeds", exact=True)
    speeds.fill("100")
    speeds.press("Enter")
    page.get_by_role("button", name="Start", exact=True).click()
    page.wait_for_selector(".job-head .job-state.done", timeout=90_000)

    page.goto(f"{studio.base}/#/edit/{own}")
    page.reload()
    page.wait_for_selector(".edit-points")
    assert forces(page) == dragged
    page.get_by_role("button", name="Export").click()
    with page.expect_download() as file:
        page.get_by_role("menuitem", name="Model file").click()
    exported = tmp_path / "exported.fdvv.json"
    file.value.save_as(exported)
    assert load_model(exported) == load_model(kept)
