"""The frame of the studio, driven as a person does."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from playwright.sync_api import expect

from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page


PAGES = ["library", "edit", "press", "live", "optimize", "studies", "programs"]


def test_every_page_is_reached_by_a_key_and_by_a_link(page: Page) -> None:
    expect(page.locator("main")).to_have_attribute("data-page", "home")
    links = page.eval_on_selector_all("nav a", "links => links.map(a => a.getAttribute('href').slice(2))")
    assert [link.split("/")[0] for link in links] == PAGES
    for number, name in enumerate(["home", *PAGES]):
        page.keyboard.press(f"Alt+{number}")
        page.wait_for_selector(f"main[data-page={name}]")
    page.get_by_role("navigation").get_by_role("link", name="Edit", exact=True).click()
    page.wait_for_selector("main[data-page=edit]")


def test_the_button_goes_along_the_line_of_work(page: Page, studio: RunningStudio) -> None:
    page.goto(f"{studio.base}/#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
    name = page.get_by_role("button", name="Button: mx-clear")
    expect(name).to_be_visible()
    for step, where in (
        ("Edit", "edit/builtin%3Amx-clear"),
        ("Press", "press/builtin%3Amx-clear"),
        ("Rig", "live/compensate?button=builtin%3Amx-clear"),
        ("Optimise", "optimize?button=builtin%3Amx-clear"),
        ("Study", "studies?button=builtin%3Amx-clear"),
    ):
        link = page.get_by_role("navigation").get_by_role("link", name=step, exact=True)
        expect(link).to_have_attribute("href", f"#/{where}")
        link.click()
        page.wait_for_selector(f"main[data-page={where.split('/')[0].split('?')[0]}]")
        expect(name).to_be_visible()
    # who comes back finds the comparison as it was
    page.get_by_role("link", name="Compare", exact=True).click()
    expect(page.locator(".lib-chip")).to_have_count(2)


def test_a_copy_has_the_name_that_the_person_gives_it(page: Page, studio: RunningStudio) -> None:
    page.goto(f"{studio.base}/#/edit/builtin:mx-clear")
    page.get_by_role("button", name="Button: mx-clear").click()
    page.get_by_role("menuitem", name="Copy…").click()
    dialog = page.get_by_role("dialog", name="Copy mx-clear")
    field = dialog.get_by_label("New name")
    expect(field).to_have_value("mx-clear copy")
    field.fill("../no")
    field.press("Enter")
    expect(dialog.get_by_role("alert")).to_contain_text("must begin with a letter")
    field.fill("of my own")
    field.press("Enter")
    expect(page.get_by_role("button", name="Button: of my own")).to_be_visible()
    expect(page.locator("h1")).to_have_text("of my own")
    page.get_by_role("button", name="Button: of my own").click()
    page.get_by_role("menuitem", name="Rename…").click()
    page.get_by_label("New name").fill("renamed")
    page.keyboard.press("Enter")
    expect(page.locator("h1")).to_have_text("renamed")
    expect(page.get_by_role("button", name="Button: renamed")).to_be_visible()


def test_on_a_phone_the_step_of_now_is_in_sight(page: Page, studio: RunningStudio) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    for name in PAGES:
        page.goto(f"{studio.base}/#/{name}")
        page.wait_for_selector(f"main[data-page={name}]")
        box = page.locator("nav [aria-current]").bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390


def test_the_tour_leads_from_a_curve_to_a_press_by_keys_and_can_be_left(page: Page) -> None:
    page.get_by_role("button", name="Take the tour").press("Enter")
    note = page.get_by_role("dialog")
    for title, where in (
        ("How a button feels", "library"),
        ("Its landmarks", "library"),
        ("Change it", "edit"),
        ("Can a rig render it?", "edit"),
        ("It is your own now", "edit"),
        ("Press it", "press"),
        ("The line of work", "press"),
    ):
        expect(note).to_contain_text(title)
        expect(page.locator("main")).to_have_attribute("data-page", where)
        on = note.get_by_role("button", name="Done" if title == "The line of work" else "Next")
        expect(on).to_be_focused()
        if title == "Change it":
            for key in ("c", "ArrowRight", "ArrowRight", "ArrowUp"):
                page.keyboard.press(key)
            expect(page.get_by_role("button", name="Button: mx-clear 2")).to_be_attached()
        on.press("Enter")
    expect(note).to_have_count(0)
    expect(page).to_have_url(re.compile("press/own%3Amx-clear%202"))
    page.keyboard.press("Alt+0")
    page.get_by_role("button", name="Take the tour").click()
    expect(note).to_contain_text("How a button feels")
    page.keyboard.press("Escape")
    expect(note).to_have_count(0)


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
    expect(sheet.get_by_text("Go to Compare")).to_be_visible()
    page.keyboard.press("Escape")
    expect(sheet).to_be_hidden()


def test_an_error_is_read_out_and_leaves_with_its_page(page: Page, studio: RunningStudio) -> None:
    page.goto(f"{studio.base}/#/edit/own:there-is-none")
    alert = page.get_by_role("alert").filter(has_text="there-is-none")
    notice = page.locator("[data-sonner-toast]")
    expect(alert).to_be_visible()
    expect(notice).to_have_count(1)
    page.keyboard.press("Alt+1")
    page.wait_for_selector("main[data-page=library]")
    expect(alert).to_have_count(0)
    expect(notice).to_have_count(0)


def test_the_first_page_of_a_new_project_has_nothing_empty(page: Page, studio: RunningStudio) -> None:
    expect(page.get_by_role("heading", level=1)).to_contain_text("Measure how a button feels")
    cards = page.locator(".card")
    expect(cards).to_have_count(3)
    expect(page.locator(".card polyline")).to_have_count(7)
    expect(page.get_by_role("heading", name="Go on with")).to_have_count(0)
    with page.expect_file_chooser():
        page.get_by_role("button", name="Drop a force curve").click()
    cards.first.click()
    expect(page.locator(".lib-chip")).to_have_count(3)


def test_the_first_page_leads_back_to_what_was_worked_on(page: Page, studio: RunningStudio) -> None:
    page.goto(f"{studio.base}/#/edit")
    page.get_by_role("button", name="New tactile").click()
    page.wait_for_selector(".edit-points")
    page.keyboard.press("Alt+0")
    page.get_by_role("link", name="my button").click()
    expect(page).to_have_url(re.compile("#/edit/own%3Amy%20button"))
