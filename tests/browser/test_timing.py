"""The screens of a timing study: a whole experiment by keyboard, and whatever may come between."""

from __future__ import annotations

import signal
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv_people.study.admin.study import Study
from tests.browser.study_screens import NAME, PASSPHRASE, open_sessions, wait_for_part
from tests.browser.timing_screens import STEP, Timer, frozen_timing, recorded, timing_text
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

TRIALS, PRESSES, CONDITIONS = 2, 3, 3


@pytest.fixture
def study(request: pytest.FixtureRequest, tmp_path: Path) -> Study:
    """A frozen study; its plan's options are the test's parameter."""
    return frozen_timing(tmp_path / "project", timing_text(**getattr(request, "param", {})))


@pytest.fixture
def timer(study: Study, page: Page, context: BrowserContext) -> Timer:
    """Somebody who sat down and agreed."""
    found = Timer(context.new_page())
    found.sit(page)
    found.agree()
    return found


def test_a_whole_experiment_by_keyboard_keeps_every_press_and_no_message_names_what_a_code_hides(
    study: Study, timer: Timer
) -> None:
    for number in range(1, TRIALS + 1):
        timer.trial(f"Training {number}", TRIALS)
    for number in range(1, CONDITIONS + 1):
        timer.trial(f"Trial {number}", CONDITIONS)
    timer.page.wait_for_selector("h1:has-text('Thank you')")
    rounds = recorded(study, "round")
    assert [(one["number"], one["round"]) for one in rounds] == timer.wire.kept()
    assert len(rounds) == (TRIALS + CONDITIONS) * PRESSES
    (began,) = recorded(study, "began")
    table = {one["number"] for one in began["trials"] if one["hand"] != "button"}
    assert all(len(one["activations_s"]) == 1 for one in rounds if one["number"] in table)
    assert study.verify() == ()
    codes = [one["trial"]["code"] for one in timer.wire.of("step") if one["trial"]]
    assert any(codes)
    assert [text[:200] for text in timer.wire.texts if "mx-" in text or "MX Red" in text] == []
    assert not any("late_ms" in text for text in timer.wire.texts)


def kill_and_start_again(screen: Page, studio: RunningStudio, context: BrowserContext) -> RunningStudio:
    """Kill the studio, start it at its port, and open the sessions as the key holder does."""
    port = int(studio.base.rpartition(":")[2])
    studio.stop(signal.SIGKILL)
    screen.wait_for_selector(".study-veil >> text=The connection is lost")
    again = RunningStudio(studio.project, port=port)
    # the studio opens its own page, which brings the cookie of this run
    opened = context.new_page()
    opened.goto(again.address)
    wait_for_part(opened)
    screen.wait_for_selector("text=The study pauses")
    open_sessions(opened)
    expect(screen.locator(".study-veil").first).to_be_hidden()
    opened.close()
    return again


def wait_for_round(timer: Timer, number: int) -> None:
    """Wait until so many rounds of the trial are kept."""
    timer.page.wait_for_selector(f".line >> text=Press {number + 1} of {PRESSES}")


def test_a_studio_killed_in_training_and_in_validation_costs_no_round_that_was_kept(
    study: Study, page: Page, timer: Timer, studio: RunningStudio, context: BrowserContext
) -> None:
    page.close()
    timer.wait_for(f"Training 1 of {TRIALS}")
    timer.begin()
    wait_for_round(timer, 1)
    studio = kill_and_start_again(timer.page, studio, context)
    expect(timer.page.locator(".line")).to_have_text(f"1 of {PRESSES} presses are kept: this trial goes on.")
    timer.begin()
    timer.trial("Training 2", TRIALS)
    timer.wait_for(f"Trial 1 of {CONDITIONS}")
    timer.prepare()
    timer.begin()
    wait_for_round(timer, 2)
    studio = kill_and_start_again(timer.page, studio, context)
    try:
        for number in range(1, CONDITIONS + 1):
            timer.trial(f"Trial {number}", CONDITIONS)
        timer.page.wait_for_selector("h1:has-text('Thank you')")
    finally:
        studio.stop()
    rounds = recorded(study, "round")
    assert [(one["number"], one["round"]) for one in rounds] == timer.wire.kept()
    assert len(rounds) == (TRIALS + CONDITIONS) * PRESSES
    # each trial that was broken off was begun twice, and went on
    assert [one["attempt"] for one in recorded(study, "begun")] == [1, 2, 1, 1, 2, 1, 1]
    assert study.verify(passphrase=PASSPHRASE) == ()


@pytest.mark.parametrize("study", [{"trials": 1, "presses": 2, "gap_days": 7.0}], indirect=True)
def test_after_training_the_screen_says_when_to_come_back_and_so_does_the_card(
    study: Study, page: Page, timer: Timer, studio: RunningStudio, browser: Browser
) -> None:
    timer.trial("Training 1", 1)
    timer.page.wait_for_selector("h1:has-text('The first part is done')")
    due = datetime.fromisoformat(str(timer.page.get_attribute("[data-due]", "data-due")))
    (trained,) = recorded(study, "trained")
    assert due.timestamp() == pytest.approx(trained["at_s"] + 7 * 86_400, abs=1)
    assert f"{due.astimezone():%A, %B} {due.astimezone().day}" in timer.page.inner_text(".study-sheet")
    expect(timer.page.locator(".study-sheet .button.main")).to_be_disabled()
    other = browser.new_context()
    other.set_default_timeout(15_000)
    fresh = other.new_page()
    fresh.goto(studio.address)
    wait_for_part(fresh)
    fresh.goto(f"{studio.base}/#/study/{NAME}")
    fresh.fill("#study-person", timer.person)
    fresh.fill("#study-code", timer.code)
    fresh.click(".study-main .button.main")
    fresh.wait_for_selector("h1:has-text('The first part is done')")
    timer.page.wait_for_selector("text=continues at another screen")
    other.close()
    page.goto(f"{studio.base}/#/studies/{NAME}")
    row = page.locator("tr[data-person=P01]")
    expect(row).to_contain_text("waiting")
    expect(row).to_contain_text("due from")
    expect(row.locator("[data-kept]")).to_have_text("2")
    expect(row.get_by_role("button", name="Copy reminder")).to_be_visible()


@pytest.mark.parametrize("study", [{"trials": 1, "presses": 2}], indirect=True)
def test_a_round_in_which_the_page_was_not_looked_at_is_flown_again(study: Study, timer: Timer) -> None:
    timer.wait_for("Training 1 of 1")
    timer.begin()
    timer.page.evaluate("dispatchEvent(new Event('blur'))")
    timer.page.wait_for_selector(".line >> text=You paused after 0 of 2 presses.")
    timer.page.wait_for_timeout(2500)
    timer.page.keyboard.press("Escape")
    timer.page.wait_for_selector(".study-at >> text=Trial 1 of 3")
    rounds = recorded(study, "round")
    assert [bool(one["activations_s"]) for one in rounds] == [True, True]


@pytest.mark.parametrize("study", [{"trials": 1, "presses": 2}], indirect=True)
def test_another_key_counts_for_nothing_and_the_one_that_does_is_named(study: Study, timer: Timer) -> None:
    timer.trial("Training 1", 1)
    for number in range(1, CONDITIONS + 1):
        timer.wait_for(f"Trial {number} of {CONDITIONS}")
        timer.page.wait_for_selector(STEP)
        if timer.page.locator(".study-sheet[data-key=F13]").count():
            break
        timer.prepare()
        timer.begin()
    timer.hit("Space")
    expect(timer.page.locator(".other")).to_have_text("That key does not count. Please press MX Brown (F13).")
    expect(timer.page.locator(".study-sheet[data-key=F13]")).to_be_visible()
    timer.prepare()
    timer.use("Space")
    timer.begin()
    number = recorded(study, "begun")[-1]["number"]
    timer.page.wait_for_selector(
        ".study-sheet[data-key=Space], .timed[data-status=away], h1:has-text('Thank')"
    )
    pressed = [one["activations_s"] for one in recorded(study, "round") if one["number"] == number]
    assert pressed == [[], []]


@pytest.mark.parametrize("study", [{"tapping": True}], indirect=True)
def test_taps_are_kept_second_by_second(study: Study, timer: Timer) -> None:
    for number in range(1, CONDITIONS + 1):
        timer.wait_for(f"Trial {number} of {CONDITIONS}")
        timer.prepare()
        timer.begin()
        timer.tap(4.0)
    timer.page.wait_for_selector("h1:has-text('Thank you')")
    rounds = recorded(study, "round")
    assert [(one["number"], one["round"]) for one in rounds] == timer.wire.kept()
    assert len(rounds) == 3 * CONDITIONS
    assert all(len(one["activations_s"]) >= 2 for one in rounds)
    rates = [one["scores"]["rate_Hz"]["value"] for one in recorded(study, "scored")]
    assert all(2.0 < rate < 8.5 for rate in rates)
    # the twin's finger loses no tap: in the first seconds as many keys as taps, but for one at the end
    for trial, downs_ms in timer.wire.downs_ms().items():
        taps = sum(at_ms < downs_ms[0] + 3000.0 for at_ms in downs_ms)
        keys = sum(len(one["activations_s"]) for one in rounds if one["number"] == trial)
        assert taps - 1 <= keys <= taps
