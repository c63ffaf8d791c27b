"""Every page, three widths, both themes: no text cut, covered or outside, nothing logged, axe clean.

At rest, with its menus and dialogs open, and while work runs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from tests.browser.accessibility import audit
from tests.browser.boxes import faults, record
from tests.browser.dropping import drop
from tests.browser.timing_screens import PRESS_WHEN_SEEN, STEP, Timer, timing_text
from tests.studio.running import RunningStudio
from tests.support.buttons import write_cycle

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SIZES = ((1440, 900), (1024, 768), (390, 844))
PAGES = (
    "home",
    "library",
    "library?over=builtin%3Amx-clear&over=builtin%3Amx-red",
    "edit",
    "edit/builtin:mx-clear",
    "press",
    "press/builtin:mx-clear",
    "live/compensate",
    "live/capture",
    "live/tune",
    "live/device",
    "programs",
    "programs/shipped:multi-level",
    "optimize",
    "studies",
)
BUSY = {"edit/builtin:mx-clear": ".edit-points"}
"""Pages that go on asking, such as what a rig can follow, and what shows that they stand."""
NARROW = "overflow: hidden; white-space: nowrap"
PLANTED = {
    "cut": (("p", f"width: 60px; {NARROW}", "a line that is cut by its box"),),
    "outside": (("p", "position: absolute; left: 100vw; margin-left: -20px", "beyond"),),
    "over each other": (("p", "", "one line"), ("p", "margin-top: -15px", "another line")),
    "too wide": (("button", "width: 40px; white-space: nowrap", "a long name"),),
}
"""Tag, style and text of what each kind of fault is made of."""
DRAWN = """() => {
  const canvas = document.createElement("canvas");
  canvas.id = "planted";
  document.querySelector(".home").append(canvas);
  canvas.getContext("2d").fillText("beyond its edge", canvas.width - 20, 40);
}"""
PLANT = """parts => {
  const host = document.createElement("div");
  host.id = "planted";
  for (const [tag, style, text] of parts) {
    const part = document.createElement(tag);
    part.style.cssText = style;
    part.textContent = text;
    host.append(part);
  }
  document.querySelector(".home").append(host);
}"""


@pytest.fixture(scope="module")
def look(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, list[str]]]:
    """One page of one studio for all of them, and what it logs."""
    studio = RunningStudio(tmp_path_factory.mktemp("look") / "project")
    context = browser.new_context()
    context.set_default_timeout(15_000)
    page = context.new_page()
    record(page)
    logged: list[str] = []
    page.on("pageerror", lambda error: logged.append(str(error.stack)))
    page.on("console", lambda line: logged.append(line.text) if line.type == "error" else None)
    page.goto(studio.address)
    page.wait_for_selector("html[data-ready]")
    yield page, logged
    context.close()
    studio.stop()


def settled(page: Page) -> None:
    """Wait until what a change of size or theme asks for is drawn."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def go(page: Page, address: str) -> None:
    """Open an address anew, and wait for what it shows."""
    base = page.url.partition("#")[0]
    page.goto("about:blank")
    page.goto(f"{base}#/{address}")
    page.wait_for_selector(f"main[data-page={address.partition('/')[0].partition('?')[0]}]")
    if address in BUSY:
        page.wait_for_selector(BUSY[address])
    else:
        page.wait_for_load_state("networkidle")


def looked_at(page: Page, width: int) -> list[str]:
    """Return the faults of a page as it is shown, in both themes."""
    found: list[str] = []
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
        settled(page)
        found += [f"{width} {scheme}: {line}" for line in faults(page)]
        # the widest in one theme, the narrowest in the other
        if (width, scheme) in ((SIZES[0][0], "light"), (SIZES[-1][0], "dark")):
            found += [f"{width} {scheme}, axe: {line}" for line in audit(page)]
    return found


def at_every_size(page: Page, opened: Callable[[Page], None] = lambda _page: None) -> list[str]:
    """Return the faults of a page at each size. opened : brings about what is looked at, size by size."""
    found: list[str] = []
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        opened(page)
        found += looked_at(page, width)
    return found


def taken(logged: list[str]) -> list[str]:
    """Return what the page has logged since the last time."""
    lines = logged.copy()
    logged.clear()
    return lines


@pytest.mark.parametrize("address", PAGES)
def test_no_text_is_cut_covered_or_outside(look: tuple[Page, list[str]], address: str) -> None:
    page, logged = look
    go(page, address)
    assert at_every_size(page) + taken(logged) == []


def test_pages_that_are_opened_again_know_what_was_fetched_before(look: tuple[Page, list[str]]) -> None:
    """Nothing may depend on being there before its page has asked for it."""
    page, logged = look
    go(page, "home")
    for address in (*PAGES, *PAGES):
        page.evaluate(f"location.hash = '#/{address}'")
        page.wait_for_selector(f"main[data-page={address.partition('/')[0].partition('?')[0]}]")
        page.wait_for_load_state("networkidle")
        settled(page)
    assert logged == []


def name_asked_for(page: Page) -> None:
    page.get_by_role("button", name="Button: mx-clear").click()
    page.get_by_role("menuitem", name="Copy…").click()
    expect(page.get_by_role("dialog")).to_be_visible()


def menu_of(name: str) -> Callable[[Page], None]:
    def opened(page: Page) -> None:
        page.get_by_role("button", name=name, exact=True).first.click()
        expect(page.get_by_role("menu")).to_be_visible()

    return opened


def keys(page: Page) -> None:
    page.get_by_role("button", name="Keys").click()
    expect(page.get_by_role("complementary", name="Keys")).to_be_visible()


def term(page: Page) -> None:
    page.locator("button.term").first.press("Shift")
    page.locator("button.term").first.hover()
    expect(page.get_by_role("tooltip")).to_be_visible()


def tour(page: Page) -> None:
    page.get_by_role("button", name="Take the tour").click()
    expect(page.get_by_role("dialog")).to_contain_text("How a button feels")


def tab(name: str) -> Callable[[Page], None]:
    def opened(page: Page) -> None:
        page.get_by_role("tab", name=name, exact=True).click()
        page.wait_for_load_state("networkidle")

    return opened


OPEN: dict[str, tuple[str, Callable[[Page], None]]] = {
    "the menu of a row": ("library", menu_of("Actions for mx-clear")),
    "the menu of the button": ("edit/builtin:mx-clear", menu_of("Button: mx-clear")),
    "the menu of exports": ("edit/builtin:mx-clear", menu_of("Export")),
    "a name asked for": ("edit/builtin:mx-clear", name_asked_for),
    "the list of keys": ("edit/builtin:mx-clear", keys),
    "the meaning of a term": ("library?over=builtin%3Amx-clear", term),
    "the tour": ("home", tour),
    "what is known of a button": ("library?over=builtin%3Amx-clear", tab("About")),
    **{
        f"the tab {name}": ("edit/builtin:mx-clear", tab(name))
        for name in ("Figures", "Assign", "Vibration", "Surface", "Steps")
    },
}
"""What can be opened: where, and how."""


@pytest.mark.parametrize("what", OPEN)
def test_what_is_open_is_whole(look: tuple[Page, list[str]], what: str) -> None:
    page, logged = look
    address, how = OPEN[what]

    def opened(page: Page) -> None:
        go(page, address)
        how(page)

    assert at_every_size(page, opened) + taken(logged) == []


def test_opened_files_are_whole(look: tuple[Page, list[str]], tmp_path: Path) -> None:
    page, _ = look
    files = [write_cycle(tmp_path / f"A switch with a rather long name, number {n}.csv") for n in (1, 2)]
    (tmp_path / "no-button.csv").write_text("a,b\n1,2\n")

    def opened(page: Page) -> None:
        go(page, "home")
        expect(drop(page, *files, tmp_path / "no-button.csv").get_by_role("article")).to_have_count(3)

    assert at_every_size(page, opened) == []


def test_work_on_a_rig_is_whole_while_it_runs_and_when_it_is_done(look: tuple[Page, list[str]]) -> None:
    page, logged = look
    go(page, "live/compensate")
    page.get_by_role("button", name="Start", exact=True).click()
    verdict = page.get_by_role("region", name="Verdict")
    expect(verdict).to_contain_text(re.compile("press [2-9]"), timeout=90_000)
    found = at_every_size(page)
    expect(verdict).to_contain_text("Mean error", timeout=150_000)
    page.wait_for_load_state("networkidle")
    found += at_every_size(page)
    assert found + taken(logged) == []


def test_an_optimisation_is_whole_while_it_runs_and_when_it_is_done(look: tuple[Page, list[str]]) -> None:
    page, logged = look
    go(page, "optimize")
    page.get_by_role("radio", name="A simulated person plays").click()
    page.get_by_role("button", name="Begin", exact=True).click()
    verdict = page.get_by_role("region", name="Verdict")
    expect(verdict).to_contain_text("A simulated person plays")
    found = at_every_size(page)
    expect(verdict).to_contain_text("(95 %", timeout=240_000)
    page.wait_for_load_state("networkidle")
    found += at_every_size(page)
    assert found + taken(logged) == []


def test_a_study_is_whole_with_its_form_and_before_it_is_frozen(look: tuple[Page, list[str]]) -> None:
    page, logged = look
    go(page, "studies")
    page.get_by_label("Name").fill("which-of-two-clicks-more")
    page.get_by_role("button", name="Create").click()
    expect(page.get_by_text("No problems found.")).to_be_visible()

    def asked(page: Page) -> None:
        page.keyboard.press("Escape")
        page.get_by_role("button", name="Freeze the study").click()
        expect(page.get_by_role("alertdialog")).to_be_visible()

    assert at_every_size(page) + at_every_size(page, asked) + taken(logged) == []


def asked(page: Page, name: str, /, **question: object) -> dict[str, object]:
    """Ask the studio as its page does."""
    found = page.evaluate(
        """async ([name, question]) => (await fetch(`./api/studies.${name}`, {method: "POST",
        headers: {"content-type": "application/json"}, body: JSON.stringify(question)})).json()""",
        [name, question],
    )
    assert "error" not in found, found
    return dict(found)


def seated(page: Page, study: str, text: str) -> Timer:
    """Return somebody who sat down in a new timing study, before the first page of it."""
    asked(page, "create", name=study, template="timing")
    asked(page, "write", study=study, text=text, keep=True)
    asked(page, "freeze", study=study, passphrase="correct horse battery staple")
    seat = asked(page, "seat", study=study)["seat"]
    timer = Timer(page.context.new_page())
    record(timer.page)
    timer.page.goto(f"{page.url.partition('#')[0].partition('?')[0]}?seat={seat}#/study/{study}")
    timer.page.click(".study-main .button.main")
    timer.page.click(".study-main .button.main")  # the card is noted
    timer.page.evaluate(PRESS_WHEN_SEEN)
    return timer


def test_the_screens_of_a_timing_study_are_whole(look: tuple[Page, list[str]]) -> None:
    page, logged = look
    go(page, "home")
    timer = seated(page, "trained", timing_text(1, 2, gap_days=7.0))
    screen = timer.page
    screen.wait_for_selector("h1:has-text('Before we begin')")
    found = at_every_size(screen)
    timer.agree()
    screen.wait_for_selector(".timed .button.main:focus")
    found += at_every_size(screen)
    timer.begin()
    screen.keyboard.press("Escape")
    screen.wait_for_selector(".line >> text=You paused")
    found += at_every_size(screen)
    screen.keyboard.press("Enter")
    screen.wait_for_selector("h1:has-text('The first part is done')")
    found += at_every_size(screen)
    go(page, "studies/trained")
    expect(page.locator("tr[data-person=P01]")).to_contain_text("due from")
    found += at_every_size(page)
    screen.close()
    assert found + taken(logged) == []


def test_what_lies_on_the_table_is_asked_for_on_a_whole_screen(look: tuple[Page, list[str]]) -> None:
    page, logged = look
    go(page, "home")
    timer = seated(page, "untrained", timing_text(0, 2))
    timer.agree()
    timer.page.wait_for_selector(STEP)
    while not timer.page.locator(".study-sheet[data-key=F13]").count():
        timer.prepare()
        at = timer.page.inner_text(".study-at")
        timer.begin()
        timer.page.wait_for_selector(f".study-at:not(:has-text('{at}'))", timeout=30_000)
        timer.page.wait_for_selector(STEP)
    found = at_every_size(timer.page)

    def mistaken(_page: Page) -> None:
        timer.hit("Space")
        expect(timer.page.locator(".other")).to_contain_text("does not count")

    found += at_every_size(timer.page, mistaken)
    timer.place()
    found += at_every_size(timer.page)
    timer.page.close()
    assert found + taken(logged) == []


@pytest.mark.parametrize("kind", PLANTED)
def test_a_planted_fault_is_found(look: tuple[Page, list[str]], kind: str) -> None:
    page, _ = look
    go(page, "home")
    page.wait_for_selector(".card polyline")
    page.evaluate(PLANT, PLANTED[kind])
    found = faults(page)
    page.evaluate("document.getElementById('planted').remove()")
    assert any(line.startswith(kind) for line in found)
    assert faults(page) == []


def test_a_word_that_a_plot_cuts_is_found(look: tuple[Page, list[str]]) -> None:
    page, _ = look
    go(page, "home")
    page.wait_for_selector(".card polyline")
    page.evaluate(DRAWN)
    found = faults(page)
    page.evaluate("document.getElementById('planted').remove()")
    assert len(found) == 1
    assert found[0].startswith('cut in a plot: "beyond its edge"')


def test_axe_sees_a_planted_fault(look: tuple[Page, list[str]]) -> None:
    page, _ = look
    go(page, "home")
    page.evaluate("document.querySelector('main').append(document.createElement('button'))")
    assert any("button-name" in line for line in audit(page))
