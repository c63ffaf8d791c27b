"""Before and after on the simulated rig, from the first screen, in three clicks at most: mouse, then keys."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from playwright.sync_api import expect

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

LONG_ms = 90_000
MOST_CLICKS = 3
RIG = re.compile("^Rig$")
BEFORE_AND_AFTER = re.compile(
    r"Mean error [\d.]+ → [\d.]+ cN on simulated presses, largest [\d.]+ → [\d.]+ cN; "
    "a finger would (not )?notice it"
)


class Hand:
    """Clicks, or presses Enter, and counts both."""

    def __init__(self, page: Page) -> None:
        self.page, self.clicks = page, 0

    def click(self, target: Locator) -> None:
        target.click()
        self.clicks += 1

    def enter(self, target: Locator) -> None:
        """Walk to a control with Tab, and press Enter."""
        target.wait_for()
        for _ in range(100):
            if target.evaluate("element => element === document.activeElement"):
                break
            self.page.keyboard.press("Tab")
        expect(target).to_be_focused()
        self.page.keyboard.press("Enter")
        self.clicks += 1


def rig(page: Page) -> Locator:
    return page.get_by_role("navigation").get_by_role("link", name=RIG)


def start(page: Page) -> Locator:
    return page.get_by_role("button", name="Start", exact=True)


def assert_before_and_after(hand: Hand) -> None:
    verdict = hand.page.get_by_role("region", name="Verdict")
    # from the first second it says what happens and how long it takes
    expect(verdict).to_contain_text(re.compile(r"(a few seconds|about \d+ (s|min)) left"))
    expect(verdict).to_contain_text(BEFORE_AND_AFTER, timeout=LONG_ms)
    expect(verdict.get_by_role("link", name="Press it")).to_be_visible()
    plots = hand.page.get_by_role("img", name=re.compile("target, before and after"))
    expect(plots).to_have_count(4)
    expect(plots.first).to_be_in_viewport()
    assert hand.clicks <= MOST_CLICKS, hand.clicks


def test_by_mouse(page: Page) -> None:
    hand = Hand(page)
    hand.click(rig(page))
    hand.click(start(page))
    assert_before_and_after(hand)


def test_by_keyboard_alone(page: Page) -> None:
    hand = Hand(page)
    hand.enter(rig(page))
    hand.enter(start(page))
    assert_before_and_after(hand)


def test_with_the_button_that_is_worked_on(page: Page) -> None:
    page.evaluate("sessionStorage.setItem('fdvv-current', 'builtin:mx-brown')")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    hand = Hand(page)
    hand.click(rig(page))
    expect(page.get_by_label("Button", exact=True)).to_have_value("builtin:mx-brown")
    hand.click(start(page))
    page.get_by_role("heading", name=re.compile("Compensate mx-brown on twin")).wait_for()
    assert_before_and_after(hand)
