"""Dragging in the plot of the editor."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from playwright.sync_api import Page


FORCE = 2


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def scales(page: Page) -> Callable[[float, float], tuple[float, float]]:
    """Learn from the numbers under the pointer where a place of the axes lies on the screen."""
    box = page.locator(".edit-plot").bounding_box()
    assert box is not None
    at = np.array([[box["x"] + p * box["width"], box["y"] + p * box["height"]] for p in (0.3, 0.7)])
    read = []
    for x, y in at:
        page.mouse.move(x, y)
        words = page.locator(".edit-pointer").inner_text().split()
        read.append([number(words[0]), number(words[3])])

    def to_screen(x_mm: float, y_cN: float) -> tuple[float, float]:
        x, y = at[0] + (np.array([x_mm, y_cN]) - read[0]) * (at[1] - at[0]) / np.subtract(read[1], read[0])
        return float(x), float(y)

    return to_screen


def drag(page: Page, start: tuple[float, float], by: tuple[float, float]) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    for part in (0.3, 0.7, 1.0):
        page.mouse.move(start[0] + part * by[0], start[1] + part * by[1])
    page.mouse.up()
