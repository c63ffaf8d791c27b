"""The library in a real browser: find, filter, compare, link, take along, all by keyboard too."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import expect

from fdvv.model.file import load_builtin
from fdvv.model.jnd_file import FILE_NAME as JNDS_FILE
from tests.studio.running import RunningStudio
from tests.support.buttons import write_cycle

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page

ROWS = ".lib-row:not([hidden])"
NAMES = ("Kailh Pro Purple", "Gateron Yellow", "Silent Linear Red")


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of three switches and a file that is none."""
    folder = tmp_path_factory.mktemp("sources") / "bench"
    folder.mkdir()
    for i, name in enumerate(NAMES):
        write_cycle(folder / f"{name}.csv", added_cN=10 * i, seed=i)
    (folder / "bad.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    return folder


@pytest.fixture(scope="module")
def with_sources(bench: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    studio = RunningStudio(tmp_path_factory.mktemp("library") / "project", (bench,))
    yield studio
    studio.stop()


@pytest.fixture
def library(context: BrowserContext, with_sources: RunningStudio) -> Iterator[Page]:
    """The library, everything read."""
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("console", lambda message: wrong.append(message.text) if message.type == "error" else None)
    page.goto(f"{with_sources.address}#/library")
    expect(page.locator(".lib-status")).to_contain_text("9 buttons", timeout=40_000)
    yield page
    assert wrong == []


def found(page: Page, *names: str) -> None:
    """Wait until the list shows these buttons, in this order."""
    expect(page.locator(f"{ROWS} .lib-name")).to_have_text(list(names))


def test_a_switch_is_found_by_typing_also_with_a_typo(library: Page) -> None:
    library.keyboard.press("/")
    library.keyboard.type("gatreon")
    found(library, "Gateron Yellow")
    expect(library.locator(".lib-status")).to_contain_text("one letter changed")
    library.keyboard.press("Escape")
    expect(library.locator(".lib-status")).to_contain_text("9 buttons")


def test_a_range_leaves_what_lies_in_it_and_says_what_to_loosen(library: Page) -> None:
    library.get_by_label("Travel, at most").fill("3.65")
    library.keyboard.press("Enter")
    found(library, "rubber-dome")
    library.get_by_label("Search buttons").fill("clear")
    expect(library.locator(".lib-nothing")).to_be_visible()
    library.get_by_role("button", name="Without travel: 1").click()
    found(library, "mx-clear")
    expect(library).not_to_have_url(re.compile("travel_mm"))


def test_the_list_is_worked_by_keys_alone(library: Page) -> None:
    library.keyboard.press("/")
    library.keyboard.type("mx-c")
    found(library, "mx-clear")
    library.keyboard.press("ArrowDown")
    library.keyboard.press("Space")
    expect(library.locator(".lib-chip")).to_have_count(1)
    expect(library.locator(ROWS)).to_have_attribute("aria-selected", "true")
    library.keyboard.press("Enter")
    expect(library.get_by_role("button", name="Edit", exact=True)).to_be_focused()
    library.get_by_role("button", name="Press it").press("Enter")
    library.wait_for_selector("main[data-page=press]")
    expect(library).to_have_url(re.compile(r"#/press/builtin%3Amx-clear(\?|$)"))


def test_a_measured_switch_is_copied_by_its_first_change_and_no_name_is_twice(
    context: BrowserContext, start_studio: Callable[..., RunningStudio], bench: Path
) -> None:
    page = context.new_page()
    page.goto(f"{start_studio(bench).address}#/library")
    page.get_by_label("Search buttons").fill("purple")
    expect(page.locator(f"{ROWS} .lib-name")).to_have_text(["Kailh Pro Purple"], timeout=40_000)
    page.get_by_role("button", name="Actions for Kailh Pro Purple").click()
    page.get_by_role("menuitem", name="Edit").click()
    page.wait_for_selector(".edit-points")
    for key in ("c", "ArrowRight", "ArrowUp"):
        page.keyboard.press(key)
    expect(page).to_have_url(re.compile("#/edit/own%3AKailh%20Pro%20Purple%202"))
    page.get_by_role("link", name="Compare", exact=True).click()
    page.get_by_label("Search buttons").fill("purple")
    expect(page.locator(f"{ROWS} .lib-name")).to_have_text(["Kailh Pro Purple", "Kailh Pro Purple 2"])


def test_a_row_has_its_actions_in_a_menu_by_mouse_and_by_key(library: Page) -> None:
    library.get_by_label("Search buttons").fill("mx-clear")
    found(library, "mx-clear")
    library.get_by_role("button", name="Actions for mx-clear").click()
    menu = library.get_by_role("menu")
    expect(menu.get_by_role("menuitem")).to_have_text(
        ["Edit", "Press", "Render on a rig", "Optimise", "Study", "Find similar", "Compare", "Copy…"]
    )
    menu.get_by_role("menuitem", name="Compare").click()
    expect(library.locator(".lib-chip")).to_have_count(1)
    library.get_by_role("grid", name="Buttons").focus()
    library.keyboard.press("m")
    expect(menu).to_be_visible()
    library.keyboard.press("Escape")
    expect(menu).to_have_count(0)
    chip = library.get_by_role("list", name="Compared buttons")
    chip.get_by_role("button", name="Actions for mx-clear").click()
    menu.get_by_role("menuitem", name="Render on a rig").click()
    expect(library).to_have_url(re.compile("#/live/compensate.button=builtin%3Amx-clear"))


def test_a_comparison_ends_in_a_sentence_and_the_next_step(library: Page) -> None:
    base = library.url.partition("#")[0]
    library.goto(f"{base}#/library?over=builtin%3Amx-clear")
    verdict = library.get_by_role("region", name="Verdict")
    expect(verdict).to_contain_text("mx-clear is tactile: a bump of 13.3 cN under its peak of 64.7 cN")
    expect(verdict.get_by_role("link", name="Edit mx-clear")).to_be_visible()
    library.goto(f"{base}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
    expect(verdict).to_contain_text(
        re.compile(r"bottom-out 89\.8 against 60\.1 cN; \d+\.\d JND apart: computed to feel diff")
    )
    with library.expect_download():
        verdict.get_by_role("button", name="Share this comparison").click()
    library.goto(f"{base}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red&over=builtin%3Amx-brown")
    expect(verdict).to_contain_text(re.compile(r"mx-\w+ \(\d+\.\d JND\) feels nearest to mx-clear, mx-"))


def test_where_the_jnds_cannot_be_read_the_comparison_says_so(page: Page, tmp_path: Path) -> None:
    (tmp_path / JNDS_FILE).write_text("{")
    studio = RunningStudio(tmp_path)
    try:
        page.goto(f"{studio.address}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
        verdict = page.get_by_role("region", name="Verdict")
        expect(verdict).to_contain_text(
            re.compile(rf"against 60\.1 cN\. No distance: {JNDS_FILE}, end of file: .*, or remove it\."),
            timeout=40_000,
        )
    finally:
        studio.stop()


def test_a_link_shows_the_same_view(library: Page, context: BrowserContext) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
    table = library.locator(".lib-landmarks")
    expect(table.locator("thead th")).to_have_count(3)
    library.get_by_role("tab", name="Slope").click()
    library.get_by_role("button", name="Use mx-red as the reference").click()
    library.get_by_label("Search buttons").fill("mx")
    expect(library.locator(".lib-status")).to_contain_text("5 of 9 buttons")
    texts = table.inner_text()
    expect(library).to_have_url(re.compile("q=mx&over=.*view=slope"))
    other = context.new_page()
    other.goto(library.url)
    expect(other.locator(".lib-landmarks thead th")).to_have_count(3)
    assert other.locator(".lib-landmarks").inner_text() == texts
    expect(other.get_by_role("tab", name="Slope")).to_have_attribute("aria-selected", "true")
    expect(other.get_by_label("Search buttons")).to_have_value("mx")
    expect(other.locator(".lib-status")).to_contain_text("5 of 9 buttons")
    other.close()


def test_differences_are_to_the_reference_and_what_is_not_there_says_why(library: Page) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
    bottom = library.locator(".lib-landmarks tr", has_text="Bottom-out")
    expect(bottom.locator("td")).to_have_text(["89.8", re.compile(r"60\.1 −29\.7")])
    peak = library.locator(".lib-landmarks tr", has=library.get_by_text("Peak, cN", exact=True))
    expect(peak.locator("td").nth(1)).to_have_attribute("title", re.compile("never falls by 4 cN"))


def test_a_term_is_explained_by_pointer_and_by_key(library: Page) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?over=builtin%3Amx-clear")
    term = library.locator(".lib-landmarks").get_by_role("button", name="Preload")
    meaning = library.get_by_role("tooltip", name="preload")
    term.hover()
    expect(meaning).to_contain_text("The force at the end of the first step on contact.")
    library.mouse.move(5, 5, steps=10)
    expect(meaning).to_have_count(0)
    term.focus()
    library.keyboard.press("Tab")
    expect(library.get_by_role("tooltip", name="peak")).to_contain_text("The greatest force before the bump.")
    library.keyboard.press("Escape")
    expect(library.get_by_role("tooltip")).to_have_count(0)


def test_the_file_of_numbers_holds_the_curves(library: Page) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?over=builtin%3Amx-clear")
    expect(library.locator(".lib-chip")).to_contain_text("0.5 mm/s")
    with library.expect_download() as waiting:
        library.get_by_role("button", name="CSV").click()
    head, *lines = Path(waiting.value.path()).read_text().splitlines()
    assert head == (
        '"mx-clear, release, 0.5 mm/s: displacement, mm","mx-clear, release, 0.5 mm/s: force, cN",'
        '"mx-clear, press, 0.5 mm/s: displacement, mm","mx-clear, press, 0.5 mm/s: force, cN"'
    )
    table = np.array([[float(cell) for cell in line.split(",")] for line in lines])
    model = load_builtin("mx-clear")
    np.testing.assert_allclose(table[:, 3], model.force_cN(table[:, 2], 0.5), atol=2e-3)
    np.testing.assert_allclose(table[:, 1], model.force_cN(table[:, 0], 0.5, "release"), atol=2e-3)


def test_the_pictures_are_files_that_say_what_they_show(library: Page) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?over=builtin%3Amx-clear")
    expect(library.locator(".lib-chip")).to_contain_text("0.5 mm/s")
    with library.expect_download() as waiting:
        library.get_by_role("button", name="SVG").click()
    drawn = Path(waiting.value.path()).read_text()
    assert "mx-clear (0.5 mm/s)" in drawn
    assert "displacement from contact, mm" in drawn
    assert "force, cN" in drawn
    with library.expect_download() as waiting:
        library.get_by_role("button", name="PNG").click()
    assert Path(waiting.value.path()).read_bytes().startswith(b"\x89PNG")


def test_what_feels_alike_is_a_click_away(library: Page) -> None:
    library.goto(f"{library.url.partition('#')[0]}#/library?q=gateron&tab=alike")
    alike = library.get_by_role("region", name="Similar buttons")
    expect(alike.locator("tbody tr")).to_have_count(8)
    expect(alike.locator("tbody tr").first).to_contain_text("Silent Linear Red")
    alike.get_by_role("button", name="Sort the list by similarity").click()
    expect(library.locator(".lib-status")).to_contain_text("nearest first to Gateron Yellow")


def test_refused_files_are_shown_with_their_reasons(library: Page) -> None:
    library.get_by_text("1 files cannot be used").click()
    expect(library.locator(".lib-refused li")).to_contain_text("bench/bad.csv")
    expect(library.locator(".lib-refused li")).to_contain_text("no header names a displacement")


def test_files_that_come_and_go_are_followed_when_looked_for_again(library: Page, bench: Path) -> None:
    write_cycle(bench / "Newcomer.csv")
    library.get_by_role("button", name="Rescan").click()
    expect(library.locator(".lib-status")).to_contain_text("10 buttons", timeout=30_000)
    library.get_by_label("Search buttons").fill("newcomer")
    found(library, "Newcomer")
    (bench / "Newcomer.csv").unlink()
    library.get_by_role("button", name="Rescan").click()
    expect(library.locator(".lib-nothing")).to_be_visible()


def test_without_folders_the_page_says_how_to_give_some(page: Page) -> None:
    page.keyboard.press("Alt+1")
    expect(page.locator(".lib-more-buttons")).to_contain_text("fdvv studio FOLDER")
    expect(page.locator(ROWS)).to_have_count(6)
