"""The participant's screen: whole sessions by key, mouse and touch, and whatever may come between."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from playwright.sync_api import expect

from fdvv_people.study.admin.study import Study
from tests.browser.accessibility import audit
from tests.browser.study_screens import (
    NAME,
    PASSPHRASE,
    InputMethod,
    Sitter,
    frozen_study,
    names_in,
    plan_text,
    recorded_answers,
    seat_address,
    wait_for_part,
)
from tests.browser.test_timing import kill_and_start_again
from tests.studio.running import RunningStudio
from tests.support.campaign import campaign

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

SIZES: dict[InputMethod, dict[str, Any]] = {
    "mouse": {"viewport": {"width": 1280, "height": 720}},
    "touch": {"viewport": {"width": 820, "height": 1180}, "has_touch": True},
}


@pytest.fixture
def study(request: pytest.FixtureRequest, tmp_path: Path) -> Study:
    """A frozen study; its plan's options are the test's parameter."""
    return frozen_study(tmp_path / "project", plan_text(**getattr(request, "param", {})))


@pytest.fixture
def sitter(study: Study, page: Page, context: BrowserContext) -> Sitter:
    """Somebody who sat down by keyboard."""
    found = Sitter(context.new_page())
    found.sit(page)
    return found


def answers(study: Study) -> list[tuple[str, dict[str, int]]]:
    """Return choice and realism of every recorded answer."""
    return [(one["choice"], one["ratings"]["realism"]) for one in recorded_answers(study)]


def screen_answers(sitter: Sitter) -> list[tuple[str, dict[str, int]]]:
    return [(one.choice, one.ratings) for one in sitter.given]


class Wire:
    """All that a page sends and hears."""

    def __init__(self, page: Page) -> None:
        self._said: list[str] = []
        self._answers: list[Any] = []
        page.on("websocket", self._join)
        page.on("request", lambda request: self._said.append(request.post_data or ""))
        page.on("response", lambda answer: self._answers.append(answer) if "/api/" in answer.url else None)

    def _join(self, socket: Any) -> None:
        socket.on("framesent", lambda text: self._said.append(str(text)))
        socket.on("framereceived", lambda text: self._said.append(str(text)))

    def texts(self) -> list[str]:
        """Return all of it; to be called while the page is open."""
        return [*self._said, *(answer.text() for answer in self._answers)]


@pytest.mark.parametrize("study", [{"items": 6, "rounds": 6, "reference": True}], indirect=True)
@campaign("input_method", ["mouse", "touch"], part=1)
def test_36_trials_are_answered_and_kept_and_no_message_names_what_a_label_hides(
    study: Study, page: Page, browser: Browser, studio: RunningStudio, input_method: InputMethod
) -> None:
    context = browser.new_context(**SIZES[input_method])
    context.set_default_timeout(15_000)
    # brings the cookie; the library that it shows names buttons, which tells nothing of labels
    first, operator, screen = (context.new_page() for _ in range(3))
    first.goto(studio.address)
    wait_for_part(first)
    wires = Wire(operator), Wire(screen)
    operator.goto(f"{studio.base}/#/studies/{NAME}")
    operator.wait_for_selector("[aria-label=People]")
    sitter = Sitter(screen, input_method)
    sitter.sit(operator)
    for at in range(1, 37):
        sitter.trial(at, 36)
    screen.wait_for_selector("h1:has-text('Thank you')")
    operator.wait_for_selector("tr[data-person=P01] >> text=36 of 36")
    seen, heard = (wire.texts() for wire in wires)
    context.close()
    assert answers(study) == screen_answers(sitter)
    assert all(
        set(one["presses"]) == {"X", "A", "B"} and min(one["presses"].values()) > 0
        for one in recorded_answers(study)
    )
    for texts in (seen, heard):
        assert any('"P01"' in text for text in texts)
        assert [text[:200] for text in texts if names_in(text)] == []
    assert not any(sitter.code in text for text in seen)
    found = study.unseal(PASSPHRASE, "a test", "the session is over")
    assert len(found.person) == 36
    assert found.counts.all()


@pytest.mark.parametrize("study", [{"pages": True}], indirect=True)
def test_a_session_is_done_by_keyboard_alone(study: Study, page: Page, context: BrowserContext) -> None:
    screen = context.new_page()
    sitter = Sitter(screen)
    keys = screen.keyboard
    screen.goto(seat_address(page))

    def tab_to(selector: str) -> None:
        screen.wait_for_selector(selector)
        for _ in range(12):
            if screen.evaluate("selector => document.activeElement?.matches(selector) ?? false", selector):
                return
            keys.press("Tab")
        raise AssertionError(f"{selector} cannot be reached")

    tab_to(".study-sheet .button.main")
    keys.press("Enter")
    screen.wait_for_selector(".study-card")
    assert audit(screen) == []
    tab_to(".study-sheet .button.main")
    keys.press("Enter")
    screen.wait_for_selector("h1:has-text('Before we begin')")
    assert audit(screen) == []
    tab_to("form .button.main")
    keys.press("Enter")
    tab_to("#study-age")
    keys.type("17")
    keys.press("Enter")
    expect(screen.locator("form [role=alert]")).to_have_text("Please answer all questions.")
    keys.press("Backspace")
    keys.type("8")
    tab_to("input[type=radio]")
    keys.press(" ")
    keys.press("Enter")
    sitter.trial(1, 2)
    sitter.wait_for(2, 2)
    assert audit(screen) == []
    sitter.trial(2, 2)
    screen.wait_for_selector("h1:has-text('Thank you')")
    assert audit(screen) == []
    assert answers(study) == screen_answers(sitter)


@pytest.mark.parametrize("study", [{"items": 3}], indirect=True)
def test_a_killed_server_costs_no_answer_and_the_screen_goes_on_by_itself(
    study: Study, page: Page, sitter: Sitter, studio: RunningStudio, context: BrowserContext
) -> None:
    sitter.trial(1, 3)
    sitter.wait_for(2, 3)
    sitter.feel("A")
    sitter.rate("A", 6)
    page.close()
    again = kill_and_start_again(sitter.page, studio, context)
    try:
        sitter.wait_for(2, 3)
        expect(sitter.page.locator(".study-rating[aria-label$=' A'] input[value='6']")).to_be_checked()
        expect(sitter.page.locator(".study-place[data-pressed=true]")).to_have_count(0)
        for at in (2, 3):
            sitter.trial(at, 3)
        sitter.page.wait_for_selector("h1:has-text('Thank you')")
    finally:
        again.stop()
    assert answers(study) == screen_answers(sitter)


def test_a_page_loaded_again_goes_on_and_so_does_a_card_on_another_screen(
    study: Study, page: Page, sitter: Sitter, browser: Browser, studio: RunningStudio
) -> None:
    sitter.wait_for(1, 2)
    sitter.feel("B")
    sitter.page.reload()
    sitter.trial(1, 2)
    sitter.wait_for(2, 2)
    other = browser.new_context()
    other.set_default_timeout(15_000)
    fresh = Sitter(other.new_page(), "mouse")
    fresh.page.goto(studio.address)
    wait_for_part(fresh.page)
    fresh.page.goto(f"{studio.base}/#/study/{NAME}")
    fresh.page.fill("#study-person", sitter.person)
    fresh.page.fill("#study-code", "AAAA-AAAA-AAAA")
    fresh.main()
    expect(fresh.page.locator(".study-reason")).not_to_be_empty()
    fresh.page.fill("#study-person", sitter.person)
    fresh.page.fill("#study-code", sitter.code)
    fresh.main()
    fresh.wait_for(2, 2)
    sitter.page.wait_for_selector("text=continues at another screen")
    fresh.trial(2, 2)
    fresh.page.wait_for_selector("h1:has-text('Thank you')")
    other.close()
    assert answers(study) == [*screen_answers(sitter), *screen_answers(fresh)]


@pytest.mark.parametrize("study", [{"break_every_min": 1e-4, "break_min": 0.05}], indirect=True)
def test_a_break_is_counted_down_and_cannot_be_cut_short(study: Study, sitter: Sitter) -> None:
    sitter.trial(1, 2)
    on = sitter.page.locator(".study-break .button.main")
    expect(on).to_be_disabled()
    assert sitter.page.inner_text(".study-clock").startswith("0:0")
    assert audit(sitter.page) == []
    expect(on).to_be_enabled()
    sitter.main()
    sitter.trial(2, 2)
    sitter.page.wait_for_selector("h1:has-text('Thank you')")


@pytest.mark.parametrize("study", [{"pages": True}], indirect=True)
def test_who_does_not_agree_is_out_in_their_own_language(
    study: Study, page: Page, context: BrowserContext
) -> None:
    sitter = Sitter(context.new_page())
    sitter.sit(page, "fi")
    sitter.page.click("text=En osallistu")
    sitter.page.wait_for_selector("h1:has-text('Tutkimus on osaltasi ohi')")
    assert sitter.page.get_attribute(".study-page", "lang") == "fi"
    (person,) = study.people()
    assert person.state == "deleted"
    # of the person nothing is left; the word of the seat is the tablet's
    assert set(sitter.page.evaluate("Object.keys(sessionStorage)")) <= {"fdvv-seat"}


def test_who_leaves_takes_their_answers_along(study: Study, sitter: Sitter) -> None:
    sitter.trial(1, 2)
    sitter.wait_for(2, 2)
    sitter.page.click("text=Leave the study")
    assert audit(sitter.page) == []
    sitter.page.click(".study-veil >> text=Stay")
    sitter.wait_for(2, 2)
    sitter.page.click("text=Leave the study")
    sitter.page.click("[role=alertdialog] .danger")
    sitter.page.wait_for_selector("h1:has-text('The study is over for you')")
    assert [one.state for one in study.people()] == ["deleted"]
    assert list(study.folder.glob("people/P01/session.jsonl")) == []
