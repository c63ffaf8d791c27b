"""How long does the editor work for one move of the hand, and how soon does the rig answer?

Run as ``python -m benchmarks.studio_drag [MOVES]`` with Chromium installed. Opens the built-in MX Clear, ten
curves, in a studio of its own, drags a control point, and reads the browser's own measures: the
work of every move (edit, constraints, panels) and of every picture (the layer that follows the hand), and how
long ``editor.achievable`` takes from question to answer while the drag goes on. The rig is simulated.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from playwright.sync_api import Page, sync_playwright

BUTTON = "builtin:mx-clear"
POINT = 7
OBSERVE = """() => {
  window.measured = [];
  new PerformanceObserver((list) => {
    for (const { name, startTime, duration } of list.getEntries()) {
      window.measured.push([name, startTime, duration]);
    }
  }).observe({ entryTypes: ["measure"] });
}"""


@contextmanager
def studio() -> Iterator[str]:
    """Return the address of a studio of its own."""
    with tempfile.TemporaryDirectory() as project:
        command = ["-m", "fdvv", "studio", "--project", project, "--port", "0", "--no-browser"]
        process = subprocess.Popen([sys.executable, *command], stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        try:
            yield process.stdout.readline().split()[-1]
        finally:
            process.terminate()
            process.wait(10)


def opened(page: Page, address: str) -> None:
    """Open the button and wait until the rig is known."""
    page.goto(address)
    page.wait_for_selector("html[data-ready]")
    page.evaluate(f"location.hash = '#/edit/' + encodeURIComponent('{BUTTON}')")
    page.wait_for_selector(".edit-follows", timeout=30_000)
    page.evaluate(OBSERVE)


def place_of(page: Page, row: int) -> tuple[float, float]:
    """Find a control point on the screen: the numbers under two places of the pointer give the scales."""
    box = page.locator(".edit-plot").bounding_box()
    assert box is not None
    at = np.array([[box["x"] + part * box["width"], box["y"] + part * box["height"]] for part in (0.3, 0.7)])
    read = []
    for x, y in at:
        page.mouse.move(x, y)
        words = page.locator(".edit-pointer").inner_text().replace("−", "-").split()
        read.append([float(words[0]), float(words[3])])
    cells = page.locator(".edit-points tbody tr").nth(row).locator("td")
    point = np.array([float(cells.nth(i).inner_text().replace("−", "-")) for i in (1, 2)])
    x, y = at[0] + (point - read[0]) * (at[1] - at[0]) / np.subtract(read[1], read[0])
    return float(x), float(y)


def dragged(page: Page, moves: int) -> list[tuple[str, float, float]]:
    """Drag a point up and down; give name, start and duration (ms) of every measure."""
    x, y = place_of(page, POINT)
    page.mouse.move(x, y)
    page.mouse.down()
    for i in range(moves):
        page.mouse.move(x, y - 30 + 60 * np.sin(0.13 * i))
    page.mouse.up()
    page.wait_for_timeout(300)
    return [(str(n), float(s), float(d)) for n, s, d in page.evaluate("window.measured")]


def summary(what: str, times_ms: list[float]) -> str:
    median, most = np.percentile(times_ms, [50, 99])
    return f"  {what}: median {median:.1f} ms, 99th percentile {most:.1f} ms, of {len(times_ms)}"


def main() -> None:
    moves = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    with studio() as address, sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"))
        page = chromium.new_page(viewport={"width": 1280, "height": 720})
        opened(page, address)
        found = dragged(page, moves)
        chromium.close()
    hand, draw, rig = ([d for n, _, d in found if n == f"fdvv-{k}"] for k in ("hand", "draw", "achievable"))
    starts = sorted((s, n, d) for n, s, d in found if n != "fdvv-achievable")
    # a picture and the moves since the picture before it are one redraw
    redraws, since = [], 0.0
    for _, name, duration in starts:
        since += duration
        if name == "fdvv-draw":
            redraws.append(since)
            since = 0.0
    print("dragging a control point of MX Clear, 10 curves, in Chromium")
    print(summary("work of a move (edit, panels)", hand))
    print(summary("work of a picture", draw))
    print(summary("redraw: picture and the moves it shows", redraws))
    print(summary("the rig's answer, simulated rig, from question to answer", rig))


if __name__ == "__main__":
    main()
