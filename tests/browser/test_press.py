"""The page on which a button is pressed, worked by keys, mouse and pen as a person works it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view
from playwright.sync_api import expect

from fdvv.model.file import load_builtin
from fdvv.vibration.wave import vibration_samples
from tests.browser.pressing import DOWN, LAMP, UP, presses, ready
from tests.browser.wire import Wire

if TYPE_CHECKING:
    from playwright.sync_api import Page

HEAD_bytes, RATE_Hz = 44, 48_000


class PressWire(Wire):
    """The channel of presses."""

    def __init__(self, page: Page) -> None:
        super().__init__(page, "press")

    def events(self, kind: str) -> list[dict[str, Any]]:
        return [e for body in self.heard for e in body.get("events", []) if e["kind"] == kind]


@pytest.fixture
def wire(page: Page) -> PressWire:
    """The press page, with a button under the finger, and the messages it receives."""
    heard = PressWire(page)
    page.goto(f"{page.url.partition('#')[0]}#/press/builtin:mx-clear")
    page.reload()
    page.wait_for_selector("html[data-ready=press]")
    ready(page)
    return heard


def value(page: Page, name: str) -> str:
    return page.inner_text(f"[data-value='{name}']")


def place(page: Page, part: float) -> tuple[float, float]:
    """Return a point on the stage: at a part of its height from the top, at the finger's middle."""
    box = page.locator(".press-view").bounding_box()
    assert box is not None
    return box["x"] + 0.42 * box["width"], box["y"] + part * box["height"]


def test_the_space_bar_presses_as_long_as_it_is_held(page: Page, wire: PressWire) -> None:
    for count in (1, 2):
        page.keyboard.down(" ")
        page.wait_for_selector(DOWN)
        page.keyboard.up(" ")
        page.wait_for_selector(UP)
        presses(page, count)
        assert value(page, "actuations") == str(count)
    assert value(page, "last-press").endswith("mm/s")
    actuation_mm = load_builtin("mx-clear").actuation_mm
    assert wire.events("actuation")[0]["displacement_mm"] == pytest.approx(actuation_mm, abs=0.05)


def test_what_a_press_found_is_said_with_the_next_step(page: Page, wire: PressWire) -> None:
    verdict = page.get_by_label("Verdict")
    expect(verdict).to_have_text(re.compile("Hold the space bar, or press the cap"))
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")
    expect(verdict).to_contain_text("let go")
    found = re.search(
        r"Clicked at (.*) mm under (.*) cN; it let go at (.*) mm. Simulated.", verdict.inner_text()
    )
    assert found is not None
    places = [wire.events(kind)[0]["displacement_mm"] for kind in ("actuation", "reset")]
    assert [float(found[1]), float(found[3])] == pytest.approx(places, abs=0.06)
    curve = load_builtin("mx-clear").nearest("press", 0.5)
    assert curve is not None
    force_cN = curve.force_cN(places[0])
    assert float(found[2]) == pytest.approx(force_cN, abs=8)
    verdict.get_by_role("link", name="Render it on a rig").click()
    page.wait_for_url("**/#/live/compensate?button=builtin*mx-clear*")


def test_the_button_that_is_worked_on_is_under_the_finger(page: Page, wire: PressWire) -> None:
    page.select_option("select >> nth=0", "button builtin:mx-red")
    page.wait_for_selector(".press-view[aria-label^='mx-red']")
    page.goto(f"{page.url.partition('#')[0]}#/library")
    page.wait_for_selector("html[data-ready=library]")
    page.goto(f"{page.url.partition('#')[0]}#/press")
    page.wait_for_selector(".press-view[aria-label^='mx-red']")


def test_the_finger_follows_the_mouse_down_and_up(page: Page, wire: PressWire) -> None:
    page.mouse.move(*place(page, 0.1))
    page.mouse.down()
    page.mouse.move(*place(page, 0.97), steps=10)
    page.wait_for_selector(DOWN)
    page.mouse.move(*place(page, 0.1), steps=10)
    page.wait_for_selector(UP)
    page.mouse.up()
    # a hand that lingers near the point closes the key more than once
    assert int(value(page, "actuations")) == len(wire.events("actuation")) >= 1
    assert len(wire.events("reset")) == len(wire.events("actuation"))


def test_a_held_cap_is_pushed_harder_until_it_gives_way(page: Page, wire: PressWire) -> None:
    page.mouse.move(*place(page, 0.5))
    page.mouse.down()
    page.wait_for_selector(DOWN)
    page.mouse.up()
    page.wait_for_selector(UP)
    deepest = max(x for body in wire.heard for x in body.get("displacement_mm", []))
    assert deepest > load_builtin("mx-clear").travel_mm / 2


def test_a_pen_pushes_as_hard_as_it_is_pressed(page: Page, wire: PressWire) -> None:
    x, y = place(page, 0.4)
    pen = """([kind, pressure, clientX, clientY]) => document.querySelector('.press-view').dispatchEvent(
        new PointerEvent(kind, {pointerType: 'pen', pointerId: 1, pressure, clientX, clientY}))"""
    # a pen that is made up cannot be captured
    page.evaluate("() => { Element.prototype.setPointerCapture = () => undefined; }")
    page.evaluate("() => { Element.prototype.hasPointerCapture = () => true; }")
    page.evaluate(pen, ["pointerdown", 0.05, x, y])
    page.evaluate(pen, ["pointermove", 0.8, x, y])
    page.wait_for_selector(DOWN)
    page.evaluate(pen, ["pointermove", 0.02, x, y])
    page.wait_for_selector(UP)
    page.evaluate(pen, ["pointerup", 0.0, x, y])


def test_arrows_push_the_cap_and_escape_lets_it_go(page: Page, wire: PressWire) -> None:
    page.focus(".press-view")
    for _ in range(75):
        page.keyboard.press("ArrowDown")
    page.wait_for_selector(DOWN)
    page.keyboard.press("Escape")
    page.wait_for_selector(UP)


def test_the_click_that_is_saved_is_the_models_vibration(page: Page, wire: PressWire) -> None:
    """What an offline context renders through the graph that is played, against fdvv.vibration."""
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")
    presses(page, 1)
    page.click("text=Advanced")
    with page.expect_download() as saved:
        page.click("text=Save the click")
    heard = np.frombuffer(saved.value.path().read_bytes()[HEAD_bytes:], "<f4").astype(float)
    meant = vibration_samples(load_builtin("mx-clear").vibrations[0], RATE_Hz)
    assert heard.size == meant.size
    gain = float(heard @ meant / (meant @ meant))
    assert np.sqrt(np.mean((heard - gain * meant) ** 2)) < 1e-3 * gain * np.sqrt(np.mean(meant**2))
    speed = wire.events("pressed")[0]["velocity_mm_s"]
    assert gain == pytest.approx(min(3.0, max(1 / 3, speed / 100)) / 20, rel=1e-3)
    onset = [np.argmax(np.abs(wave) > 0.02 * np.abs(wave).max()) / RATE_Hz for wave in (heard, gain * meant)]
    assert abs(onset[0] - onset[1]) < 1e-3


def test_clicks_are_scheduled_as_far_apart_as_the_cap_shook(page: Page) -> None:
    """The moments for which the loudspeaker is asked, against the simulated ones, over a drumming finger."""
    page.add_init_script(
        """window.asked = []; const start = AudioBufferSourceNode.prototype.start;
        AudioBufferSourceNode.prototype.start = function (when) {
          window.asked.push(when); return start.call(this, when); };"""
    )
    heard = PressWire(page)
    page.goto(f"{page.url.partition('#')[0]}#/press/builtin:mx-clear")
    page.reload()
    ready(page)
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")
    page.wait_for_selector(UP)
    page.click("text=Replay a key")
    apart_s = np.inf
    for count in range(9, 90, 8):
        page.click("button:text-is('drumming')")
        presses(page, count)
        asked = np.array(page.evaluate("window.asked"))
        off = asked - [event["t_s"] for event in heard.events("vibration")][-len(asked) :]
        # a loudspeaker without hardware stops its clock on a busy machine: eight in a row without that
        apart_s = float(np.ptp(sliding_window_view(off, 8), axis=1).min())
        if apart_s < 1e-3:
            break
    assert apart_s < 1e-3


def test_a_trace_is_replayed(page: Page, wire: PressWire, tmp_path: Path) -> None:
    page.click("text=Replay a key")
    page.click("button:text-is('fast double tap')")
    presses(page, 2)
    assert len(wire.events("actuation")) == 2
    rows = "\n".join(f"{i / 100},{4 if 20 < i < 40 else 0}" for i in range(60))
    path = tmp_path / "mine.csv"
    path.write_text(f"t_s,displacement_mm\n{rows}\n")
    page.set_input_files("main input[type=file]", path)
    presses(page, 3)
    assert page.is_visible("button:text-is('mine.csv')")


def test_a_page_that_is_hidden_is_not_simulated_for(page: Page, wire: PressWire) -> None:
    page.evaluate("Object.defineProperty(document, 'hidden', {get: () => window.away, configurable: true})")
    turn = "away => { window.away = away; document.dispatchEvent(new Event('visibilitychange')); }"
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.evaluate(turn, True)
    page.wait_for_selector("text=paused")
    # that nothing comes can only be seen by letting time pass
    page.wait_for_timeout(200)
    before = len(wire.heard)
    page.wait_for_timeout(500)
    assert len(wire.heard) == before, "frames came although nobody looked"
    page.evaluate(turn, False)
    page.wait_for_selector(UP)
    times = [t for body in wire.of("frame") for t in body["t_s"]]
    assert np.diff(times).max() < 0.01, "simulated time stood still"
    page.keyboard.up(" ")


def test_a_fault_says_why_and_is_cleared(page: Page, wire: PressWire) -> None:
    page.click("text=Advanced")
    page.click("text=Break its sensor")
    page.wait_for_selector(".press-fault")
    assert "position_stuck" in page.inner_text(".press-fault")
    page.click("text=Clear the fault")
    page.wait_for_selector(".press-fault", state="detached")
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")


def test_two_buttons_are_exchanged_under_a_pressing_finger(page: Page, wire: PressWire) -> None:
    page.keyboard.down(" ")
    page.wait_for_selector(DOWN)
    page.keyboard.press("x")
    page.wait_for_selector("button[aria-pressed=true]:has-text('mx-brown')")
    page.wait_for_selector(".press-view[aria-label^='mx-brown']")
    page.wait_for_selector(DOWN)
    page.keyboard.up(" ")
    page.wait_for_selector(UP)


def test_a_program_tells_its_levels_and_what_to_try(page: Page, wire: PressWire) -> None:
    page.select_option("select >> nth=0", "program shipped:multi-level")
    page.wait_for_selector("text=three key levels")
    page.wait_for_selector("[data-value=state]:has-text('level 0')")
    page.keyboard.down(" ")
    page.wait_for_selector(f"{LAMP}[data-key='3']:has-text('level 3')")
    page.keyboard.up(" ")
    page.wait_for_selector("[data-value=state]:has-text('level 0')")


def test_an_address_that_names_no_button_is_reported_and_another_can_be_chosen(page: Page) -> None:
    page.goto(f"{page.url.partition('#')[0]}#/press/own:nobody")
    page.wait_for_selector(".press-standing:has-text('no button is called')")
    page.select_option("select >> nth=0", "button builtin:mx-red")
    ready(page)
    page.wait_for_selector(".press-view[aria-label^='mx-red']")
