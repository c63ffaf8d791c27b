"""Does a studio that many pages use for long keep its memory, and does it go on answering soon?

Run as ``python -m benchmarks.studio_soak [MINUTES] [PAGES] [MOVE_s] [NICE]`` (10, 20, 10, 0 by default) with
Chromium installed. Every page wanders through library, editor and press of built-in buttons, in its own
studio. It moves on every MOVE_s, as somebody who looks around; nobody presses. With 0 all move as fast as
they can, and two cores do nothing but draw. NICE : by how much the browser yields to the studio (Linux).

Calls are timed at three places. In the network of the page: from the question sent to the last byte of the
answer (``PerformanceResourceTiming``), which is what the verdict is on. In the script of the page: from
``fetch`` to the answer, with the time that the script waits for what draws. From outside: a client without a
page asks again and again, with a pause between. Printed are also by how much the studio's memory grew
after a tenth of the time, how much of the processor studio and browser used, and the slowest kinds of calls.
What happens once in a project, that the editor's rig is identified, comes before and is timed alone. The rig
is simulated.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from http.client import HTTPConnection, HTTPResponse
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, Thread
from typing import NamedTuple

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from tests.browser.conftest import CHROMIUM
from tests.studio.running import RunningStudio

BUTTONS = ("mx-clear", "mx-red", "mx-blue")
RIG = "shipped:recommended"
PLACES = ("library", *(f"{page}/builtin%3A{name}" for page in ("edit", "press") for name in BUTTONS))
WATCH = """() => {
  performance.setResourceTimingBufferSize(1e6);
  window.waited = [];
  const ask = window.fetch;
  window.fetch = async (...words) => {
    const start = performance.now();
    try {
      return await ask(...words);
    } finally {
      const route = String(words[0]).split("api/")[1];
      if (route) window.waited.push([route, performance.now() - start]);
    }
  };
}"""
SENT = """() => performance.getEntriesByType("resource")
  .filter(({ name, requestStart }) => name.includes("/api/") && requestStart > 0)
  .map(({ name, requestStart, responseEnd }) => [name.split("api/")[1], responseEnd - requestStart])"""
OUTSIDE: tuple[tuple[str, dict[str, str]], ...] = (
    ("jobs.list", {}),
    ("press.list", {}),
    ("library.search", {"text": "mx"}),
)
PAUSE_s = 0.2
GROWTH_MB, SOON_ms = 20.0, 250.0

Call = tuple[str, float]
"""Its name, and how long it took (ms)."""


class Soaked(NamedTuple):
    """What a soak found: growth of memory, calls by where they were timed, use of the processor."""

    grown_MB: float
    sent: list[Call]
    waited: list[Call]
    outside: list[Call]
    studio_cores: float
    browser_cores: float


class Asker:
    """Asks the studio over a connection of its own, without a page."""

    def __init__(self, studio: RunningStudio) -> None:
        self._connection = HTTPConnection(studio.base.removeprefix("http://"))
        self._headers = {"authorization": f"Bearer {studio.token}", "content-type": "application/json"}

    def ask(self, name: str, question: Mapping[str, object]) -> dict[str, object]:
        """Return the answer of a call."""
        try:
            answer = self._send(name, question)
        except ConnectionError:  # the studio closes connections that ask nothing for seconds
            self._connection.close()
            answer = self._send(name, question)
        found: dict[str, object] = json.loads(answer.read())
        if answer.status != 200:
            raise RuntimeError(f"{name} was answered with {answer.status}: {found}")
        return found

    def _send(self, name: str, question: Mapping[str, object]) -> HTTPResponse:
        self._connection.request("POST", f"/api/{name}", json.dumps(question), self._headers)
        return self._connection.getresponse()


class Client(Thread):
    """Asks again and again, beside the pages, until it is stopped."""

    def __init__(self, studio: RunningStudio) -> None:
        super().__init__(name="client")
        self._asker, self._over = Asker(studio), Event()
        self.calls: list[Call] = []

    def run(self) -> None:
        for name, question in cycle(OUTSIDE):
            if self._over.wait(PAUSE_s):
                return
            begun = time.monotonic()
            self._asker.ask(name, question)
            self.calls.append((name, 1e3 * (time.monotonic() - begun)))

    def stop(self) -> list[Call]:
        self._over.set()
        self.join()
        return self.calls


def first_use_s(studio: RunningStudio) -> float:
    """Have the rig of the editor identified, as at its first use in a project; return how long that takes."""
    asker, begun = Asker(studio), time.monotonic()
    model = asker.ask("editor.button", {"button_id": f"builtin:{BUTTONS[0]}"})["model"]
    asker.ask("editor.achievable", {"model": model, "velocities_mm_s": [50.0], "rig_id": RIG})
    return time.monotonic() - begun


def memory_MB(studio: RunningStudio) -> float:
    """Return what the studio's process holds in memory (Linux)."""
    for line in Path(f"/proc/{studio.process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return float(line.split()[1]) / 1024
    raise RuntimeError("the system does not tell how much memory a process holds")


def processor_s(root: int) -> float:
    """Return what a process and its descendants, ended ones included, have used of the processor (Linux)."""
    used, parents = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        parents[int(stat.parent.name)] = int(fields[1])
        used[int(stat.parent.name)] = sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    family, size = {root}, 0
    while size != len(family):
        size = len(family)
        family |= {process for process, parent in parents.items() if parent in family}
    return sum(used.get(process, 0.0) for process in family)


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


@contextmanager
def chromium(folder: Path, nice: int) -> Iterator[tuple[Browser, int]]:
    """Start the browser; yield it, and the process above all of its own."""
    started = folder / "chromium"
    started.write_text(f'#!/bin/sh\necho $$ > {folder}/process\nexec nice -n {nice} {CHROMIUM} "$@"\n')
    started.chmod(0o755)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=started)
        try:
            yield browser, int((folder / "process").read_text())
        finally:
            browser.close()


def soak(minutes: float, count: int, move_s: float, nice: int) -> Soaked:
    """Let pages wander, and return what was found."""
    with TemporaryDirectory() as folder:
        studio = RunningStudio(Path(folder) / "project")
        try:
            print(f"the editor's rig is identified, once in a project: {first_use_s(studio):.1f} s")
            with chromium(Path(folder), nice) as (browser, process):
                found = watched(studio, opened(browser, studio, count), process, minutes, move_s)
        finally:
            try:
                said = studio.stop(signal.SIGTERM)
            finally:
                studio.process.kill()  # where it does not end, which is an error
    if "Traceback" in said:
        raise RuntimeError(said)
    return found


def watched(studio: RunningStudio, pages: list[Page], browser: int, minutes: float, move_s: float) -> Soaked:
    """Lead the pages about, a client beside them. browser : its process."""
    client, processes, begun = Client(studio), (studio.process.pid, browser), time.monotonic()
    before_s = [processor_s(process) for process in processes]
    client.start()
    *_, first_MB = wander(pages, studio, begun + 6 * minutes, move_s)
    *_, last_MB = wander(pages, studio, begun + 60 * minutes, move_s)
    outside, passed_s = client.stop(), time.monotonic() - begun
    cores = [
        (processor_s(process) - was_s) / passed_s for process, was_s in zip(processes, before_s, strict=True)
    ]
    sent = [(str(name), float(ms)) for page in pages for name, ms in page.evaluate(SENT)]
    waited = [(str(name), float(ms)) for page in pages for name, ms in page.evaluate("window.waited")]
    return Soaked(last_MB - first_MB, sent, waited, outside, *cores)


def line(calls: Iterable[Call]) -> str:
    """Say how long calls took."""
    taken_ms = [ms for _, ms in calls]
    median, p99, worst = np.percentile(taken_ms, (50, 99, 100))
    return f"{len(taken_ms)}: median {median:.0f} ms, 99 % within {p99:.0f} ms, at most {worst:.0f} ms"


def main() -> None:
    """Print all figures; exit status 1 where one is beyond its bound."""
    given = [float(word) for word in sys.argv[1:]]
    minutes, count, move_s, nice = [*given, *(10.0, 20.0, 10.0, 0.0)[len(given) :]]
    load = os.getloadavg()[0]
    found = soak(minutes, int(count), move_s, int(nice))
    print(
        f"{count:g} pages for {minutes:g} minutes, each moves on every {move_s:g} s; {os.cpu_count()} cores"
    )
    print(
        f"load before: {load:.1f}; the browser yields by {nice:g}; the studio grew by {found.grown_MB:.1f} MB"
    )
    print(f"cores used: studio {found.studio_cores:.2f}, browser {found.browser_cores:.2f}")
    print(f"calls in the network of the page, {line(found.sent)}")
    print(f"calls in the script of the page, {line(found.waited)}")
    print(f"calls of a client without a page, {line(found.outside)}")
    kinds = {name: [call for call in found.sent if call[0] == name] for name, _ in found.sent}
    slowest = sorted(kinds, key=lambda name: -float(np.percentile([ms for _, ms in kinds[name]], 99)))
    for name in slowest[:6]:
        print(f"  {name}, {line(kinds[name])}")
    p99_ms = float(np.percentile([ms for _, ms in found.sent], 99))
    sys.exit(int(found.grown_MB > GROWTH_MB or p99_ms > SOON_ms))


if __name__ == "__main__":
    main()
