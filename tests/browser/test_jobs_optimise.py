"""The job of an optimisation with a verdict, from the first screen, in counted clicks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from playwright.sync_api import expect

from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.verdict import verdict_sentence
from tests.browser.counted import CountedPerson
from tests.studio.running import RunningStudio
from tests.support.campaign import campaign

if TYPE_CHECKING:
    from playwright.sync_api import Page

MOST = 4


@campaign("keyboard", [False, True], part=1)
def test_an_optimisation_with_its_verdict_takes_four_clicks_at_most(
    page: Page, studio: RunningStudio, keyboard: bool
) -> None:
    person = CountedPerson(page, keyboard)
    person.click(page.get_by_role("link", name="Optimise", exact=True).first)
    person.click(page.get_by_role("radio", name="A simulated person plays"))
    person.click(page.get_by_role("button", name="Begin", exact=True))
    verdict = page.get_by_role("region", name="Verdict").get_by_role("status")
    expect(verdict).to_contain_text("A simulated person plays")
    expect(verdict).to_contain_text("mx-clear (95 %", timeout=240_000)
    assert person.clicks <= MOST
    said = verdict.inner_text()
    person.click(page.get_by_role("region", name="Verdict").get_by_role("button", name="Save as my button"))
    person.click(page.get_by_role("region", name="Verdict").get_by_role("link", name="Edit it"))
    page.wait_for_selector("main[data-page=edit]")
    assert "own%3Amx-clear%20found%201" in page.url
    with Optimization.open(studio.project / "optimize" / "1") as session:
        assert said == verdict_sentence(session)
        assert session.setup.start_name == "mx-clear"
        # 16 blocks of the start, the result and three more switches
        assert len(session.retests) == 80
