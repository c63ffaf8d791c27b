"""The operator's pages: from a template to the report, and what they tell of people meanwhile."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv_people.study.admin.study import Study
from tests.browser.accessibility import audit
from tests.browser.study_screens import NAME, PASSPHRASE, Sitter, frozen_study, plan_text, wait_for_part
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page


def to(page: Page, address: str) -> None:
    """Go to a page of the studio."""
    page.goto(f"{page.url.partition('#')[0]}#/{address}")


def tab(page: Page, name: str) -> None:
    """Choose a tab of a study."""
    page.get_by_role("tab", name=name).click()


@pytest.fixture
def study(page: Page, studio: RunningStudio) -> Study:
    """A frozen study of two trials, on its page."""
    found = frozen_study(studio.project, plan_text())
    wait_for_part(page)
    to(page, f"studies/{NAME}")
    page.wait_for_selector("[aria-label=People]")
    page.fill("#sts-run", PASSPHRASE)
    page.get_by_role("button", name="Open the sessions").click()
    page.wait_for_selector("[aria-label=Invitation]")
    return found


def test_a_study_is_declared_changed_checked_and_frozen(page: Page, studio: RunningStudio) -> None:
    wait_for_part(page)
    to(page, "studies")
    page.wait_for_selector("form.sts-new select")
    page.fill("#sts-name", NAME)
    page.get_by_role("button", name="Create").click()
    expect(page.locator(".sts-good")).to_have_text("No problems found.")
    expect(page.locator(".sts-preview")).to_contain_text("36 trials")
    text = page.locator(".sts-text")
    before = text.input_value()
    text.fill(before.replace("rounds = 6", "rounds = 0"))
    page.wait_for_selector(".sts-problems >> text=rounds")
    freeze = page.get_by_role("button", name="Freeze the study")
    expect(freeze).to_have_count(0)
    text.fill(before.replace("rounds = 6", "rounds = 2"))
    page.wait_for_selector(".sts-good")
    page.get_by_role("button", name="Keep").click()
    expect(page.locator(".sts-preview")).to_contain_text("12 trials")
    expect(page.get_by_label("Rounds")).to_have_value("2")
    page.get_by_label("Participants").fill("6")
    page.keyboard.press("Enter")
    assert "people = 6 " in text.input_value()
    assert text.input_value().replace("people = 6 ", "people = 12 ") == before.replace(
        "rounds = 6", "rounds = 2"
    )
    page.get_by_role("button", name="Keep").click()
    expect(page.get_by_role("region", name="Verdict")).to_contain_text(
        "Ready to freeze: 6 participants × 12 trials"
    )
    freeze.click()
    expect(page.get_by_role("alertdialog")).to_contain_text("can no longer be changed")
    assert audit(page) == []
    sure = page.get_by_role("button", name="Freeze for good")
    page.fill("#sts-pass", PASSPHRASE)
    page.fill("#sts-again", "something else")
    sure.click()
    page.wait_for_selector("text=the two do not match")
    page.fill("#sts-again", PASSPHRASE)
    sure.click()
    page.wait_for_selector("text=No participant has started yet")
    expect(page.get_by_role("region", name="Verdict")).to_contain_text("0 of 6 participants done.")
    study = Study.open(studio.project / "studies" / NAME)
    assert (study.plan.rounds, study.plan.people) == (2, 6)
    tab(page, "Seal and results")
    expect(page.locator("[data-fingerprint]")).to_have_text(study.fingerprint)
    tab(page, "Plan")
    expect(page.locator(".sts-text")).to_have_attribute("readonly", "")


def test_people_are_seated_followed_paused_and_their_study_opened_and_reported(
    page: Page, study: Study, context: BrowserContext, tmp_path: Path
) -> None:
    page.get_by_role("button", name="Create an invitation").click()
    address = page.get_attribute("a[data-seat]", "href")
    assert address is not None
    sitter = Sitter(context.new_page())
    sitter.page.goto(address)
    sitter.main()
    sitter.page.wait_for_selector(".study-card")
    sitter.main()
    sitter.trial(1, 2)
    row = page.locator("tr[data-person=P01]")
    expect(row).to_contain_text("1 of 2")
    expect(row).to_contain_text("at a screen")
    page.get_by_label("Pause all").check()
    sitter.page.wait_for_selector("text=The study pauses")
    page.get_by_label("Pause all").uncheck()
    expect(sitter.page.locator(".study-veil").first).to_be_hidden()
    sitter.trial(2, 2)
    expect(row).to_contain_text("done")
    tab(page, "Seal and results")
    page.get_by_role("button", name="Verify").click()
    page.wait_for_selector("text=Nothing has changed")
    page.fill("#sts-who", "the keeper")
    page.fill("#sts-why", "the last person is done")
    page.fill("#sts-open", "a guess")
    page.get_by_role("button", name="Unseal permanently").click()
    page.wait_for_selector(".toast.wrong")
    assert not (study.folder / "unsealed").exists()
    page.fill("#sts-open", PASSPHRASE)
    page.get_by_role("button", name="Unseal permanently").click()
    page.wait_for_selector("[aria-label=Results]")
    expect(page.get_by_role("region", name="Verdict")).to_contain_text("Main claim")
    expect(page.locator(".sts-history")).to_contain_text("the last person is done")
    with page.expect_download() as saving:
        page.get_by_role("button", name="Save the report").click()
    saving.value.save_as(tmp_path / "report.html")
    report = (tmp_path / "report.html").read_text()
    assert study.fingerprint in report
    assert "FDVV" in report


def test_somebody_is_withdrawn_and_a_change_of_the_files_is_found(
    page: Page, study: Study, context: BrowserContext
) -> None:
    sitter = Sitter(context.new_page())
    sitter.sit(page)
    sitter.trial(1, 2)
    page.locator("tr[data-person=P01] >> text=Withdraw").click()
    assert audit(page) == []
    page.get_by_role("button", name="Withdraw P01 permanently").click()
    expect(page.locator("tr[data-person=P01]")).to_contain_text("deleted")
    sitter.page.wait_for_selector("h1:has-text('The study is over for you')")
    log = study.folder / "study.jsonl"
    log.write_text(log.read_text().replace('"language": "en"', '"language": "fi"'))
    tab(page, "Seal and results")
    page.get_by_role("button", name="Verify").click()
    page.wait_for_selector(".sts-problems li")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_any_tab(page: Page, study: Study, scheme: str) -> None:
    page.emulate_media(color_scheme="light" if scheme == "light" else "dark")
    if scheme == "dark":
        page.set_viewport_size({"width": 820, "height": 1180})
    for name in ("People", "Plan", "Seal and results"):
        tab(page, name)
        page.wait_for_load_state("networkidle")
        assert audit(page) == []
