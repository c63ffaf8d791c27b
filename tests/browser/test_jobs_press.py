"""Whole jobs in which a button is pressed: by mouse in as few clicks as may be, and by keys alone."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from playwright.sync_api import expect

from tests.browser.counted import CountedPerson
from tests.browser.pressing import DOWN, LAMP, UP, ready

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

MOST_CLICKS, MOST_TABS = 3, 60


class Hand(CountedPerson):
    """A person who holds, too."""

    def hold(self, target: Locator, until: str) -> None:
        """Press the middle of something until a selector is there."""
        self.clicks += 1
        box = target.bounding_box()
        assert box is not None
        self.page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.45 * box["height"])
        self.page.mouse.down()
        self.page.wait_for_selector(until)
        self.page.mouse.up()


def verdict(page: Page) -> Locator:
    return page.get_by_label("Verdict")


def test_a_program_is_pressed_from_the_first_screen_in_three_clicks(page: Page) -> None:
    hand = Hand(page)
    hand.click(page.get_by_role("link", name="Programs", exact=True))
    hand.click(verdict(page).get_by_role("link"))
    ready(page)
    expect(verdict(page)).to_contain_text("Hold the space bar, or press the cap")
    hand.hold(page.locator(".press-view"), until=f"{LAMP}[data-key='3']")
    expect(verdict(page)).to_contain_text(re.compile("^Clicked at .* mm under .* cN; it let go at .* mm"))
    assert hand.clicks <= MOST_CLICKS


def test_a_program_is_copied_pressed_and_edited_by_mouse(page: Page) -> None:
    hand = Hand(page)
    hand.click(page.get_by_role("link", name="Programs", exact=True))
    card = page.locator("article", has=page.get_by_role("link", name="button", exact=True))
    hand.click(card.get_by_role("button", name="Copy and edit"))
    expect(verdict(page)).to_contain_text("Ready: 2 states, no findings.")
    hand.click(verdict(page).get_by_role("button", name="Press it"))
    page.locator(".node.live[data-state='up']").wait_for()
    hand.hold(page.locator(".press-view"), until=".node.live[data-state='down']")
    assert hand.clicks <= MOST_CLICKS + 1


def test_a_button_is_chosen_pressed_compared_and_taken_to_the_rig_by_keys_alone(page: Page) -> None:
    hand = Hand(page, keyboard=True)
    page.goto(f"{page.url.partition('#')[0]}#/press/builtin:mx-clear")
    ready(page)
    page.keyboard.press("x")
    page.wait_for_selector(".press-view[aria-label^='mx-brown']")
    page.keyboard.press("x")
    page.wait_for_selector(".press-view[aria-label^='mx-clear']")
    hand.reach(page.get_by_label("Press", exact=True), MOST_TABS)
    page.keyboard.press("ArrowDown")
    page.wait_for_selector(".press-view:not([aria-label^='mx-clear'])")
    page.wait_for_selector(UP)
    hand.reach(page.get_by_role("button", name="Hold to push"), MOST_TABS)
    page.keyboard.down("Enter")
    page.wait_for_selector(DOWN)
    page.keyboard.up("Enter")
    page.wait_for_selector(UP)
    expect(verdict(page)).to_contain_text("Clicked at")
    hand.reach(page.get_by_role("link", name="Render it on a rig"), MOST_TABS)
    page.keyboard.press("Enter")
    page.wait_for_selector("main[data-page=live]")
    assert "builtin" in page.url.partition("button=")[2]
