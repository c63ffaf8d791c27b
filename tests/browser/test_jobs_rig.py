"""Before and after on the simulated rig, from the first screen, in three clicks at most: mouse, then keys."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from tests.browser.counted import CountedPerson

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

LONG_ms = 90_000
MOST_CLICKS = 3
RIG = re.compile("^Rig$")
BEFORE_AND_AFTER = re.compile(
    r"Mean error [\d.]+ → [\d.]+ cN on simulated presses, largest [\d.]+ → [\d.]+ cN; "
    "a finger would (not )?notice it"
)


def rig(page: Page) -> Locator:
    return page.get_by_role("navigation").get_by_role("link", name=RIG)


def start(page: Page) -> Locator:
    return page.get_by_role("button", name="Start", exact=True)


def assert_before_and_after(person: CountedPerson) -> None:
    verdict = person.page.get_by_role("region", name="Verdict")
    # from the first second it says what happens and how long it takes
    expect(verdict).to_contain_text(re.compile(r"(a few seconds|about \d+ (s|min)) left"))
    expect(verdict).to_contain_text(BEFORE_AND_AFTER, timeout=LONG_ms)
    expect(verdict.get_by_role("link", name="Press it")).to_be_visible()
    plots = person.page.get_by_role("img", name=re.compile("target, before and after"))
    expect(plots).to_have_count(4)
    expect(plots.first).to_be_in_viewport()
    assert person.clicks <= MOST_CLICKS


@pytest.mark.parametrize("keyboard", [False, True], ids=["mouse", "keyboard"])
def test_before_and_after_take_three_clicks_at_most(page: Page, keyboard: bool) -> None:
    person = CountedPerson(page, keyboard)
    person.click(rig(page))
    person.click(start(page))
    assert_before_and_after(person)


def test_with_the_button_that_is_worked_on(page: Page) -> None:
    page.evaluate("sessionStorage.setItem('fdvv-current', 'builtin:mx-brown')")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    person = CountedPerson(page)
    person.click(rig(page))
    expect(page.get_by_label("Button", exact=True)).to_have_value("builtin:mx-brown")
    person.click(start(page))
    page.get_by_role("heading", name=re.compile("Compensate mx-brown on twin")).wait_for()
    assert_before_and_after(person)
