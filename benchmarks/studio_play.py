"""How exactly is a press timed that a person makes in the studio's task? Simulated button, real Chromium.

Run as ``python -m benchmarks.studio_play [presses]`` (40 by default). A script in the page presses as soon as
the picture's own pixels show the bullet at the middle of the zone or beyond; what a press takes the simulated
button is known from a simulation of its own. Shown: the bound of the two clocks' offset, the way from hand to
simulation, which is taken out, and how far the asynchrony that is kept is from what the times say.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from fdvv_people.optimize.run.session import Optimization
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import model_subject

ZONE_ratio = 100 / 144
WATCH = """(x_ratio) => {
  const canvas = document.querySelectorAll('.strip canvas')[1];
  const lit = () => {
    if (canvas.width < 2) return false;
    const [x, y] = [Math.floor(x_ratio * canvas.width), Math.floor(canvas.height / 2)];
    return canvas.getContext('2d').getImageData(x, y, canvas.width - x, 1).data
      .some((value, i) => i % 4 === 3 && value > 200);
  };
  const key = (kind) => document.dispatchEvent(new KeyboardEvent(kind, {key: ' ', cancelable: true}));
  window.seen = [];
  let was = false;
  const look = (at_ms) => {
    const now = lit();
    if (now && !was) { window.seen.push(at_ms); key('keydown'); setTimeout(() => key('keyup'), 120); }
    was = now;
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}"""


def played(chromium: str, project: Path, presses: int) -> tuple[dict[str, list[dict[str, Any]]], list[float]]:
    """Play one trial; give what was said on the channel, by kind, and when the bullet was seen."""
    from playwright.sync_api import sync_playwright

    said: dict[str, list[dict[str, Any]]] = defaultdict(list)

    def take(text: str | bytes) -> None:
        message = json.loads(text)
        if message["channel"] == "play":
            said[message["body"]["type"]].append(message["body"])

    def join(socket: Any) -> None:
        socket.on("framesent", take)
        socket.on("framereceived", take)

    command = [
        sys.executable,
        "-m",
        "fdvv",
        "studio",
        "--project",
        str(project),
        "--port",
        "0",
        "--no-browser",
    ]
    studio = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    assert studio.stdout is not None
    try:
        with sync_playwright() as playwright:
            page = playwright.chromium.launch(executable_path=chromium).new_page()
            page.on("websocket", join)
            page.goto(f"{studio.stdout.readline().split()[-1]}#/optimize")
            page.get_by_text("Advanced", exact=True).click()
            page.get_by_label("Engine").select_option("sobol")
            page.get_by_label("Score after").fill(str(presses))
            page.keyboard.press("Enter")
            page.get_by_role("button", name="Begin", exact=True).click()
            page.get_by_role("button", name="Play trial 1").wait_for()
            page.get_by_role("button", name="Play trial 1").click()
            page.wait_for_selector(".opt-line >> text=/^Press 1 of/")
            page.evaluate(WATCH, ZONE_ratio)
            page.wait_for_selector(".opt-line >> text=/^Trial 1: asynchrony/", timeout=1e4 * presses)
            seen: list[float] = page.evaluate("() => window.seen")
    finally:
        studio.terminate()
        studio.wait(10)
        studio.stdout.close()
    return said, seen


def button_ms(folder: Path) -> float:
    """Return how long a press takes the first design of a run, simulated here and now."""
    with Optimization.open(folder) as session:
        press = LivePress(model_subject(session.model(session.trials[0].design)), session.setup.seed)
    hand, found = BinaryFinger.of(press.subject), []
    for _ in range(9):
        start_s = press.time_s
        hand.down(press)
        events = press.advance(0.12)[1]
        found.append(next(e.t_s for e in events if e.kind is LiveEventKind.ACTUATION) - start_s)
        hand.up(press)
        press.advance(0.5)
    return 1e3 * float(np.median(found))


def report(what: str, values_ms: list[float]) -> None:
    """Print middle and ends."""
    low, middle, high = np.percentile(values_ms, [1, 50, 99])
    print(f"{what}: median {middle:.2f} ms, 1 to 99 % {low:.2f} to {high:.2f} ms ({len(values_ms)} presses)")


def main(presses: int = 40) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        print("Chromium is not installed")
        return
    with tempfile.TemporaryDirectory() as folder:
        said, seen = played(chromium, Path(folder), presses)
        took_ms = button_ms(Path(folder) / "optimize" / "1")
    rounds, kept, downs = said["round"], said["kept"], said["down"]
    delays_ms = [one["input"]["ms"] + one["display"]["ms"] for one in rounds]
    print(f"a press takes the button {took_ms:.1f} ms; pictures every {rounds[-1]['frame_ms']:.2f} ms")
    report("bound of the clocks' offset", [one["clock_error_ms"] for one in rounds])
    report("from hand to simulation, taken out", [one["transport_ms"] for one in kept])
    late = [one["at_ms"] + took_ms - r["target_ms"] for one, r in zip(downs, rounds, strict=True)]
    error = [k["late_ms"] - x + d for k, x, d in zip(kept, late, delays_ms, strict=True)]
    report("asynchrony kept, less what its times say", error)
    after = [at_ms - r["target_ms"] for at_ms, r in zip(seen, rounds, strict=True)]
    report("picture that shows the bullet in the zone, less the time when it is there", after)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
