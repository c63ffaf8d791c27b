"""Long work on the page, driven as a person does: learning, tuning, capturing, looking at a device."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from tests.browser.accessibility import audit
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Locator, Page

LONG_ms = 60_000
DONE = ".job-head .job-state.done"
PRESSES = "table[aria-label='Presses, newest first'] tbody tr"


def opened(page: Page, section: str) -> None:
    page.goto(f"{page.url.partition('#')[0]}#/live/{section}")
    page.wait_for_selector("main[data-page=live]")
    fold = page.locator("form details")
    if section != "device" and not fold.evaluate("fold => fold.open"):
        fold.locator("summary").click()


def verdict(page: Page) -> Locator:
    """What was found, and what to do next."""
    return page.get_by_role("region", name="Verdict")


def set_field(page: Page, label: str, value: str) -> None:
    field = page.get_by_label(label, exact=True)
    field.fill(value)
    field.press("Enter")
    field.blur()


def learn(page: Page, speeds: str, rounds: str, presses: str, judged: str = "1") -> None:
    """Order the paper's law on a rig without a load cell, where errors fall press by press."""
    opened(page, "compensate")
    page.get_by_label("Simulated rig").select_option("voltage")
    page.get_by_label("Button", exact=True).select_option("builtin:mx-clear")
    set_field(page, "Speeds", speeds)
    page.get_by_label("Method").select_option("paper")
    set_field(page, "Rounds", rounds)
    set_field(page, "Presses per round", presses)
    set_field(page, "Held-out presses", judged)
    page.get_by_role("button", name="Start", exact=True).click()
    page.wait_for_selector(".job-head")


def test_a_rig_learns_a_button_and_the_error_is_seen_to_fall(page: Page) -> None:
    learn(page, "100", "1", "12", "2")
    page.wait_for_selector(DONE, timeout=LONG_ms)
    expect(page.get_by_role("img", name="Force over displacement at 100 mm/s")).to_be_visible()
    expect(page.get_by_role("img", name="Error over presses at 100 mm/s")).to_be_visible()
    expect(page.locator(".job-head .tag.simulated")).to_be_visible()
    page.get_by_text("Figures").click()
    rows = page.get_by_role("table", name="Errors of every curve").locator("tbody tr")
    press = rows.nth(0).locator("td").all_inner_texts()
    assert press[0] == "12"
    first_cN, last_cN = float(press[1]), float(press[2])
    assert last_cN < 0.5 * first_cN
    page.get_by_role("tab", name="Held-out presses").click()
    expect(rows.nth(0).locator("td").nth(0)).to_have_text("2")
    kept = page.locator(".job-results").inner_text()
    assert re.search(r"table\s+mx-clear", kept)
    assert re.search(r"measured on held-out presses\s+mx-clear", kept)
    table = page.get_by_role("table", name="Presses, newest first").locator("tbody tr")
    # two presses without compensation, two held-out ones, and as many with the button's vibration
    expect(table).to_have_count(18)
    figures = (
        r"Mean error [\d.]+ → [\d.]+ cN on simulated presses, largest [\d.]+ → [\d.]+ cN; a finger would"
    )
    expect(verdict(page)).to_contain_text(re.compile(figures))
    expect(page.get_by_text("a finger would not notice the force on")).to_be_visible()
    noticed = page.get_by_role("table", name="What a finger would notice").locator("tbody tr")
    expect(noticed).to_have_count(2)
    assert re.search(r"\d+ % → \d+ %", noticed.nth(0).inner_text())
    assert audit(page) == []
    page.get_by_role("button", name="New job").click()
    page.get_by_label("or only evaluate").select_option("mx-clear")
    page.get_by_role("button", name="Evaluate", exact=True).click()
    page.get_by_role("heading", name="Probe mx-clear on twin").wait_for()
    page.wait_for_selector(DONE, timeout=LONG_ms)
    # a probe by itself is compared with no compensation too
    expect(verdict(page)).to_contain_text(re.compile(figures))


def test_a_probe_of_the_own_force_leads_to_compensation(page: Page) -> None:
    opened(page, "compensate")
    set_field(page, "Speeds", "100")
    set_field(page, "Held-out presses", "1")
    page.get_by_role("button", name="Evaluate", exact=True).click()
    page.wait_for_selector(DONE, timeout=LONG_ms)
    expect(verdict(page)).to_contain_text("on simulated presses, uncompensated")
    verdict(page).get_by_role("link", name="Compensate it").click()
    page.get_by_role("button", name="Start", exact=True).wait_for()


def test_the_recommended_rig_comes_first_and_its_result_beside_no_compensation(page: Page) -> None:
    opened(page, "compensate")
    page.get_by_label("Button", exact=True).select_option("builtin:mx-clear")
    rigs = page.get_by_label("Simulated rig").locator("option").all_inner_texts()
    assert rigs == ["recommended", "light", "paper", "voltage"]
    set_field(page, "Speeds", "50")
    set_field(page, "Rounds", "1")
    set_field(page, "Held-out presses", "2")
    page.get_by_role("button", name="Start", exact=True).click()
    page.wait_for_selector(DONE, timeout=LONG_ms)
    expect(verdict(page)).to_contain_text("; a finger would not notice it, by JNDs from the literature.")
    button = page.url
    verdict(page).get_by_role("link", name="Press it").click()
    page.wait_for_url(re.compile("#/press/builtin%3Amx-clear"))
    page.goto(button)
    assert "twin-recommended" in page.locator(".job-results").inner_text()
    before, after = (
        (
            page.get_by_role("table", name="What a finger would notice")
            .locator("tbody tr")
            .nth(0)
            .locator("td")
        )
        .nth(1)
        .inner_text()
        .split(" → ")
    )
    assert float(after) < 0.5 * float(before)


def test_a_page_that_is_reloaded_finds_its_job_stops_it_and_goes_on(page: Page) -> None:
    learn(page, "50, 100, 150, 200", "4", "12")
    page.locator(PRESSES).nth(3).wait_for()
    page.reload()
    page.locator(PRESSES).nth(3).wait_for()
    page.get_by_role("button", name="Stop").click()
    # gains of the loop may be being chosen just then, which takes seconds and is not cut
    page.wait_for_selector(".job-head .job-state.cancelled", timeout=LONG_ms)
    expect(verdict(page)).to_contain_text("what was made is kept")
    expect(page.locator(".job-sign")).to_be_hidden()
    page.get_by_role("button", name="Resume").click()
    expect(verdict(page)).to_contain_text(re.compile(r": press \d+ of \d+, (a few seconds|about \d+ s) left"))
    page.locator(".job-sign").wait_for()
    page.wait_for_selector(DONE, timeout=LONG_ms)
    expect(page.locator(".job-notices")).to_contain_text("goes on")


def test_a_job_is_found_from_every_page(page: Page) -> None:
    learn(page, "50, 100, 150, 200", "4", "12")
    page.keyboard.press("Alt+1")
    page.wait_for_selector("main[data-page=library]")
    page.click(".job-sign")
    page.wait_for_selector(".job-head")
    page.get_by_role("button", name="Stop").click()
    page.wait_for_selector(".job-head .job-state.cancelled")


def test_vibrations_are_tuned_with_keys_alone(page: Page) -> None:
    opened(page, "tune")
    set_field(page, "Maximum questions", "3")
    page.get_by_role("button", name="Start tuning").press("Enter")
    for number, key in enumerate("120", start=1):
        page.get_by_role("heading", name=f"Question {number} of 3").wait_for()
        assert audit(page) == []
        page.keyboard.press(key)
    page.wait_for_selector(DONE, timeout=LONG_ms)
    ranking = page.get_by_role("table", name="Ranking at 100 mm/s")
    assert ranking.locator("tbody tr").count() >= 3
    assert "kept" in ranking.inner_text()
    expect(verdict(page).get_by_role("link", name="Press it")).to_be_visible()
    page.get_by_role("link", name="Open in the editor").click()
    page.wait_for_url("**/#/edit/own%3A*")


def test_answers_are_blind_until_they_are_given(page: Page) -> None:
    opened(page, "tune")
    page.get_by_role("button", name="Start tuning").click()
    page.get_by_role("heading", name="Question 1").wait_for()
    assert "template" not in page.inner_text("main")
    page.keyboard.press("2")
    page.get_by_role("heading", name="Question 2").wait_for()
    expect(page.locator("details summary", has_text="may bias your answers")).to_be_visible()
    assert "template" not in page.inner_text("main")
    page.get_by_role("button", name="Stop").click()
    page.wait_for_selector(".job-head .job-state.cancelled")


def test_a_capture_on_the_simulated_bench_becomes_a_button_of_ones_own(page: Page) -> None:
    opened(page, "capture")
    set_field(page, "Name of the button", "my clear")
    set_field(page, "Speeds", "100")
    set_field(page, "Presses", "3")
    page.get_by_role("button", name="Start the capture").click()
    page.wait_for_selector(DONE, timeout=LONG_ms)
    takes = page.get_by_role("table", name="Takes, newest first")
    assert takes.locator("tbody tr").count() >= 5
    assert "good" in takes.inner_text()
    expect(page.get_by_text("simulated", exact=True).first).to_be_visible()
    expect(verdict(page)).to_contain_text(re.compile(r"A model of 4 curves .* from 3 presses, simulated"))
    expect(verdict(page).get_by_role("link", name="Edit it")).to_be_visible()
    opened(page, "compensate")
    page.get_by_label("Button", exact=True).select_option("own:my clear")


def test_the_pace_is_led_by_a_moving_cue(page: Page) -> None:
    opened(page, "capture")
    set_field(page, "Speeds", "100")
    set_field(page, "Presses", "1")
    page.get_by_label("A slow probe first").uncheck()
    page.get_by_label("Show the cue in real time").check()
    page.get_by_role("button", name="Start the capture").click()
    page.get_by_text("Finger off", exact=True).wait_for()
    page.get_by_text("Press down to the stop, then release: 100 mm/s").wait_for()
    for count in ("3", "2", "1"):
        page.locator(".cue-count", has_text=count).wait_for()
    page.get_by_role("button", name="Stop").click()
    page.wait_for_selector(".job-head .job-state.cancelled")


def test_the_scope_shows_a_press_and_zero_force_is_one_key_away(page: Page) -> None:
    opened(page, "device")
    page.get_by_role("combobox", name="Device").select_option("host")
    page.get_by_role("button", name="Connect").click()
    verdict(page).get_by_role("button", name="Upload").click()
    page.get_by_text("program: ").wait_for()
    verdict(page).get_by_role("button", name="Press once").click()
    page.get_by_text("in true displacement, simulated").wait_for()
    expect(verdict(page)).to_contain_text(
        re.compile(r"Mean error [\d.]+ cN in one press at 100 mm/s, simulated")
    )
    expect(verdict(page).get_by_role("link", name="Compensate it")).to_be_visible()
    page.get_by_role("button", name="Check the cell").click()
    page.get_by_text(
        re.compile(r"With nothing on the cap the load cell reads -?\d\.\d cN: it is sound")
    ).wait_for()
    expect(page.get_by_role("img", name="Displacement of the cap over time")).to_be_visible()
    page.get_by_text("Each column spans the least and the greatest").wait_for()
    page.get_by_role("button", name="Arm").click()
    page.locator(".job-state.mode-armed").wait_for()
    page.keyboard.press("Escape")
    page.locator(".job-state.mode-idle").wait_for()
    page.get_by_role("button", name="Self-test").click()
    page.get_by_role("row", name="position sensor passed").wait_for()
    assert audit(page) == []
    page.reload()
    page.locator(".job-state.mode-idle").wait_for()
    page.get_by_role("button", name="Disconnect").click()
    page.get_by_text("No device is connected").wait_for()


def test_what_the_studio_refuses_is_reported_in_one_line(
    context: BrowserContext, studio: RunningStudio
) -> None:
    # a page of its own: a browser writes every refusal to the console, which fails others' tests
    page = context.new_page()
    page.goto(studio.address)
    page.wait_for_selector("html[data-ready]")
    learn(page, "50, 100, 150, 200", "4", "12")
    job = page.url
    opened(page, "tune")
    with page.expect_response("**/api/jobs.start") as answer:
        page.get_by_role("button", name="Start tuning").click()
    assert answer.value.status == 422
    assert "twin is used by job 1" in page.locator(".toast.wrong").inner_text()
    page.goto(job)
    page.get_by_role("button", name="Stop").click()
    page.wait_for_selector(".job-head .job-state.cancelled")


@pytest.mark.parametrize("section", ["compensate", "capture", "tune", "device"])
def test_empty_pages_say_what_to_do_next(page: Page, section: str) -> None:
    opened(page, section)
    page.locator(".work-fields").first.wait_for()
    expect(page.get_by_text("No jobs yet")).to_be_visible()
    page.locator(".button.main").first.wait_for()
