"""A tablet that has only the address of its seat: a whole session, a reload, a restart, and nothing else."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import expect

from fdvv_people.study.admin.study import Study
from fdvv_studio.studio.auth import opening_file
from tests.browser.study_screens import (
    NAME,
    Sitter,
    frozen_study,
    open_sessions,
    plan_text,
    seat_address,
    wait_for_part,
)
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

STATUS = """async (name) => (await fetch('./api/' + name, {method: 'POST',
headers: {'content-type': 'application/json'}, body: '{}'})).status"""
CHANNEL = """(channel) => new Promise((done) => {
const socket = new WebSocket('ws://' + location.host + '/live');
socket.onopen = () => socket.send(JSON.stringify({channel, body: {type: 'watch'}}));
socket.onmessage = (event) => done('heard ' + event.data);
socket.onclose = (event) => done(event.code); })"""


@pytest.fixture
def study(page: Page, studio: RunningStudio) -> Study:
    """A frozen study of two trials."""
    found = frozen_study(studio.project, plan_text())
    wait_for_part(page)
    return found


def test_a_tablet_with_a_seat_takes_part_and_can_do_nothing_else(
    study: Study, page: Page, browser: Browser, studio: RunningStudio
) -> None:
    prepared = seat_address(page)
    tablet = browser.new_context()
    tablet.set_default_timeout(15_000)
    sitter = Sitter(tablet.new_page())
    sitter.sit(page)
    address = sitter.page.url
    assert {cookie["name"].rpartition("-")[2] for cookie in tablet.cookies()} == {"seat"}
    for name in ("studies.withdraw", "studies.detail", "editor.save", "device.list", "library.search"):
        assert sitter.page.evaluate(STATUS, name) == 403
    for channel in ("studies", "jobs"):
        assert sitter.page.evaluate(CHANNEL, channel) == 4403
    sitter.trial(1, 2)
    sitter.page.reload()
    assert sitter.page.url == address
    sitter.wait_for(2, 2)
    page.close()
    studio.stop(signal.SIGKILL)
    again = RunningStudio(studio.project, port=int(studio.base.rpartition(":")[2]))
    try:
        operator = browser.new_context().new_page()
        operator.goto(again.address)
        wait_for_part(operator)
        open_sessions(operator)
        # the token of the studio is another one; that of the seat holds
        expect(sitter.page.locator(".study-veil").first).to_be_hidden()
        sitter.trial(2, 2)
        sitter.page.wait_for_selector("h1:has-text('Thank you')")
        late = Sitter(browser.new_context().new_page())
        late.page.goto(prepared)
        late.main()
        late.page.wait_for_selector(".study-card")
        assert late.page.inner_text("[data-card=person]") == "P02"
        assert "seat=" not in late.page.url
        assert late.page.url.endswith(f"#/study/{NAME}")
    finally:
        again.stop()
    assert [one.name for one in study.people()] == ["P01", "P02"]


def test_the_file_that_the_studio_opens_leads_into_it(browser: Browser, studio: RunningStudio) -> None:
    """Its token is in no list of processes; cookies are strict, and a file is another site."""
    with opening_file(studio.project) as written:
        page = browser.new_context().new_page()
        page.goto(written(studio.address).absolute().as_uri())
        page.wait_for_selector("header.top nav")
        assert page.url.startswith(studio.base)
        assert "token" not in page.url
