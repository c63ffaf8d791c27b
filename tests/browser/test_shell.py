"""The frame of the studio, driven as a person does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from playwright.sync_api import expect

from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page


def test_every_page_is_reached_by_a_key_and_by_a_link(page: Page) -> None:
    names = page.eval_on_selector_all("nav a", "links => links.map(a => a.getAttribute('href').slice(2))")
    assert names == ["library", "edit", "press", "live", "programs", "optimize", "studies"]
    for number, name in enumerate(names, start=1):
        page.keyboard.press(f"Alt+{number}")
        page.wait_for_selector(f"main[data-page={name}]")
    page.click("nav a[href='#/edit']")
    page.wait_for_selector("main[data-page=edit]")


def test_the_theme_is_remembered(page: Page) -> None:
    before = page.get_attribute("html", "data-theme")
    theme = page.locator("button[aria-label^=Theme]")
    while page.get_attribute("html", "data-theme") == before:
        theme.click()
    chosen = page.get_attribute("html", "data-theme")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    assert page.get_attribute("html", "data-theme") == chosen


def test_without_the_token_there_is_no_page(context: BrowserContext, studio: RunningStudio) -> None:
    page = context.new_page()
    answer = page.goto(studio.base)
    assert answer is not None
    assert answer.status == 403
    assert "whole address" in page.inner_text("body")


def test_the_keys_are_listed_and_put_away(page: Page) -> None:
    sheet = page.get_by_role("complementary", name="Keys")
    page.keyboard.press("?")
    expect(sheet.get_by_text("Go to Library")).to_be_visible()
    sheet.get_by_role("button", name="Close").press("Escape")
    expect(sheet).to_be_hidden()


def test_an_error_is_read_out_and_leaves_with_its_page(page: Page, studio: RunningStudio) -> None:
    page.goto(f"{studio.base}/#/edit/own:there-is-none")
    alert = page.get_by_role("alert").filter(has_text="there-is-none")
    expect(alert).to_be_visible()
    page.keyboard.press("Alt+1")
    page.wait_for_selector("main[data-page=library]")
    expect(alert).to_have_count(0)
