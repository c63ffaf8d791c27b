"""Somebody at the studio whose clicks are counted: by mouse, or by the keyboard alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

MOST_TABS = 80


@dataclass
class CountedPerson:
    """Clicks are what is pressed with a mouse, and Enter, Space and letters that act; moving on is none."""

    page: Page
    keyboard: bool = False
    clicks: int = 0

    def click(self, on: Locator) -> None:
        """Use something: click it, or reach it with Tab and press Enter (Space where it is a choice)."""
        self.clicks += 1
        if not self.keyboard:
            on.click()
            return
        on.wait_for()
        self.reach(on)
        choice = on.get_attribute("type") in ("radio", "checkbox")
        self.page.keyboard.press("Space" if choice else "Enter")

    def reach(self, on: Locator, most_tabs: int = MOST_TABS) -> None:
        """Move the focus there with Tab; within a group of radio buttons with the arrows."""
        for _ in range(most_tabs):
            if on.evaluate("(it) => it === document.activeElement"):
                return
            group = "(it) => it.type === 'radio' && document.activeElement?.name === it.name"
            self.page.keyboard.press("ArrowDown" if on.evaluate(group) else "Tab")
        raise AssertionError("the keyboard does not lead there")
