"""The part of the studio that lets a button be pressed, as its page asks."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from starlette.testclient import TestClient, WebSocketTestSession

from fdvv.model.file import load_builtin, model_to_json, save_model
from fdvv.program.file import program_to_json, save_program
from fdvv.program.library import load_shipped
from fdvv_studio.studio.api.press import PressStart, subject_of
from fdvv_studio.studio.studio import Studio
from tests.studio.conftest import LIVE


class Page:
    """One page's end of the channel."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self._socket = socket

    def say(self, kind: str, **more: Any) -> None:
        """Send an ask."""
        self._socket.send_json({"channel": "press", "body": {"type": kind, **more}})

    def until(self, found: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Return the first message for which ``found`` is true."""
        while True:
            message = self._socket.receive_json()
            body = {"error": message["error"]} if "error" in message else message["body"]
            if found(body):
                return dict(body)


def event(kind: str) -> Callable[[dict[str, Any]], bool]:
    """Look for an event in frames."""
    return lambda body: kind in [one["kind"] for one in body.get("events", [])]


@pytest.fixture
def start(client: TestClient) -> Callable[..., None]:
    """Open a page's connection, start something on it, and hand it to work."""

    def begin(work: Callable[[Page, dict[str, Any]], None], **what: Any) -> None:
        with client.websocket_connect(LIVE) as socket:
            page = Page(socket)
            page.say("start", **what)
            work(page, page.until(lambda body: "error" in body or body["type"] == "ready"))

    return begin


def test_what_can_be_pressed_is_listed_with_the_persons_own(client: TestClient, own_studio: Studio) -> None:
    for folder in ("buttons", "programs"):
        (own_studio.project / folder).mkdir(parents=True)
    save_model(load_builtin("mx-red"), own_studio.project / "buttons" / "mine.fdvv.json")
    save_program(load_shipped("button"), own_studio.project / "programs" / "odd.fdvv-program.json")
    found = client.post("/api/press.list", json={}).json()
    assert {"own:mine", "builtin:mx-clear"} <= {item["id"] for item in found["buttons"]}
    assert {"own:odd", "shipped:multi-level"} <= {item["id"] for item in found["programs"]}
    assert all(item["hint"] for item in found["programs"])
    assert found["rigs"] == ["recommended", "light", "paper"]
    assert len(found["traces"]) > 3


def test_a_press_is_led_seen_and_reported(start: Callable[..., None]) -> None:
    def work(page: Page, ready: dict[str, Any]) -> None:
        assert ready["name"] == "mx-clear"
        assert ready["states"] == ["up", "down"]
        assert len(ready["meant"]["press_cN"]) == len(ready["meant"]["displacement_mm"])
        assert ready["signals"][0]["modes"]
        page.say("lead", referent_mm=8.0, velocity_mm_s=0.0, sequence=1)
        down = page.until(event("actuation"))
        assert down["sequence"] == 1
        assert down["key"] == 1
        assert len(down["t_s"]) == len(down["force_cN"]) == len(down["finger_mm"])
        page.say("lift", sequence=2)
        page.until(event("pressed"))
        meant = page.until(lambda body: body.get("type") == "meant")
        assert meant["velocity_mm_s"] > 0
        page.say("stop")
        assert page.until(lambda body: body.get("type") == "over")["reason"] == ""

    start(work, button="builtin:mx-clear")


def test_a_key_of_a_keyboard_presses_the_button_to_where_it_is(start: Callable[..., None]) -> None:
    def work(page: Page, _ready: dict[str, Any]) -> None:
        for number in range(1, 76):
            page.say("follow", displacement_mm=number / 25, velocity_mm_s=10.0, sequence=number)
            time.sleep(0.004)
        page.say("follow", displacement_mm=3.0, velocity_mm_s=0.0, sequence=76)

        def held(body: dict[str, Any]) -> bool:
            # on a busy machine the moves come in leaps, and the finger swings past for a moment
            seen_mm = body.get("displacement_mm") or [0.0, 9.0]
            return body.get("sequence") == 76 and np.ptp(seen_mm) < 0.02 and abs(seen_mm[-1] - 3.0) < 0.2

        assert page.until(held)["key"] == 1
        page.say("follow", displacement_mm=0.0, velocity_mm_s=0.0, sequence=77)
        page.until(event("pressed"))

    start(work, button="builtin:mx-clear")


@pytest.mark.parametrize("what", [{"button": "builtin:mx-clear"}, {"program": "shipped:non-newtonian"}])
def test_forces_are_listed_at_speeds_close_enough_to_interpolate(
    client: TestClient, own_studio: Studio, what: dict[str, Any]
) -> None:
    speeds = client.post("/api/press.forces", json=what).json()["speeds"]
    asked = PressStart(**what)
    subject = subject_of(own_studio, asked)
    velocities = [one["velocity_mm_s"] for one in speeds]
    for speed in (6.0, 37.0, 85.0, 120.0, 260.0, 380.0):
        for name, wanted in zip(("press_cN", "release_cN"), subject.target_cN(speed), strict=True):
            rows = np.array([one[name] for one in speeds])
            found = [np.interp(speed, velocities, column) for column in rows.T]
            assert np.abs(found - wanted).max() < 2.0


def test_documents_that_are_not_kept_yet_can_be_pressed(start: Callable[..., None]) -> None:
    model = msgspec.json.decode(model_to_json(load_builtin("mx-brown")))
    program = msgspec.json.decode(program_to_json(load_shipped("rapid-trigger")))
    names: list[str] = []
    for what in ({"model": model}, {"code": program}):
        start(lambda _page, ready: names.append(ready["name"]), **what)
    assert names == ["mx-brown", "rapid-trigger"]


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ({}, "name one"),
        ({"button": "builtin:mx-clear", "program": "shipped:button"}, "name one"),
        ({"button": "builtin:../../etc"}, "no button is called"),
        ({"button": "own:../secret"}, "no button is called"),
        ({"program": "own:../secret"}, "no such program"),
        ({"program": "shipped:none"}, "use one of"),
        ({"button": "builtin:mx-red", "mode": "rendered", "rig": "/etc/passwd"}, "recommended, light, paper"),
        ({"model": {"format": "nonsense"}}, ""),
    ],
)
def test_what_cannot_be_pressed_is_refused_in_one_line(
    start: Callable[..., None], what: dict[str, Any], said: str
) -> None:
    def work(_page: Page, answer: dict[str, Any]) -> None:
        assert said in answer["error"]
        assert "\n" not in answer["error"]

    start(work, **what)


def test_a_fault_is_reported_with_its_reason_and_cleared_from_the_page(start: Callable[..., None]) -> None:
    def work(page: Page, _ready: dict[str, Any]) -> None:
        page.say("push", force_cN=80.0, sequence=1)
        page.say("fail")
        fell = page.until(event("fault"))
        assert "position_stuck" in next(one["told"] for one in fell["events"] if one["kind"] == "fault")
        assert page.until(lambda body: "mode" in body)["commanded_cN"] == 0.0
        page.say("clear")
        page.until(lambda body: body.get("commanded_cN", 0.0) > 0.0)

    start(work, button="builtin:mx-clear")


def test_a_trace_of_the_page_is_replayed(client: TestClient, start: Callable[..., None]) -> None:
    text = "t_s,displacement_mm\n" + "\n".join(f"{i / 100},{4 if 20 < i < 40 else 0}" for i in range(60))
    trace = client.post("/api/press.trace", json={"name": "mine.csv", "text": text}).json()

    def work(page: Page, _ready: dict[str, Any]) -> None:
        page.say("replay", name="mine.csv", t_s=trace["t_s"], displacement_mm=trace["displacement_mm"])
        page.until(lambda body: body.get("replaying", False))
        page.until(event("actuation"))
        page.until(event("pressed"))

    start(work, program="shipped:button")


def test_a_file_that_is_no_trace_is_refused_in_one_line(client: TestClient) -> None:
    answer = client.post("/api/press.trace", json={"name": "no.csv", "text": "a,b\n1,2\n"})
    assert answer.status_code == 422
    assert "displacement_mm" in answer.json()["error"]


def test_nothing_of_a_press_is_written(own_studio: Studio, start: Callable[..., None]) -> None:
    start(lambda page, _ready: page.say("stop"), button="builtin:mx-red")
    assert not Path(own_studio.project).exists()
