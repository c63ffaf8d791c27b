"""Files dropped on the page, as the system drops them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from playwright.sync_api import expect

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

LONG_ms = 60_000
DRAGS = ("dragEnter", "dragOver", "drop")


def drag(page: Page, kinds: Sequence[str], *paths: Path) -> None:
    """Drag files of the disk over the middle of the page, as the system does."""
    line = page.context.new_cdp_session(page)
    data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
    for kind in kinds:
        line.send("Input.dispatchDragEvent", {"type": kind, "x": 300, "y": 400, "data": data})
    line.detach()


def drop(page: Page, *paths: Path) -> Locator:
    """Drop files; return the dialog when all of them are read."""
    drag(page, DRAGS, *paths)
    dialog = page.get_by_role("dialog", name="Open")
    expect(dialog.get_by_role("status")).not_to_contain_text("Reading", timeout=LONG_ms)
    return dialog
