"""How fast is the library with 5,000 buttons: index, search, painted rows, scrolling?

Real files of a folder are written again and again until there are 5,000. Index times are of the index alone,
with processes as `fdvv studio` uses them; searches are from a key press in Chromium to the frame that shows
the answer, every letter at the beginning of a frame; frame times are between animation frames while the list
scrolls.

    python -m benchmarks.studio_library FOLDER [BUTTONS]
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from playwright.sync_api import Page, expect, sync_playwright

from fdvv.button.fit import measured_files
from fdvv.errors import FdvvError
from fdvv_studio.library.catalog import Catalog
from fdvv_studio.library.figures import read_file
from fdvv_studio.library.index import CatalogIndex
from fdvv_studio.library.search import CatalogSearch, SearchQuery
from tests.studio.running import RunningStudio

WORDS = ("cherry mx", "gateron yel", "box navy", "gatreon", "silent red", "x", "topre 45")
PAINTED = """
word => new Promise(resolve => {
  const field = document.querySelector('.lib-search');
  const list = document.querySelector('.lib-list');
  const times = [];
  const letters = [...word];
  let text = '', begun = 0;
  const rows = new MutationObserver(() => {
    if (list.ariaBusy === 'true') return;
    // the frame with the rows has been handed over when the next one begins
    requestAnimationFrame(() => { times.push(performance.now() - begun); next(); });
  });
  const next = () => {
    const letter = letters.shift();
    if (letter === undefined) { rows.disconnect(); return resolve(times); }
    text += letter;
    begun = performance.now();
    field.value = text;
    field.dispatchEvent(new InputEvent('input', { bubbles: true }));
  };
  rows.observe(list, { attributes: true, attributeFilter: ['aria-busy'] });
  next();
})
"""
SCROLL = """
([steps, by_px]) => new Promise(resolve => {
  const list = document.querySelector('.lib-list');
  const times = [];
  let last = performance.now();
  const step = () => {
    const now = performance.now();
    times.push(now - last);
    last = now;
    list.scrollTop += by_px;
    if (times.length > steps) resolve(times.slice(1)); else requestAnimationFrame(step);
  };
  list.scrollTop = 0;
  requestAnimationFrame(step);
})
"""


def usable(folder: Path) -> Iterator[Path]:
    """Return the files of a folder that can be read."""
    for path in measured_files(folder):
        try:
            read_file(path)
        except FdvvError:
            continue
        yield path


def replicate(files: list[Path], into: Path, count: int) -> None:
    """Write files under many names."""
    for i in range(count):
        path = files[i % len(files)]
        target = into / f"bench {i // len(files):03d}" / path.parent.name / path.name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target)


def scan_s(source: Path, project: Path) -> tuple[float, CatalogIndex]:
    """Index once; give the seconds."""
    index = CatalogIndex(Catalog(project, [source]), project / "cache" / "shelf.jsonl")
    begun = time.perf_counter()
    index.scan()
    return time.perf_counter() - begun, index


def summary(name: str, times_ms: list[float]) -> str:
    """Write median, 99th percentile and the largest."""
    p50, p99, most = np.percentile(times_ms, (50, 99, 100))
    return f"{name}: median {p50:.1f} ms, 99 % {p99:.1f} ms, largest {most:.1f} ms of {len(times_ms)}"


def server(index: CatalogIndex) -> None:
    """Time what the server does for one letter."""
    search = CatalogSearch()
    begun = time.perf_counter()
    search.extend(index.status.rows)
    print(f"made ready to search: {1e3 * (time.perf_counter() - begun):.0f} ms")
    times = []
    for word in WORDS:
        for n in range(1, len(word) + 1):
            begun = time.perf_counter()
            search.find(SearchQuery(word[:n]))
            times.append(1e3 * (time.perf_counter() - begun))
    print(summary("search in the server", times))
    begun = time.perf_counter()
    search.find(SearchQuery(like=index.status.rows[0].id))
    print(f"nearest to one button: {1e3 * (time.perf_counter() - begun):.0f} ms")


def browsed(page: Page) -> None:
    """Time letters and scrolling in the browser."""
    times: list[float] = []
    for word in WORDS:
        times += page.evaluate(PAINTED, word)
    print(summary("key press to painted rows", times))
    page.locator(".lib-search").fill("")
    print(summary("frames at rest", page.evaluate(SCROLL, [200, 0])))
    print(summary("frames while scrolling 180 px a frame", page.evaluate(SCROLL, [600, 180])))


def main() -> None:
    """Print the figures."""
    if len(sys.argv) not in (2, 3):
        raise SystemExit("usage: python -m benchmarks.studio_library FOLDER [BUTTONS]")
    count = int(sys.argv[2]) if len(sys.argv) == 3 else 5000
    with tempfile.TemporaryDirectory() as folder:
        source, project = Path(folder) / "source", Path(folder) / "project"
        source.mkdir()
        files = list(usable(Path(sys.argv[1])))
        replicate(files, source, count)
        print(f"{count} buttons from {len(files)} files")
        cold, _ = scan_s(source, project)
        warm = [scan_s(source, project) for _ in range(5)]
        print(f"index cold {cold:.1f} s, warm {np.median([s for s, _ in warm]):.2f} s (median of 5)")
        server(warm[0][1])
        studio = RunningStudio(project, (source,))
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
            page = browser.new_page(viewport={"width": 1280, "height": 720})
            begun = time.perf_counter()
            page.goto(studio.address)
            everything = f"{len(warm[0][1].status.rows)} buttons"
            expect(page.locator(".lib-status")).to_contain_text(everything, timeout=60_000)
            print(f"page opened to all rows listed: {time.perf_counter() - begun:.2f} s")
            browsed(page)
            browser.close()
        studio.stop()


if __name__ == "__main__":
    main()
