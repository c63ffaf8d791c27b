"""The editor, driven by a real mouse and real keys."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import expect

from fdvv.model.bump import find_bump
from fdvv.model.curve import ForceCurve
from fdvv.model.file import load_builtin, load_model
from fdvv.model.model import FDVVModel
from tests.browser.editing import FORCE, drag, number, scales

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page

POINT = 5
"""The sixth control point of MX Clear's slowest press: 1.4 mm, 66.1146 cN."""


def opened(page: Page, button: str) -> Page:
    page.evaluate(f"location.hash = '#/edit/' + encodeURIComponent('{button}')")
    page.wait_for_selector(".edit-points")
    page.wait_for_selector(".edit-follows", timeout=30_000)
    return page


@pytest.fixture
def editor(page: Page) -> Page:
    """The editor with MX Clear."""
    return opened(page, "builtin:mx-clear")


def cell(page: Page, row: int, column: int = FORCE) -> str:
    return page.locator(".edit-points tbody tr").nth(row).locator("td").nth(column).inner_text()


def force_cN(page: Page, row: int = POINT) -> float:
    return number(cell(page, row))


def saved(page: Page) -> None:
    expect(page.locator(".edit-saved")).to_have_text("saved")


def own_model(project: Path) -> FDVVModel:
    files = list((project / "buttons").glob("*.fdvv.json"))
    assert len(files) == 1
    return load_model(files[0])


def slowest(model: FDVVModel) -> ForceCurve:
    return model.of("press")[0]


def test_a_point_dragged_with_the_mouse_is_one_step_and_is_there_after_a_reload(
    editor: Page, tmp_path: Path
) -> None:
    to_screen, before = scales(editor), slowest(load_builtin("mx-clear"))
    x_mm, y_cN = before.control_points_mm[POINT], before.control_points_cN[POINT]
    start, end = to_screen(x_mm, y_cN), to_screen(x_mm, y_cN + 12)
    drag(editor, start, (0.0, end[1] - start[1]))
    assert force_cN(editor) == pytest.approx(y_cN + 12, abs=0.5)
    others = [i for i in range(before.control_points_cN.size) if i != POINT]
    assert [force_cN(editor, i) for i in others] == pytest.approx(before.control_points_cN[others], abs=1e-4)
    saved(editor)
    after = force_cN(editor)
    assert "own%3A" in editor.url
    kept = slowest(own_model(tmp_path / "project"))
    assert kept.control_points_cN[POINT] == pytest.approx(after, abs=1e-4)
    editor.reload()
    editor.wait_for_selector(".edit-points")
    assert force_cN(editor) == after
    editor.keyboard.press("Control+z")
    assert force_cN(editor) == pytest.approx(y_cN, abs=1e-4)
    assert editor.locator("button[aria-label=Undo]").is_disabled()


def test_fifty_steps_by_keys_are_undone_to_the_number_they_began_at(editor: Page) -> None:
    editor.keyboard.press("c")
    editor.keyboard.press("Home")
    for _ in range(POINT):
        editor.keyboard.press("ArrowRight")
    at = force_cN(editor)
    for i in range(50):
        editor.keyboard.press(("ArrowUp", "Shift+ArrowUp", "Alt+ArrowDown", "ArrowDown")[i % 4])
    assert force_cN(editor) != at
    editor.click("role=tab[name=Steps]")
    expect(editor.locator(".edit-step")).to_have_count(51)
    editor.click("role=tab[name=Points]")
    for _ in range(50):
        editor.keyboard.press("Control+z")
    assert force_cN(editor) == at
    for _ in range(50):
        editor.keyboard.press("Control+y")
    editor.click("role=tab[name=Steps]")
    editor.locator(".edit-step").last.click()
    editor.click("role=tab[name=Points]")
    assert force_cN(editor) == at


def test_an_exact_number_is_typed_into_the_table_and_kept_to_the_last_digit(
    editor: Page, tmp_path: Path
) -> None:
    editor.locator(".edit-points tbody tr").nth(POINT).locator("td").nth(FORCE).click()
    editor.keyboard.type("61.23456789")
    editor.keyboard.press("Enter")
    editor.keyboard.type("nonsense")
    assert cell(editor, POINT) == "61.2346"
    saved(editor)
    assert slowest(own_model(tmp_path / "project")).control_points_cN[POINT] == 61.23456789
    focused = editor.evaluate(
        "[...document.activeElement.closest('tr').parentElement.children]"
        ".indexOf(document.activeElement.closest('tr'))"
    )
    assert focused == POINT + 1


def test_the_peak_moves_with_the_hand_and_escape_gives_the_drag_up(editor: Page) -> None:
    editor.click("role=tab[name=Figures]")
    peak = editor.locator(".edit-figures tr", has_text="Peak").first.locator("td").first
    was = number(peak.inner_text())
    to_screen, curve = scales(editor), slowest(load_builtin("mx-clear"))
    x, y = to_screen(curve.control_points_mm[POINT], curve.control_points_cN[POINT])
    editor.mouse.move(x, y)
    editor.mouse.down()
    editor.mouse.move(x, y - 40)
    assert number(peak.inner_text()) > was + 2
    editor.keyboard.press("Escape")
    assert number(peak.inner_text()) == was
    editor.mouse.up()
    assert editor.locator("button[aria-label=Undo]").is_disabled()


def test_a_place_of_the_travel_is_moved_by_the_mouse_and_by_keys(editor: Page) -> None:
    actuation = editor.locator("[role=slider][aria-label='Actuation point']")
    to_screen = scales(editor)
    box = actuation.bounding_box()
    assert box is not None
    grip = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    drag(editor, grip, (to_screen(1.5, 0)[0] - to_screen(2.0, 0)[0], 0.0))
    assert float(actuation.get_attribute("aria-valuenow") or "nan") == pytest.approx(1.5, abs=0.02)
    before = float(actuation.get_attribute("aria-valuenow") or "nan")
    actuation.focus()
    editor.keyboard.press("ArrowRight")
    assert float(actuation.get_attribute("aria-valuenow") or "nan") == pytest.approx(before + 0.05, abs=1e-6)


def test_points_are_boxed_added_and_removed(editor: Page) -> None:
    to_screen = scales(editor)
    drag(editor, to_screen(0.7, 52), tuple(np.subtract(to_screen(1.5, 75), to_screen(0.7, 52))))
    selected = editor.locator(".edit-points tr[aria-selected=true]")
    expect(selected).to_have_count(3)
    rows = editor.locator(".edit-points tbody tr")
    count = rows.count()
    editor.keyboard.press("Delete")
    expect(rows).to_have_count(count - 3)
    editor.mouse.dblclick(*to_screen(3.3, 20))
    expect(rows).to_have_count(count - 2)
    for _ in range(2):
        editor.keyboard.press("Control+z")
    expect(rows).to_have_count(count)


def test_what_the_rig_makes_of_it_follows_the_hand_and_says_where_it_cannot(editor: Page) -> None:
    assert editor.locator(".edit-follows").inner_text() == "can follow"
    assert "simulated" in editor.locator(".edit-verdict select option:checked").inner_text()
    editor.keyboard.press("c")
    editor.keyboard.press("Control+a")
    for _ in range(45):
        editor.keyboard.press("Shift+ArrowUp")
    expect(editor.locator(".edit-follows")).to_have_text("cannot")
    expect(editor.locator(".edit-verdict")).to_contain_text("the limit is 440")
    for _ in range(45):
        editor.keyboard.press("Control+z")
    expect(editor.locator(".edit-follows")).to_have_text("can follow")


def nudge(page: Page) -> None:
    page.keyboard.press("c")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowUp")


def cut(page: Page) -> None:
    """Let no change reach the studio."""
    page.route("**/api/document.change", lambda route: route.abort())


def test_two_tabs_follow_each_other(editor: Page, context: BrowserContext) -> None:
    nudge(editor)
    saved(editor)
    other = context.new_page()
    other.goto(editor.url)
    other.wait_for_selector(".edit-points")
    at = force_cN(editor, 0)
    assert force_cN(other, 0) == at
    nudge(other)
    expect(editor.locator(".edit-points tbody tr").first.locator("td").nth(FORCE)).to_have_text(
        cell(other, 0)
    )
    assert force_cN(editor, 0) == at + 1


def test_a_conflict_of_two_tabs_is_put_to_the_person(editor: Page, context: BrowserContext) -> None:
    nudge(editor)
    saved(editor)
    other = context.new_page()
    other.goto(editor.url)
    other.wait_for_selector(".edit-points")
    cut(other)
    nudge(other)
    expect(other.locator(".edit-saved")).to_have_text("not saved yet, retrying")
    mine = force_cN(other, 0)
    nudge(editor)
    nudge(editor)
    saved(editor)
    other.unroute("**/api/document.change")
    expect(other.locator(".edit-conflict")).to_contain_text("another tab edited this button")
    assert force_cN(other, 0) == mine
    other.click("text=Keep mine as a copy")
    expect(other.locator("h1")).to_contain_text("mine")
    assert force_cN(other, 0) == mine
    assert force_cN(editor, 0) == mine + 1


def test_a_curve_is_copied_to_another_speed_and_assigned_by_parts(editor: Page, tmp_path: Path) -> None:
    editor.get_by_label("Copy to", exact=True).fill("120")
    editor.keyboard.press("Enter")
    expect(editor.locator(".edit-curves tbody tr")).to_have_count(6)
    editor.click("role=tab[name=Assign]")
    editor.get_by_label("Curve", exact=True).select_option("press@200")
    editor.get_by_label("Stroke", exact=True).select_option("press")
    editor.get_by_label("Only a part of the travel").check()
    editor.click("text=Assign the part")
    saved(editor)
    kept = own_model(tmp_path / "project")
    assert kept.velocities_mm_s("press") == (0.5, 50.0, 100.0, 120.0, 150.0, 200.0)
    assert "assigned from press at 200 mm/s" in kept.provenance.method


def test_a_curve_of_another_button_is_found_by_name_and_assigned(editor: Page, tmp_path: Path) -> None:
    editor.click("role=tab[name=Assign]")
    editor.get_by_label("Another button").fill("mx-red")
    editor.locator(".edit-pick li button", has_text="mx-red").first.click()
    expect(editor.get_by_label("Curve", exact=True)).to_have_value("press@unknown")
    editor.get_by_label("Stroke", exact=True).select_option("press")
    editor.get_by_label("Speed").last.fill("100")
    editor.keyboard.press("Enter")
    editor.click("text=Assign the curve")
    saved(editor)
    taken = own_model(tmp_path / "project").nearest("press", 100.0)
    red = slowest(load_builtin("mx-red"))
    assert taken is not None
    np.testing.assert_array_equal(taken.control_points_cN, red.control_points_cN)


def test_two_fingers_zoom_and_one_pans_without_an_edit(editor: Page) -> None:
    to_screen = scales(editor)
    (x, y), (far, _) = to_screen(1.0, 5.0), to_screen(3.0, 5.0)
    fingers = editor.context.new_cdp_session(editor)

    def touch(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": px, "y": py, "id": i} for i, (px, py) in enumerate(places)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (x, y), (far, y))
    for part in (0.25, 0.5):
        touch("touchMove", (x - part * (far - x), y), (far, y))
    touch("touchEnd")
    zoomed = scales(editor)
    assert zoomed(3.0, 0.0)[0] - zoomed(1.0, 0.0)[0] == pytest.approx(1.5 * (far - x), rel=0.02)
    touch("touchStart", (x, y))
    touch("touchMove", (x + 60, y))
    touch("touchEnd")
    assert scales(editor)(1.0, 0.0)[0] - zoomed(1.0, 0.0)[0] == pytest.approx(60, abs=2)
    assert editor.locator("button[aria-label=Undo]").is_disabled()
    editor.keyboard.press("f")
    assert scales(editor)(1.0, 0.0) == pytest.approx(to_screen(1.0, 0.0), abs=1)


def test_a_vibration_is_shaped_by_number_and_the_surface_is_drawn(editor: Page, tmp_path: Path) -> None:
    editor.click("role=tab[name=Vibration]")
    editor.get_by_label("frequency of mode 1, Hz").fill("321.5")
    editor.keyboard.press("Enter")
    saved(editor)
    model = own_model(tmp_path / "project")
    assert next(v for v in model.vibrations if v.stroke == "press").modes[0].frequency_Hz == 321.5
    editor.click("role=tab[name=Surface]")
    canvas = editor.locator(".edit-surface")
    canvas.wait_for()
    before = canvas.screenshot()
    canvas.focus()
    editor.keyboard.press("ArrowRight")
    editor.keyboard.press("ArrowUp")
    for _ in range(50):
        if canvas.screenshot() != before:
            break
    assert canvas.screenshot() != before


def test_constraints_hold_while_a_point_is_moved(editor: Page) -> None:
    editor.get_by_label("Never falls").check()
    editor.keyboard.press("c")
    editor.keyboard.press("Home")
    editor.keyboard.press("Shift+ArrowDown")
    forces = [force_cN(editor, row) for row in range(editor.locator(".edit-points tbody tr").count())]
    assert forces == sorted(forces)
    editor.keyboard.press("Control+z")
    editor.get_by_label("Never falls").uncheck()
    editor.get_by_label("Keep the work").check()
    editor.click("role=tab[name=Figures]")
    work = editor.locator(".edit-figures tr", has_text="Work of the press").locator("td").first
    was = work.inner_text()
    editor.keyboard.press("c")
    editor.keyboard.press("Shift+ArrowUp")
    assert work.inner_text() == was
    assert number(
        editor.locator(".edit-figures tr", has_text="Peak").first.locator("td").last.inner_text() or "0"
    )


def test_the_editor_says_what_the_button_is_like_and_leads_on_to_pressing_it(editor: Page) -> None:
    verdict = editor.get_by_role("region", name="Verdict")
    expect(verdict).to_contain_text(
        "mx-clear falls by 13.3 cN after its peak of 64.7 cN, actuates at 2.00 mm"
    )
    nudge(editor)
    saved(editor)
    verdict.get_by_role("link", name="Press it").click()
    expect(editor).to_have_url(re.compile("#/press/own%3Amx-clear%202"))


def test_the_model_and_its_curves_are_taken_away_as_files(editor: Page, tmp_path: Path) -> None:
    def taken(name: str) -> Path:
        editor.click("role=button[name='Export']")
        with editor.expect_download() as waiting:
            editor.click(f"role=menuitem[name='{name}']")
        path = tmp_path / waiting.value.suggested_filename
        waiting.value.save_as(path)
        return path

    assert load_model(taken("Model file")) == load_builtin("mx-clear")
    rows = taken("Curves, CSV").read_text().splitlines()
    assert rows[0].split(",")[0] == "press_0.5_mm_s_displacement_mm"
    assert number(rows[1].split(",")[1]) == pytest.approx(2.952)
    assert taken("View, SVG").read_text().count("<path") > 20
    assert taken("View, PNG").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "mx-clear.fdvv.json").read_text())["format"] == "fdvv-model"


def test_the_same_state_may_be_pinned_twice(editor: Page) -> None:
    editor.click("role=tab[name=Steps]")
    pins = editor.get_by_role("button", name=re.compile("^pin"))
    for count in (1, 2):
        editor.click("role=button[name='Pin the current state']")
        expect(pins).to_have_count(count)
    editor.get_by_role("button", name="Forget pin 1").click()
    expect(pins).to_have_count(1)


def test_escape_closes_found_buttons_only_where_they_are_searched(editor: Page) -> None:
    editor.click("role=tab[name=Assign]")
    found = editor.get_by_role("list", name="Matching buttons").first.get_by_role("button")
    editor.get_by_role("searchbox").first.fill("clear")
    expect(found).not_to_have_count(0)
    editor.locator("role=tab[name=Assign]").press("Escape")
    expect(found).not_to_have_count(0)
    editor.get_by_role("searchbox").first.press("Escape")
    expect(found).to_have_count(0)


def test_a_slider_drags_the_whole_button_as_one_step(editor: Page, tmp_path: Path) -> None:
    """Lighter with the same bump, by mouse; longer, by the keyboard."""
    before = load_builtin("mx-clear")
    slider = editor.get_by_label("Force, same bump")
    box = slider.bounding_box()
    assert box is not None
    y = box["y"] + box["height"] / 2
    editor.mouse.move(box["x"] + box["width"] / 2, y)
    editor.mouse.down()
    for part in (0.45, 0.4, 0.35):
        editor.mouse.move(box["x"] + part * box["width"], y)
    editor.mouse.up()
    undo = editor.get_by_role("button", name=re.compile(r"^Undo: all curves: force ×0\.\d+, same bump$"))
    expect(undo).to_be_enabled()
    expect(slider).to_have_value("100")
    saved(editor)
    lighter = own_model(tmp_path / "project")
    old, new = (find_bump(x := np.linspace(0.3, 3.9, 400), slowest(m).force_cN(x)) for m in (before, lighter))
    assert old is not None
    assert new is not None
    assert new.peak_cN < 0.95 * old.peak_cN
    assert new.drop_cN == pytest.approx(old.drop_cN, rel=0.15)
    editor.locator(".edit-whole input[type=range]").last.press("ArrowLeft")
    expect(editor.get_by_role("button", name="Undo: stretch the travel to 3.96 mm")).to_be_enabled()
    saved(editor)
    assert own_model(tmp_path / "project").travel_mm == pytest.approx(0.99 * before.travel_mm)


def test_a_drag_moves_every_speed_of_a_stroke_as_one_step(editor: Page, tmp_path: Path) -> None:
    before = load_builtin("mx-clear")
    editor.get_by_label("Drag every speed at once").check()
    to_screen, first = scales(editor), slowest(before)
    x_mm, y_cN = first.control_points_mm[POINT], first.control_points_cN[POINT]
    start, end = to_screen(x_mm, y_cN), to_screen(x_mm, y_cN + 12)
    drag(editor, start, (0.0, end[1] - start[1]))
    expect(editor.get_by_role("button", name=re.compile("^Undo: move"))).to_be_enabled()
    saved(editor)
    after = own_model(tmp_path / "project")
    for old, new in zip(before.of("press"), after.of("press"), strict=True):
        assert np.max(new.control_points_cN - old.control_points_cN) == pytest.approx(12, abs=0.5)
    for old, new in zip(before.of("release"), after.of("release"), strict=True):
        assert new.control_points_cN == pytest.approx(old.control_points_cN)
    editor.keyboard.press("Control+z")
    editor.keyboard.press("e")
    expect(editor.get_by_label("Drag every speed at once")).not_to_be_checked()
    assert force_cN(editor) == pytest.approx(y_cN, abs=1e-4)
