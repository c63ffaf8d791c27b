"""How fast is a button that is pressed live, and how soon is seen what the hand does? Simulated rigs.

Run as ``python -m benchmarks.studio_press [seconds]`` (60 by default). Real time factor: simulated over
computing time on one core, in stretches of 4 ms as the studio runs them, while a finger drums. Dropped time:
of a run at real pace. Hand to screen, if Chromium is installed: from a key event to the first frame that is
drawn with it, and to the first drawn frame in which the cap has moved by 0.05 mm from its rest.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from typing import Any

import numpy as np

from fdvv.model.file import load_builtin
from fdvv_studio.live.press import LivePress
from fdvv_studio.live.press_subject import PressMode, model_subject, trace_by_name
from fdvv_studio.live.run import LiveFrame, LiveRun

STEP_s, SIMULATED_s = 0.004, 10.0
RIGS = (
    ("recommended, 10 kHz, force loop", PressMode.COMPENSATED, "recommended"),
    ("paper, 1 kHz, not compensated", PressMode.RENDERED, "paper"),
    ("paper, 1 kHz, compensated", PressMode.COMPENSATED, "paper"),
    ("light, 10 kHz, compensated", PressMode.COMPENSATED, "light"),
    ("ideal, 10 kHz, as intended", PressMode.INTENDED, "paper"),
)
PRESSES = 60
MOVED_mm = 0.05


def real_time_factor(mode: PressMode, rig: str) -> float:
    """Return simulated time over computing time."""
    press = LivePress(model_subject(load_builtin("mx-clear"), mode, rig))
    began = time.process_time()
    for step in range(round(SIMULATED_s / STEP_s)):
        if step % 350 == 0:
            press.replay(trace_by_name("drumming"))
        press.advance(STEP_s)
    return SIMULATED_s / (time.process_time() - began)


def dropped(seconds: float) -> tuple[float, float, float]:
    """Return seconds that passed, seconds that were dropped, and part of real time that computing took."""
    frames: list[LiveFrame] = []
    press = LivePress(model_subject(load_builtin("mx-clear")))
    began = time.monotonic()
    run = LiveRun(press, frames.append, print, print)
    over = threading.Event()
    while time.monotonic() - began < seconds:
        run.ask(lambda one: one.replay(trace_by_name("drumming")))
        over.wait(1.4)
    run.close()
    busy = float(np.median([frame.busy_ratio for frame in frames]))
    return time.monotonic() - began, frames[-1].dropped_s, busy


def hand_to_screen(chromium: str) -> dict[str, list[float]]:
    """Press the space bar and look at what is drawn; give delays in ms."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "fdvv", "studio", "--project", folder, "--port", "0", "--no-browser"]
        studio = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert studio.stdout is not None
        address = studio.stdout.readline().split()[-1]
        try:
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(executable_path=chromium)
                page = browser.new_page()
                page.add_init_script(WATCH)
                page.goto(f"{address}#/press/builtin:mx-clear")
                page.wait_for_selector(".press-told:has-text('simulated rig')")
                page.focus(".press-view")
                found = drum(page)
                browser.close()
        finally:
            studio.terminate()
            studio.wait(10)
            studio.stdout.close()
    return found


WATCH = """
window.found = {drawn: [], moved: []};
const take = WebSocket.prototype.send;
let asked = null;
const key = (event) => { asked ??= {at: event.timeStamp, sequence: null, drawn: false}; };
document.addEventListener('keydown', key, true);
WebSocket.prototype.send = function (text) {
  const body = JSON.parse(text).body;
  if (asked && body.type === 'lead') asked.sequence ??= body.sequence;
  if (!this.watched) { this.watched = true; this.addEventListener('message', (event) => {
    const body = JSON.parse(event.data).body;
    const mine = asked;
    if (!mine || body?.type !== 'frame' || mine.sequence === null || body.sequence < mine.sequence) return;
    requestAnimationFrame(() => setTimeout(() => {  // after everything of this frame was drawn
      const now = performance.now();
      if (!mine.drawn) { mine.drawn = true; window.found.drawn.push(now - mine.at); }
      if (asked === mine && Math.max(...body.displacement_mm) > MOVED) {
        window.found.moved.push(now - mine.at); asked = null; }
    }));
  }); }
  return take.call(this, text);
};
""".replace("MOVED", str(MOVED_mm))


def drum(page: Any) -> dict[str, list[float]]:
    """Press and release, each time from rest."""
    for _ in range(PRESSES):
        page.keyboard.down(" ")
        page.wait_for_selector(".press-lamp:not([data-key='0'])")
        page.keyboard.up(" ")
        page.wait_for_selector(".press-lamp[data-key='0']")
        page.wait_for_timeout(150)
    found: dict[str, list[float]] = json.loads(page.evaluate("() => JSON.stringify(window.found)"))
    return found


def summary(delays_ms: list[float]) -> str:
    """Write median and 99th percentile."""
    return f"median {np.median(delays_ms):.0f} ms, 99 % within {np.percentile(delays_ms, 99):.0f} ms"


def main(seconds: float = 60.0) -> None:
    print("simulated seconds per second of one core, in stretches of 4 ms, a drumming finger")
    for name, mode, rig in RIGS:
        print(f"  {name}: {real_time_factor(mode, rig):.0f}")
    passed, lost, busy = dropped(seconds)
    print(f"dropped {1000 * lost:.0f} ms of {passed:.0f} s at real pace; computing took {100 * busy:.0f} %")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        print("hand to screen: Chromium is not installed")
        return
    found = hand_to_screen(chromium)
    print(f"key to a drawn frame that knows of it, {len(found['drawn'])} presses: {summary(found['drawn'])}")
    print(f"key to the drawn cap having moved {MOVED_mm:g} mm: {summary(found['moved'])}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
