"""Every page, light and dark, wide and narrow, before axe: nothing serious may be found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.browser.accessibility import audit

if TYPE_CHECKING:
    from playwright.sync_api import Page

PAGES = (
    "library",
    "edit",
    "edit/builtin:mx-clear",
    "press",
    "press/builtin:mx-brown",
    "live",
    "live/capture",
    "live/tune",
    "live/device",
    "programs",
    "programs/shipped:multi-level",
    "optimize",
    "studies",
)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("address", PAGES)
def test_axe_finds_nothing_serious(page: Page, address: str, scheme: Any) -> None:
    page.emulate_media(color_scheme=scheme)
    wide = scheme == "light"
    page.set_viewport_size({"width": 1280, "height": 720} if wide else {"width": 820, "height": 1180})
    page.goto(f"{page.url.partition('#')[0]}#/{address}")
    page.wait_for_selector(f"main[data-page={address.partition('/')[0]}]")
    page.wait_for_load_state("networkidle")
    assert audit(page) == []


def test_axe_sees_a_planted_fault(page: Page) -> None:
    page.evaluate("document.querySelector('main').append(document.createElement('button'))")
    assert any("button-name" in line for line in audit(page))
