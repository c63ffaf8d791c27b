"""Does a studio that many pages use for long keep its memory, and does it go on answering soon?

Run as ``python -m benchmarks.studio_soak [MINUTES] [PAGES] [MOVE_s]`` (10, 20, 10 by default) with Chromium
installed. Every page wanders through library, editor and press of built-in buttons, in its own studio. It
moves on every MOVE_s, as somebody who looks around; with 0 all move as fast as they can, and two cores do
nothing but draw. Printed are the memory of the studio after a tenth of the time and at the end, and how
long calls took in the page, from question to answer, on the machine that runs both; the rig is simulated.
"""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright
from tests.browser.conftest import CHROMIUM
from tests.studio.running import RunningStudio

BUTTONS = ("mx-clear", "mx-red", "mx-blue")
PLACES = ("library", *(f"{page}/builtin%3A{name}" for page in ("edit", "press") for name in BUTTONS))
WATCH = """() => {
  window.calls = [];
  const ask = window.fetch;
  window.fetch = async (...words) => {
    const start = performance.now();
    try {
      return await ask(...words);
    } finally {
      if (String(words[0]).includes("api/")) window.calls.push(performance.now() - start);
    }
  };
}"""
GROWTH_MB, SOON_ms = 20.0, 250.0


def memory_MB(studio: RunningStudio) -> float:
    """Return what the studio's process holds in memory (Linux)."""
    for line in Path(f"/proc/{studio.process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return float(line.split()[1]) / 1024
    raise RuntimeError("the system does not tell how much memory a process holds")


def opened(browser: Browser, studio: RunningStudio, count: int) -> list[Page]:
    """Open so many pages, each in a profile of its own, and watch their calls."""
    pages = [browser.new_context(viewport={"width": 1280, "height": 720}).new_page() for _ in range(count)]
    for page in pages:
        page.add_init_script(f"({WATCH})()")
        page.goto(studio.address, timeout=120_000)
        page.wait_for_selector("html[data-ready]", timeout=120_000)
    return pages


def wander(pages: list[Page], studio: RunningStudio, until_s: float, move_s: float) -> Iterator[float]:
    """Lead page after page on until the time is over; yield the studio's memory after each round."""
    turn = 0
    while time.monotonic() < until_s:
        for number, page in enumerate(pages):
            page.evaluate(f"location.hash = '#/{PLACES[(turn + number) % len(PLACES)]}'")
            page.wait_for_timeout(max(20.0, 1e3 * move_s / len(pages)))
        turn += 1
        yield memory_MB(studio)


def soak(minutes: float, count: int, move_s: float) -> tuple[float, list[float]]:
    """Return by how many MB the studio has grown since a tenth of the time, and the calls in ms."""
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        studio = RunningStudio(Path(folder) / "project")
        browser = playwright.chromium.launch(executable_path=CHROMIUM)
        try:
            pages = opened(browser, studio, count)
            begun = time.monotonic()
            *_, first_MB = wander(pages, studio, begun + 6 * minutes, move_s)
            *_, last_MB = wander(pages, studio, begun + 60 * minutes, move_s)
            calls = [float(ms) for page in pages for ms in page.evaluate("window.calls")]
        finally:
            browser.close()
            try:
                said = studio.stop(signal.SIGTERM)
            finally:
                studio.process.kill()  # where it does not end, which is an error
    if "Traceback" in said:
        raise RuntimeError(said)
    return last_MB - first_MB, calls


def main() -> None:
    """Print all figures; exit status 1 where one is beyond its bound."""
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    move_s = float(sys.argv[3]) if len(sys.argv) > 3 else 10.0
    grown_MB, calls = soak(minutes, count, move_s)
    median, p99, worst = np.percentile(calls, (50, 99, 100))
    print(f"{count} pages for {minutes:g} minutes, each moves on every {move_s:g} s")
    print(f"{len(calls)} calls, the studio grew by {grown_MB:.1f} MB")
    print(f"calls: median {median:.0f} ms, 99 % within {p99:.0f} ms, at most {worst:.0f} ms")
    sys.exit(int(grown_MB > GROWTH_MB or p99 > SOON_ms))


if __name__ == "__main__":
    main()
