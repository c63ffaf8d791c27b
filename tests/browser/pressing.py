"""Pressing a button on the page of live presses."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

LAMP = ".press-lamp"


DOWN, UP = f"{LAMP}:not([data-key='0'])", f"{LAMP}[data-key='0']"


def ready(page: Page) -> None:
    """Wait until something is under the finger and was seen at rest."""
    page.wait_for_selector(".press-told:has-text('simulated rig')")
    page.wait_for_selector(UP)


def presses(page: Page, count: int) -> None:
    """Wait until so many presses are over."""
    page.wait_for_selector(f"[data-value='presses'] >> text=/^{count}$/", state="attached")
