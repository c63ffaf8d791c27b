"""Files that are dropped on the studio, or chosen: looked at, kept, edited, compared, shared."""

from __future__ import annotations

import re
import wave
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from playwright.sync_api import expect

from fdvv.button.export_file import export_vibration
from fdvv.model.file import load_builtin, load_model
from fdvv.program.file import program_to_json
from fdvv.program.library import load_shipped
from tests.browser.accessibility import audit
from tests.browser.dropping import DRAGS, LONG_ms, drag, drop
from tests.support.buttons import write_cycle

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page


def flat(path: Path) -> Path:
    """Write a press that falls nowhere and hardly rises: no button's."""
    rows = "\n".join(f"{x:.2f},{60 + 0.001 * x:.4f}" for x in np.arange(0.0, 4.3, 0.01))
    path.write_text(f"displacement_mm,force_cN\n{rows}\n")
    return path


def test_a_dropped_file_is_one_click_from_the_editor(page: Page, tmp_path: Path) -> None:
    path = write_cycle(tmp_path / "My Switch.csv")
    drag(page, DRAGS[:2], path)
    expect(page.get_by_text("Drop files or folders to open them")).to_be_visible()
    dialog = drop(page, path)
    expect(page.get_by_text("Drop files or folders to open them")).to_be_hidden()
    expect(dialog).to_contain_text("Tactile: the press falls by")
    expect(dialog).to_contain_text("RMSE 0.0")
    expect(dialog.get_by_role("img")).to_have_attribute("aria-label", re.compile("samples and fit"))
    expect(dialog.get_by_label("Name")).to_have_value("My Switch")
    assert not (tmp_path / "project" / "buttons").exists()
    assert audit(page) == []
    dialog.get_by_role("button", name="Keep and edit").click()
    page.wait_for_selector(".edit-points")
    expect(page).to_have_url(re.compile("#/edit/own%3AMy%20Switch"))
    kept = load_model(tmp_path / "project" / "buttons" / "My Switch.fdvv.json")
    assert [str(curve.stroke) for curve in kept.curves] == ["press", "release"]


def test_a_name_that_is_taken_is_refused_beside_it(page: Page, tmp_path: Path) -> None:
    path = write_cycle(tmp_path / "Twice.csv")
    drop(page, path).get_by_role("button", name="Keep and edit").click()
    page.wait_for_selector(".edit-points")
    dialog = drop(page, path)
    name = dialog.get_by_label("Name")
    expect(name).to_have_value("Twice 2")
    name.fill("twice")
    name.press("Enter")
    expect(dialog.get_by_role("alert").filter(has_text="twice")).to_be_visible()
    name.fill("Twice again")
    name.press("Enter")
    expect(page).to_have_url(re.compile("#/edit/own%3ATwice%20again"))


def test_a_folder_is_read_and_what_is_no_button_says_why(page: Page, tmp_path: Path) -> None:
    folder = tmp_path / "bench"
    (folder / "deep").mkdir(parents=True)
    for n, place in enumerate(("A.csv", "deep/B.csv")):
        write_cycle(folder / place, added_cN=10 * n)
    (folder / "deep" / "bad.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    (folder / ".hidden").write_text("nothing")
    dialog = drop(page, folder)
    expect(dialog.get_by_role("status")).to_have_text("2 to look at, 1 cannot be used")
    expect(dialog.get_by_label("Name")).to_have_count(2)
    expect(dialog.get_by_role("article", name="bad.csv")).to_contain_text("no header names a displacement")
    a = dialog.get_by_role("article", name="A.csv")
    a.get_by_role("button", name="Keep", exact=True).click()
    expect(a.get_by_role("link", name="A")).to_be_visible()
    dialog.get_by_role("article", name="B.csv").get_by_role("button", name="Keep and edit").click()
    expect(page).to_have_url(re.compile("#/edit/own%3AB"))
    assert {path.name for path in (tmp_path / "project" / "buttons").glob("*.fdvv.json")} == {
        "A.fdvv.json",
        "B.fdvv.json",
    }


def test_what_cannot_be_a_button_is_read_when_the_person_accepts_it(page: Page, tmp_path: Path) -> None:
    dialog = drop(page, flat(tmp_path / "flat.csv"))
    expect(dialog).to_contain_text("cannot be a button's")
    expect(dialog.get_by_role("button", name="Keep and edit")).to_have_count(0)
    dialog.get_by_label("Accept it all the same").check()
    expect(dialog).to_contain_text("implausible")
    expect(dialog.get_by_role("button", name="Keep and edit")).to_be_visible()


def test_the_two_files_of_a_pair_are_one_button(page: Page, tmp_path: Path) -> None:
    whole = write_cycle(tmp_path / "whole.csv").read_text().splitlines()
    head, rows = whole[0], whole[1:]
    half = len(rows) // 2
    press, release = tmp_path / "Two.downstroke.csv", tmp_path / "Two.upstroke.csv"
    press.write_text("\n".join([head, *rows[:half]]) + "\n")
    release.write_text("\n".join([head, *rows[half:]]) + "\n")
    dialog = drop(page, release, press)
    expect(dialog.get_by_role("article")).to_have_count(1)
    expect(dialog).to_contain_text("release")


def test_more_files_than_a_question_takes_are_asked_in_several(page: Page, tmp_path: Path) -> None:
    folder = tmp_path / "many"
    folder.mkdir()
    for n in range(70):
        (folder / f"no {n:02d}.csv").write_text("text,of,no,kind\n1,2,3,4\n")
    dialog = drop(page, folder)
    expect(dialog.get_by_role("status")).to_have_text("70 cannot be used")
    dialog.get_by_text("70 files cannot be used").click()
    expect(dialog.get_by_role("article")).to_have_count(70)


def test_a_sound_goes_into_the_button_that_is_shown(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "snap.wav"
    path.write_bytes(export_vibration(load_builtin("mx-clear").vibrations[0], "wav", "snap").data)
    dialog = drop(page, path)
    expect(dialog).to_contain_text("open the button that it belongs to")
    page.keyboard.press("Escape")
    page.evaluate("location.hash = '#/edit/builtin%3Amx-red'")
    page.wait_for_selector(".edit-points")
    # two channels: brought to one in the browser
    stereo = tmp_path / "stereo.wav"
    with wave.open(str(path)) as mono, wave.open(str(stereo), "wb") as wide:
        wide.setnchannels(2)
        wide.setsampwidth(2)
        wide.setframerate(mono.getframerate())
        samples = np.frombuffer(mono.readframes(mono.getnframes()), "<i2")
        wide.writeframes(np.repeat(samples, 2).tobytes())
    for sound in (path, stereo):
        dialog = drop(page, sound)
        dialog.get_by_label("Full scale of the sound").fill("50")
        dialog.get_by_role("button", name="Read it").click()
        expect(dialog).to_contain_text("with a vibration of")
        page.keyboard.press("Escape")


def test_a_program_is_kept_with_the_programs(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "mine.fdvv-program.json"
    path.write_text(program_to_json(load_shipped("fast-tapping")))
    drop(page, path).get_by_role("button", name="Keep and edit").click()
    page.wait_for_selector("main[data-page=programs]")
    expect(page).to_have_url(re.compile("#/programs/own%3A"))


def test_two_buttons_are_compared_and_shared_as_one_page(
    page: Page, context: BrowserContext, tmp_path: Path
) -> None:
    base = page.url.partition("#")[0]
    page.goto(f"{base}#/library")
    share = page.get_by_role("button", name="Share", exact=True)
    expect(share).to_be_disabled()
    expect(share).to_have_attribute("title", re.compile("one to six"))
    page.goto(f"{base}#/library?over=builtin%3Amx-clear&over=builtin%3Amx-red")
    expect(page.locator(".lib-chip")).to_have_count(2)
    with page.expect_download() as waiting:
        share.click()
    assert waiting.value.suggested_filename == "mx-clear and mx-red.html"
    text = Path(waiting.value.path()).read_text()
    assert "mx-clear" in text
    assert "mx-red" in text


def test_no_key_of_a_participants_screen_opens_files(page: Page, tmp_path: Path) -> None:
    page.evaluate("location.hash = '#/study'")
    page.wait_for_selector("main[data-page=study]")
    drag(page, DRAGS[:2], write_cycle(tmp_path / "x.csv"))
    expect(page.get_by_text("Drop files or folders to open them")).to_have_count(0)


REAL = (
    ("haata", "Cherry MX Blue.csv"),
    ("bluepylons", "Cherry-MX-Hyperglide-Brown.ods"),
    ("geekboards", "*.json"),
    ("joaoachando", "tf*.json"),
    ("buddyog-topre", ""),
    ("tg-tidy", "data/Cherry MX Blue*.csv"),
)


@pytest.mark.shared
def test_real_files_of_six_sources_are_read_and_kept(page: Page, shared_data: Path, tmp_path: Path) -> None:
    paths = [
        path
        for folder, pattern in REAL
        for path in ((shared_data / folder).glob(pattern) if pattern else [shared_data / folder])
    ]
    assert len(paths) >= len(REAL)
    dialog = drop(page, *paths)
    expect(dialog.get_by_label("Name").first).to_be_visible()
    for title in ("Cherry MX Blue.csv", "Cherry-MX-Hyperglide-Brown.ods", "Holy Panda.json", "tf1s1.json"):
        expect(dialog.get_by_role("article", name=title, exact=True)).to_contain_text("RMSE")
    count = dialog.get_by_label("Name").count()
    dialog.get_by_role("button", name=f"Keep all {count}").click()
    expect(dialog.get_by_text("Kept as")).to_have_count(count, timeout=LONG_ms)
    assert len(list((tmp_path / "project" / "buttons").glob("*.fdvv.json"))) == count
