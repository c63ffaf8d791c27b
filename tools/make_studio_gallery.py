"""Photograph the studio for the documents: docs/images/studio/*.png, and one film. Run it from the repository
root as ``python -m tools.make_studio_gallery [NAME ...]``.

A fresh studio with built-in buttons only, driven in Chromium as a person does; what it renders is simulated.
"""

from __future__ import annotations

import io
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from benchmarks.studio_drag import place_of
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

REPOSITORY = Path(__file__).resolve().parents[1]
TARGET = REPOSITORY / "docs" / "images" / "studio"
WIDE, TABLET = (1280, 720), (820, 1180)
LONG_ms = 120_000


@dataclass(frozen=True)
class Shot:
    """One picture: where, how light, how wide, and what is done before."""

    name: str
    address: str
    scheme: str
    size: tuple[int, int]
    act: Callable[[Page], None]


def compare(page: Page) -> None:
    """Put four buttons over each other."""
    for name in ("mx-clear", "mx-blue", "mx-red", "rubber-dome"):
        page.locator(".lib-row:not([hidden])", has_text=name).locator(".lib-check").click()
    page.locator(".lib-chip").nth(3).wait_for()


def follow(page: Page) -> None:
    """Choose a fast curve and wait for what the rig makes of it."""
    page.get_by_role("button", name="press, 100 mm/s").or_(
        page.get_by_role("radio", name="100")
    ).first.click()
    page.wait_for_selector(".edit-follows", timeout=LONG_ms)


def tab(name: str) -> Callable[[Page], None]:
    """Open a tab of the editor once the rig is known."""

    def act(page: Page) -> None:
        page.wait_for_selector(".edit-follows", timeout=LONG_ms)
        page.get_by_role("tab", name=name).click()

    return act


def hold(page: Page) -> None:
    """Press twice and hold the second press."""
    page.wait_for_selector(".press-lamp[data-key='0']")
    for _ in range(2):
        page.keyboard.down(" ")
        page.wait_for_selector(".press-lamp:not([data-key='0'])")
        page.wait_for_timeout(300)
        if page.locator("[data-value='presses']").inner_text() == "0":
            page.keyboard.up(" ")
            page.wait_for_selector("[data-value='presses'] >> text=/^1$/", state="attached")


def learn(page: Page) -> None:
    """Have the simulated rig learn a button."""
    page.get_by_label("Button", exact=True).select_option("builtin:mx-clear")
    page.get_by_role("button", name="Start", exact=True).click()
    page.wait_for_selector(".job-head .job-state.done", timeout=LONG_ms)


def connect(page: Page) -> None:
    """Connect the simulated rig and press on it."""
    page.get_by_role("button", name="Connect").click()
    next_step = page.get_by_role("region", name="Verdict").get_by_role("button")
    next_step.click()
    page.get_by_text("program: ").wait_for()
    next_step.click()
    page.get_by_text("in true displacement, simulated").wait_for()
    page.wait_for_timeout(1500)


def optimise(page: Page) -> None:
    """Have a simulated person play a run, and stay on its page."""
    page.get_by_role("radio", name="A simulated person plays").click()
    page.get_by_role("button", name="Begin", exact=True).click()
    page.get_by_role("region", name="Verdict").get_by_text("(95 %").wait_for(timeout=2 * LONG_ms)
    page.get_by_role("tab", name="Play").click()


def found(page: Page) -> None:
    """Look at what such a run found."""
    optimise(page)
    page.get_by_role("tab", name="Result").click()
    page.wait_for_selector(".opt-compared", timeout=LONG_ms)


def bullet(page: Page) -> None:
    """Begin to play, and wait for the bullet."""
    page.get_by_text("Advanced", exact=True).click()
    page.get_by_label("Engine").select_option("sobol")
    page.get_by_role("button", name="Begin", exact=True).click()
    page.get_by_role("button", name="Play trial 1").click()
    page.wait_for_selector(".opt-line >> text=/^Press 1 of/")
    page.wait_for_timeout(1300)


def still(page: Page) -> None:
    """Wait until nothing is on its way."""
    page.wait_for_load_state("networkidle")


SHOTS = (
    Shot("library", "library", "light", WIDE, compare),
    Shot("library-tablet", "library", "dark", TABLET, compare),
    Shot("editor", "edit/builtin:mx-clear", "light", WIDE, follow),
    Shot("editor-surface", "edit/builtin:mx-clear", "dark", WIDE, tab("Surface")),
    Shot("editor-vibration", "edit/builtin:mx-clear", "light", WIDE, tab("Vibration")),
    Shot("editor-tablet", "edit/builtin:mx-blue", "light", TABLET, tab("Figures")),
    Shot("press", "press/builtin:mx-clear", "dark", WIDE, hold),
    Shot("programs", "programs/shipped:multi-level", "light", WIDE, still),
    Shot("programs-dark", "programs/shipped:dwell-ticks", "dark", WIDE, still),
    Shot("optimise", "optimize", "light", WIDE, optimise),
    Shot("optimise-play", "optimize", "dark", WIDE, bullet),
    Shot("optimise-found", "optimize", "light", TABLET, found),
    Shot("live-compensate", "live/compensate", "light", WIDE, learn),
    Shot("live-device", "live/device", "dark", WIDE, connect),
)


FILM = "drag"
FRAMES, FRAME_ms, FILM_px = 26, 90, (720, 405)
POINT = 7
"""Of the press of mx-clear: on its bump."""


def film(page: Page, base: str) -> None:
    """Film a control point of the bump as it is dragged up and down, and the force that the rig renders."""
    page.emulate_media(color_scheme="light", reduced_motion="reduce")
    page.set_viewport_size({"width": WIDE[0], "height": WIDE[1]})
    page.goto("about:blank")
    page.goto(f"{base}/#/edit/builtin:mx-clear")
    follow(page)
    x, y = place_of(page, POINT)
    page.mouse.move(x, y)
    page.mouse.down()
    frames = []
    for i in range(FRAMES):
        page.mouse.move(x, y - 45 * math.sin(2 * math.pi * i / FRAMES))
        # the force that the rig renders follows within some hundredths of a second
        page.wait_for_timeout(250)
        frames.append(Image.open(io.BytesIO(page.screenshot())).convert("RGB").resize(FILM_px))
    page.mouse.up()
    colours = frames[0].quantize(64)
    first, *others = (frame.quantize(palette=colours, dither=Image.Dither.NONE) for frame in frames)
    path = TARGET / f"{FILM}.gif"
    first.save(path, save_all=True, append_images=others, duration=FRAME_ms, loop=0, optimize=True)
    print(path)


def take(page: Page, base: str, shot: Shot) -> None:
    """Make one picture."""
    page.emulate_media(color_scheme="dark" if shot.scheme == "dark" else "light", reduced_motion="reduce")
    page.set_viewport_size({"width": shot.size[0], "height": shot.size[1]})
    page.goto("about:blank")
    page.goto(f"{base}/#/{shot.address}")
    page.wait_for_selector(f"html[data-ready={shot.address.partition('/')[0]}]")
    shot.act(page)
    page.mouse.move(shot.size[0] - 2, shot.size[1] - 2)
    page.wait_for_timeout(400)
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    picture.save(TARGET / f"{shot.name}.png", optimize=True)
    print(TARGET / f"{shot.name}.png")


def main() -> None:
    """Start a studio of its own."""
    TARGET.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        command = [sys.executable, "-m", "fdvv", "studio", "--port", "0", "--no-browser"]
        studio = subprocess.Popen(
            [*command, "--project", f"{folder}/my-buttons"], stdout=subprocess.PIPE, text=True
        )
        try:
            photograph(studio, playwright.chromium.launch(executable_path=shutil.which("chromium")))
        finally:
            studio.terminate()
            studio.wait()


def photograph(studio: subprocess.Popen[str], browser: Browser) -> None:
    """Go through the list, or the names given."""
    assert studio.stdout is not None
    address = studio.stdout.readline().split()[-1]
    page = browser.new_page()
    page.set_default_timeout(20_000)
    page.goto(address)
    for shot in SHOTS:
        if shot.name in sys.argv[1:] or len(sys.argv) == 1:
            take(page, address.partition("/?")[0], shot)
    if FILM in sys.argv[1:] or len(sys.argv) == 1:
        film(page, address.partition("/?")[0])


if __name__ == "__main__":
    main()
