"""Every page, light and dark, wide and narrow, before axe: nothing serious may be found."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Page

AXE = Path(__file__).resolve().parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"
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
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]


def audit(page: Page) -> list[str]:
    """Give what axe finds that is serious or critical, one line each."""
    if not AXE.is_file():
        missing = pytest.fail if os.environ.get("CI") else pytest.skip
        missing("axe-core is not installed: run make web-tools")
    page.evaluate(AXE.read_text())
    found: dict[str, Any] = page.evaluate(
        "tags => axe.run(document, { runOnly: tags, resultTypes: ['violations'] })", TAGS
    )
    return [
        f"{violation['id']} ({violation['impact']}): {node['target']} {node['html'][:160]}"
        for violation in found["violations"]
        if violation["impact"] in ("serious", "critical")
        for node in violation["nodes"]
    ]


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
