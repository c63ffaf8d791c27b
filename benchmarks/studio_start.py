"""How long does a person wait from ``fdvv studio`` to a page that answers?

Starts the studio in a process of its own and opens its address in a Chromium that runs already, as a person's
browser does. Ready is when the library's first row can be clicked.

    python -m benchmarks.studio_start [RUNS]
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from playwright.sync_api import Browser, sync_playwright

from tests.studio.running import RunningStudio

INTERACTIVE, FIRST_ROW = "html[data-ready=library]", ".lib-row:not([hidden]) .lib-name"


def start(browser: Browser, folder: Path) -> tuple[float, float]:
    """Start once; give the seconds until the address was printed, and until the page was ready."""
    page = browser.new_context().new_page()
    begun = time.perf_counter()
    studio = RunningStudio(folder)
    printed = time.perf_counter()
    page.goto(f"{studio.address}#/library", wait_until="commit")
    page.wait_for_selector(INTERACTIVE)
    page.wait_for_selector(FIRST_ROW)
    ready = time.perf_counter()
    page.close()
    studio.stop()
    return printed - begun, ready - begun


def main() -> None:
    """Print medians and the slowest."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    chromium = shutil.which("chromium")
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=chromium)
        found = [start(browser, Path(folder) / "project") for _ in range(runs)]
        browser.close()
    for name, column in (("address printed", 0), ("page ready", 1)):
        times = [row[column] for row in found]
        print(f"{name}: median {median(times):.2f} s, slowest {max(times):.2f} s of {runs}")


if __name__ == "__main__":
    main()
