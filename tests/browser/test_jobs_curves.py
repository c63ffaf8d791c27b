"""Two jobs with curves, from the first screen, in few clicks; each once by keyboard alone.

Typing, a file chooser and a drop are no clicks; all else that is pressed with the mouse is, and so is Enter.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv.model.file import load_model
from tests.browser.counted import CountedPerson
from tests.browser.dropping import drop
from tests.browser.editing import drag, scales
from tests.browser.pressing import presses, ready
from tests.support.buttons import write_cycle

if TYPE_CHECKING:
    from playwright.sync_api import Page


class Hand(CountedPerson):
    """A hand that drags and holds, too."""

    def enter(self, keys: str = "Enter") -> None:
        self.clicks += 1
        self.page.keyboard.press(keys)

    def drag(self, start: tuple[float, float], up_px: float) -> None:
        self.clicks += 1
        drag(self.page, start, (0.0, -up_px))

    def hold_space(self) -> None:
        """Press what is under the finger, and let it go."""
        self.clicks += 1
        ready(self.page)
        self.page.get_by_role("application").focus()
        self.page.keyboard.down("Space")
        self.page.wait_for_timeout(400)
        self.page.keyboard.up("Space")
        presses(self.page, 1)


@pytest.fixture
def hand(page: Page) -> Hand:
    expect(page.locator("main")).to_have_attribute("data-page", "home")
    return Hand(page)


def point(page: Page, row: int = 6) -> tuple[float, float]:
    """Return a control point of the curve that is edited: displacement in mm, force in cN."""
    cells = page.locator(".edit-points tbody tr").nth(row).locator("td").all_inner_texts()
    return float(cells[1]), float(cells[2])


def edited(project: Path, was_cN: float, row: int = 6) -> bool:
    model = load_model(project / "buttons" / "Mine.fdvv.json")
    return bool(abs(model.of("press")[0].control_points_cN[row] - was_cN) > 0.5)


def test_a_file_of_ones_own_becomes_a_fitted_edited_and_pressed_button(hand: Hand, tmp_path: Path) -> None:
    page = hand.page
    dialog = drop(page, write_cycle(tmp_path / "Mine.csv"))
    expect(dialog).to_contain_text("RMSE")
    hand.click(dialog.get_by_role("button", name="Keep and edit"))
    page.wait_for_selector(".edit-points")
    x_mm, was_cN = point(page)
    hand.drag(scales(page)(x_mm, was_cN), up_px=40)
    expect(page.locator(".edit-saved")).to_have_text("saved")
    assert edited(tmp_path / "project", was_cN)
    hand.click(page.get_by_role("link", name="Press it"))
    page.wait_for_selector("main[data-page=press]")
    hand.hold_space()
    assert hand.clicks <= 6


def test_the_same_by_keyboard_alone(hand: Hand, tmp_path: Path) -> None:
    page = hand.page
    with page.expect_file_chooser() as choosing:
        page.keyboard.press("o")
    choosing.value.set_files(write_cycle(tmp_path / "Mine.csv"))
    expect(page.get_by_role("button", name="Keep and edit")).to_be_focused(timeout=60_000)
    hand.enter()
    page.wait_for_selector(".edit-points")
    _, was_cN = point(page)
    for key in ("c", "Home", *["ArrowRight"] * 6, "Shift+ArrowUp"):
        page.keyboard.press(key)
    expect(page.locator(".edit-saved")).to_have_text("saved")
    assert edited(tmp_path / "project", was_cN)
    hand.enter("Control+Enter")
    page.wait_for_selector("main[data-page=press]")
    hand.hold_space()
    assert hand.clicks <= 6


def test_two_buttons_are_compared_and_shared(hand: Hand) -> None:
    page = hand.page
    hand.click(page.get_by_role("link", name="Compare", exact=True))
    for name in ("mx-clear", "mx-red"):
        row = page.get_by_role("row").filter(has_text=name)
        hand.click(row.locator(".lib-pin"))
    with page.expect_download() as waiting:
        hand.click(page.get_by_role("button", name="Share this comparison"))
    assert waiting.value.suggested_filename == "mx-clear and mx-red.html"
    assert hand.clicks <= 5


def test_two_are_compared_and_shared_by_keyboard_alone(hand: Hand) -> None:
    page = hand.page
    page.keyboard.press("Alt+1")
    page.wait_for_selector("main[data-page=library]")
    for name in ("mx-clear", "mx-red"):
        page.keyboard.press("/")
        page.keyboard.type(name)
        expect(page.locator(".lib-row:not([hidden]) .lib-name")).to_have_text([name])
        page.keyboard.press("ArrowDown")
        page.keyboard.press("Space")
    expect(page.get_by_role("region", name="Verdict")).to_contain_text(re.compile("mx-clear against mx-red"))
    with page.expect_download():
        hand.enter("Control+Enter")
    assert hand.clicks <= 5
