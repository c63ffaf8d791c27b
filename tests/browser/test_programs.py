"""The program builder, driven as a person does: by mouse, by keys, across a reload."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv.model.file import load_builtin
from fdvv.program.file import load_program
from fdvv.program.library import load_shipped
from fdvv.program.surface import of_model
from tests.browser.accessibility import audit
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Locator, Page

KEPT = "programs/mx-red.fdvv-program.json"


@pytest.fixture
def gallery(page: Page, studio: RunningStudio) -> Page:
    """The programs page of an empty project."""
    page.goto(f"{studio.base}/#/programs")
    page.wait_for_selector("article[aria-label='mx-red']")
    return page


@pytest.fixture
def own(gallery: Page) -> Iterator[Page]:
    """A copy of the shipped program `button`, open to be edited."""
    card = gallery.locator("article", has=gallery.get_by_role("link", name="button", exact=True))
    card.get_by_role("button", name="Copy and edit").click()
    gallery.wait_for_selector(".verdict.good")
    yield gallery
    # what a test leaves unsaved would be asked about when the page closes
    gallery.locator(".save-state.saved, .save-state.refused").wait_for()


def state(page: Page, name: str) -> Locator:
    return page.locator(f".node[data-state='{name}']")


def saved(page: Page) -> None:
    page.locator(".save-state.saved").wait_for()


def edited(page: Page) -> None:
    """Wait until an edit that is seen has been written: there is something to undo, and nothing to save."""
    page.get_by_role("button", name="Undo", exact=True).and_(page.locator(":enabled")).wait_for()
    saved(page)


def middle(found: Locator) -> tuple[float, float]:
    box = found.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_every_shipped_program_opens_with_its_graph_and_is_accepted(
    gallery: Page, studio: RunningStudio
) -> None:
    names = gallery.eval_on_selector_all("article h3 a", "links => links.map(a => a.textContent)")
    assert len(names) == 7
    for name in names:
        gallery.goto(f"{studio.base}/#/programs/shipped:{name}")
        gallery.get_by_role("heading", level=1, name=load_shipped(name).name, exact=True).wait_for()
        gallery.wait_for_selector(".verdict.good")
        expect(gallery.locator(".node")).to_have_count(len(load_shipped(name).states))
        gallery.locator(".node.start").wait_for()
    assert not gallery.locator(".save-state.saved").count()


def test_a_state_and_its_ways_are_drawn_by_mouse_checked_saved_and_there_after_a_reload(
    own: Page, studio: RunningStudio, tmp_path: Path
) -> None:
    frame = own.locator("svg.graph").bounding_box()
    assert frame is not None
    own.mouse.dblclick(frame["x"] + frame["width"] / 2, frame["y"] + frame["height"] - 40)
    finding = own.locator(".findings .refused", has_text="no way leads to it")
    finding.wait_for()
    assert "add a transition to it" in finding.inner_text()

    state(own, "up").click()
    finding.locator("button").click()
    assert state(own, "state").get_attribute("aria-pressed") == "true"

    for begin, end in (("down", "state"), ("state", "up")):
        state(own, begin).click()
        x, y = middle(state(own, begin).locator(".handle"))
        own.mouse.move(x, y)
        own.mouse.down()
        own.mouse.move(x + 5, y + 30, steps=3)
        own.mouse.move(*middle(state(own, end)), steps=5)
        own.mouse.up()
        own.locator(f".words[data-state='{begin}'][aria-pressed=true]").wait_for()
    own.wait_for_selector(".verdict.good")
    edited(own)

    own.reload()
    own.wait_for_selector(".verdict.good")
    expect(own.locator(".node")).to_have_count(3)
    kept = load_program(tmp_path / "project" / KEPT)
    assert [s.name for s in kept.states] == ["up", "down", "state"]
    assert [t.to for t in kept.state("down").transitions] == ["up", "state"]
    assert [t.to for t in kept.state("state").transitions] == ["up"]


def test_a_state_and_its_ways_are_made_by_keys_alone(own: Page, tmp_path: Path) -> None:
    state(own, "down").focus()
    own.keyboard.press("Enter")
    own.keyboard.press("n")
    state(own, "state").wait_for()
    # back to `down`, begin a way there, walk to the new state, end it
    state(own, "down").focus()
    own.keyboard.press("Enter")
    own.keyboard.press("t")
    own.get_by_text("Where does it lead").wait_for()
    state(own, "state").focus()
    own.keyboard.press("Enter")
    own.locator(".words[data-state='down'][aria-pressed=true]").wait_for()
    value = own.get_by_label("When shallower than, mm")
    value.fill("0.7")
    value.press("Enter")
    own.locator(".words", has_text="x < 0.7 mm").wait_for()
    edited(own)
    kept = load_program(tmp_path / "project" / KEPT)
    assert str(kept.state("down").transitions[1]) == "shallower than 0.7 mm → state"
    own.locator(".words", has_text="x < 0.7 mm").focus()
    own.keyboard.press("Delete")
    own.locator(".words", has_text="x < 0.7 mm").wait_for(state="detached")


def test_a_planted_fault_is_listed_located_and_undone(own: Page) -> None:
    own.locator(".words[data-state='down']").click()
    own.get_by_role("button", name="Remove transition").click()
    finding = own.locator(".findings .refused button")
    finding.wait_for()
    assert "nothing is sure to lead on to the start state" in finding.inner_text()
    state(own, "up").click()
    finding.click()
    assert state(own, "down").get_attribute("aria-pressed") == "true"
    own.keyboard.press("Control+z")
    own.wait_for_selector(".verdict.good")
    own.keyboard.press("Control+Shift+z")
    own.wait_for_selector(".verdict.warning")
    own.get_by_role("button", name="Undo").click()
    own.wait_for_selector(".verdict.good")


def test_a_point_of_the_forces_is_pulled_by_mouse_and_nudged_by_keys(own: Page, tmp_path: Path) -> None:
    before = load_shipped("button").surface("press")
    force = own.get_by_label("force", exact=True)
    first = force.input_value()
    plot = own.locator(".forces .curves")
    plot.focus()
    own.keyboard.press("ArrowRight")
    expect(force).not_to_have_value(first)
    at, start = own.get_by_label("Point at").input_value(), float(force.input_value())
    own.keyboard.press("Shift+ArrowUp")
    edited(own)
    assert float(force.input_value()) == pytest.approx(start + 10, abs=1e-3)
    kept = load_program(tmp_path / "project" / KEPT).surface("press")
    column = kept.displacement_mm.index(float(at))
    assert kept.force_cN[0][column] == pytest.approx(before.force_cN[0][column] + 10, abs=1e-3)


def test_a_program_is_pressed_as_it_is_edited_and_the_graph_tells_its_state(own: Page) -> None:
    own.get_by_role("tab", name="Press it").click()
    own.locator(".node.live[data-state='up']").wait_for()
    view = own.locator(".press-view")
    view.focus()
    own.keyboard.down("Space")
    own.locator(".node.live[data-state='down']").wait_for()
    own.keyboard.up("Space")
    own.locator(".node.live[data-state='up']").wait_for()
    # a state renamed is under the finger as soon as it is checked
    state(own, "up").click()
    name = own.get_by_label("Name", exact=True)
    name.fill("at rest")
    name.press("Enter")
    own.locator(".node.live[data-state='at rest']").wait_for()
    own.get_by_role("tab", name="Forces").click()
    own.locator(".node.live").wait_for(state="detached")


def test_the_forces_of_another_button_are_taken(own: Page, tmp_path: Path) -> None:
    own.locator("summary", has_text="take from a button").click()
    own.get_by_label("Button", exact=True).select_option("builtin:mx-clear")
    own.get_by_role("button", name="Make a copy").click()
    own.get_by_role("button", name="Take its forces").click()
    wanted = of_model(load_builtin("mx-clear"), "press")
    expect(own.locator(".point-values input").nth(1)).to_have_value(f"{wanted.force_cN[0][0]:g}")
    edited(own)
    own.get_by_label("Map").check()
    own.get_by_role("img", name="over displacement and velocity").wait_for()
    kept = load_program(tmp_path / "project" / KEPT)
    assert kept.surface(kept.state("up").press).force_cN == wanted.force_cN
    assert kept.surface(kept.state("down").press) == load_shipped("button").surface("press")


def test_what_another_tab_saved_is_not_overwritten(own: Page, context: BrowserContext) -> None:
    other = context.new_page()
    other.goto(own.url)
    other.wait_for_selector(".verdict.good")
    for page in (own, other):
        page.bring_to_front()
        state(page, "up").focus()
        page.keyboard.press("n")
        if page is own:
            edited(page)
    other.locator(".save-state.refused", has_text="changed elsewhere").wait_for()
    other.get_by_role("button", name="Save as").click()
    other.wait_for_url("**/own%3Amx-red%202*")
    saved(other)
    other.close()


def test_a_recipe_makes_a_program_at_once(gallery: Page, tmp_path: Path) -> None:
    card = gallery.locator("article", has=gallery.get_by_role("link", name="fast-tapping", exact=True))
    card.get_by_text("Create from parameters").click()
    recipe = card.get_by_role("group", name="Recipe fast-tapping")
    recipe.get_by_label("Pull").fill("44")
    recipe.get_by_label("Pull").press("Enter")
    recipe.get_by_role("button", name="Create").click()
    gallery.wait_for_selector(".verdict.good")
    kept = load_program(tmp_path / "project" / "programs" / "fast-tapping.fdvv-program.json")
    assert kept.surface("pull").force_cN[0][0] == -44


def test_a_file_is_uploaded_and_a_broken_one_refused_in_one_line(gallery: Page, tmp_path: Path) -> None:
    bad = tmp_path / "bad.json"
    bad.write_text(json.dumps({"format": "fdvv-program", "version": 1, "name": "bad"}))
    gallery.set_input_files("main input[type=file]", bad)
    toast = gallery.locator(".toast.wrong")
    toast.wait_for()
    assert "travel_mm" in toast.inner_text()
    huge = tmp_path / "huge.json"
    huge.write_text(" " * 2_000_001)
    gallery.set_input_files("main input[type=file]", huge)
    gallery.locator(".toast.wrong", has_text="larger than 2 MB").wait_for()

    good = (
        Path(__file__).resolve().parents[2]
        / "packages/fdvv/src/fdvv/program/library/rapid-trigger.fdvv-program.json"
    )
    gallery.set_input_files("main input[type=file]", good)
    gallery.wait_for_selector(".verdict.good")
    with gallery.expect_download() as export:
        gallery.get_by_role("button", name="Export file").click()
    assert Path(export.value.path()).read_bytes() == good.read_bytes()


def test_a_deleted_program_is_taken_back(own: Page, studio: RunningStudio) -> None:
    saved(own)
    own.goto(f"{studio.base}/#/programs")
    card = own.locator("article", has=own.get_by_role("link", name="mx-red", exact=True))
    card.get_by_role("button", name="Delete").click()
    card.wait_for(state="detached")
    own.locator(".toast").get_by_role("button", name="Undo").click()
    card.wait_for()
    card.get_by_role("button", name="Open").click()
    own.wait_for_selector(".verdict.good")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_nobody_is_kept_out(page: Page, studio: RunningStudio, theme: str) -> None:
    """Nothing that axe-core calls serious, in the gallery and in the builder, whatever is chosen."""
    page.emulate_media(color_scheme=theme)  # type: ignore[arg-type]
    page.goto(f"{studio.base}/#/programs")
    page.get_by_text("Create from parameters").first.click()
    assert audit(page) == []
    page.goto(f"{studio.base}/#/programs/shipped:dwell-ticks")
    page.wait_for_selector(".verdict.good")
    for choose in (".node.start", ".words", ".toolbar :text('Program')", ".ways :text('tick')"):
        page.locator(choose).first.click()
        assert audit(page) == []
