"""The job of a study's dry run as a participant, from the first screen, in counted clicks."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv_people.study.admin.study import Study
from tests.browser.accessibility import audit
from tests.browser.counted import CountedPerson
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Page

MOST = 4


@pytest.mark.parametrize("keyboard", [False, True], ids=["mouse", "keyboard"])
def test_a_dry_run_as_a_participant_takes_four_clicks_at_most_and_records_nothing(
    page: Page, studio: RunningStudio, keyboard: bool
) -> None:
    person = CountedPerson(page, keyboard)
    person.click(page.get_by_role("link", name=re.compile("^(Study|Studies)$")).first)
    page.wait_for_selector("form.sts-new select")
    person.click(page.get_by_role("button", name="Create"))
    verdict = page.get_by_role("region", name="Verdict").get_by_role("status")
    expect(verdict).to_contain_text("Ready to freeze: 12 participants × 36 trials, power", timeout=60_000)
    attempt = page.get_by_role("button", name="Try it as a participant")
    expect(attempt).to_be_enabled()
    person.click(attempt)
    page.wait_for_selector("#study-title", timeout=60_000)
    expect(page.get_by_text("Rehearsal: nothing is recorded.")).to_be_visible()
    person.click(page.locator(".study-main .button.main"))
    page.wait_for_selector(".study-card")
    assert person.clicks <= MOST
    assert audit(page) == []
    assert "seat" not in page.url
    page.reload()
    page.wait_for_selector(".study-card")
    studies = studio.project / "studies"
    assert [path.name for path in studies.iterdir()] == ["study-1"]
    study = Study.open(studies / "study-1")
    assert study.frozen is None
    assert not (study.folder / "people").exists()
    page.get_by_role("link", name="Back to the plan").click()
    page.wait_for_selector("[aria-label=Plan]")
