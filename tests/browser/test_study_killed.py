"""The page of a real Chromium is killed at random moments of a session: no answer is lost."""

from __future__ import annotations

import os
import random
import signal
from collections.abc import Callable
from contextlib import suppress
from threading import Timer
from typing import TYPE_CHECKING

from playwright.sync_api import Error

from fdvv_people.study.admin.study import Study
from tests.browser.study_screens import (
    NAME,
    PASSPHRASE,
    Sitter,
    TrialAnswer,
    frozen_study,
    plan_text,
    recorded_answers,
    wait_for_part,
)
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

TRIALS, KILLS, LONGEST_s = 12, 20, 4.0


def renderers(browser: Browser) -> set[int]:
    """Return the processes in which pages run."""
    session = browser.new_browser_cdp_session()
    found = session.send("SystemInfo.getProcessInfo")["processInfo"]
    session.detach()
    return {int(one["id"]) for one in found if one["type"] == "renderer"}


def kill(processes: set[int]) -> None:
    """Kill processes; some may have gone by themselves."""
    for process in processes:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


class Seated:
    """One person, over all pages that they lose. known : answers that the screen went on from.

    crashes : how often Chromium reported that a page of theirs was killed.
    """

    def __init__(self, study: Study, studio: RunningStudio, browser: Browser) -> None:
        self.study, self._studio, self._browser = study, studio, browser
        self.person = self.code = ""
        self.known: list[TrialAnswer] = []
        self.done, self.crashes = False, 0

    def live(self, operator: Page, seed: int, after_s: float) -> None:
        """Take part on a fresh page until it is killed, or the session is over."""
        before = renderers(self._browser)
        context = self._browser.new_context()
        context.set_default_timeout(15_000)
        page = context.new_page()
        page.on("crash", self._crashed)
        page.goto(self._studio.address)
        wait_for_part(page)
        sitter = Sitter(page, seed=seed)
        if not self.person:
            sitter.sit(operator)
            self.person, self.code = sitter.person, sitter.code
            page.wait_for_selector(".study-trial")
        # its own process and what Chromium keeps ready for the next one, never the operator's
        killer = Timer(after_s, kill, [renderers(self._browser) - before])
        killer.start()
        with suppress(Error):
            self._go_on(sitter)
        killer.join()
        context.close()
        self._check()

    def _go_on(self, sitter: Sitter) -> None:
        page = sitter.page
        if page.locator(".study-trial").count() == 0:
            page.goto(f"{self._studio.base}/#/study/{NAME}")
            page.fill("#study-person", self.person)
            page.fill("#study-code", self.code)
            sitter.main()
        while len(self.known) < TRIALS:
            # else it is not the first that was not answered
            sitter.wait_for(len(self.known) + 1, TRIALS)
            given = sitter.trial(len(self.known) + 1, TRIALS)
            if len(self.known) + 1 < TRIALS:
                sitter.wait_for(len(self.known) + 2, TRIALS)
            else:
                page.wait_for_selector("h1:has-text('Thank you')")
            self.known.append(given)
        self.done = True

    def _crashed(self, _page: Page) -> None:
        self.crashes += 1

    def _check(self) -> None:
        """Compare what the screen resumed from with what is on disk; one answer may be in transit."""
        found = [
            (one["choice"], one["ratings"]["realism"]) for one in recorded_answers(self.study, self.person)
        ]
        known = [(one.choice, one.ratings) for one in self.known]
        assert found[: len(known)] == known
        assert len(found) <= len(known) + 1
        self.known += [TrialAnswer(choice, ratings) for choice, ratings in found[len(known) :]]
        self.done = self.done or len(self.known) == TRIALS
        assert self.study.verify() == ()


def test_no_answer_is_lost_when_the_page_is_killed_twenty_times(
    page: Page, studio: RunningStudio, browser: Browser, record_property: Callable[[str, object], None]
) -> None:
    study = frozen_study(studio.project, plan_text(2, TRIALS // 2))
    wait_for_part(page)
    draw, people = random.Random(1), [Seated(study, studio, browser)]
    for seed in range(KILLS):
        if people[-1].done:
            people.append(Seated(study, studio, browser))
        people[-1].live(page, seed, draw.uniform(0.0, LONGEST_s))
    answers, crashes = sum(len(one.known) for one in people), sum(one.crashes for one in people)
    record_property("answers", answers)
    record_property("crashes", crashes)
    assert answers >= KILLS // 4
    # but where a session was over before
    assert crashes >= KILLS - len(people)
    assert study.verify(passphrase=PASSPHRASE) == ()
