"""The channel of a timing study, asked as its page asks: rounds on the disk, latencies, who may come back."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

from fdvv_people.pages.studies import Studies
from fdvv_people.study.admin.study import Study
from fdvv_studio.studio.studio import Studio
from tests.browser.study_screens import NAME, PASSPHRASE
from tests.browser.timing_screens import frozen_timing, recorded, timing_text
from tests.pages.screens import Page
from tests.studio.conftest import LIVE
from tests.support.pressed_rig import KeyedRig

PRESSES = 2
DISPLAY_ms, INPUT_ms = 30.0, 10.0


class Screen(Page):
    """A page on which presses are timed."""

    channel = "timing"

    def begin(self) -> dict[str, Any]:
        """Begin the trial of the step, with what it asks for under the finger."""
        if self.step["kind"] == "place":
            self.say("placed", number=self.step["trial"]["number"])
            self.hear("step")
        self.say("begin", number=self.step["trial"]["number"])
        heard = self.hear("ready", "step")
        # of the designs that training draws 1 in 150 cannot be held, and its trial is given up
        return self.begin() if heard["type"] == "step" else heard

    def round(self, number: int, press: bool = True, **more: Any) -> dict[str, Any]:
        """Press 100 ms before the target is drawn; return what is said of the round."""
        start_ms = 1e3 * time.monotonic()
        if press:
            self.say("down", at_ms=start_ms + 1.0)
            self.say("up", at_ms=start_ms + 250.0)
            time.sleep(0.6)  # until the finger is where it began, on a busy machine too
        over = {
            "number": number,
            "start_ms": start_ms,
            "target_ms": start_ms + 101.0,
            "end_ms": 1e3 * time.monotonic(),
            "hand": "key",
            "display": {"ms": DISPLAY_ms, "error_ms": 17.0},
            "input": {"ms": INPUT_ms, "error_ms": 8.0},
            "clock_ms": 0.0,
            "clock_error_ms": 0.5,
            "frame_ms": 16.7,
        }
        self.say("round", **{**over, **more})
        return self.hear("kept")

    def trial(self) -> None:
        """Play a trial to its end."""
        kept = self.begin()["kept"]
        for number in range(kept + 1, PRESSES + 1):
            self.round(number)
        self.hear("step")


@pytest.fixture
def study(own_studio: Studio) -> Study:
    """A frozen study of one trial of training and three of validation; its sessions are open."""
    study = frozen_timing(own_studio.project, timing_text(1, PRESSES, pages=False))
    own_studio.part(Studies).open_sessions(NAME, PASSPHRASE, None)
    return study


@pytest.fixture
def screen(study: Study, ask: Callable[..., Any], client: TestClient) -> Iterator[Screen]:
    """The screen of somebody who sat down."""
    with client.websocket_connect(LIVE) as socket:
        found = Screen(socket)
        found.sit(ask("seat")["seat"])
        yield found


def test_a_page_learns_on_the_channel_of_every_study_which_screens_it_needs(
    study: Study, client: TestClient
) -> None:
    with client.websocket_connect(LIVE) as socket:
        page = Screen(socket)
        page.say("look", "study", study=NAME, seat="", holder=page.holder)
        assert page.hear("about")["kind"] == "timing"
        page.say("sit", "study", study=NAME, seat="", holder=page.holder, language="en")
        assert "seat" in page.hear("card")["error"]


def test_a_round_is_on_the_disk_when_it_is_said_to_be_kept(study: Study, screen: Screen) -> None:
    ready = screen.begin()
    assert (ready["kept"], ready["rounds"], ready["on"]) == (0, PRESSES, "page")
    for number in range(1, PRESSES + 1):
        found = screen.round(number)
        assert found["number"] == number
        assert found["finished"] == (number == PRESSES)
        assert "late_ms" not in found
        assert [one["round"] for one in recorded(study, "round")] == list(range(1, number + 1))
    assert screen.hear("step")["trial"]["phase"] == "validation"
    assert len(recorded(study, "scored")) == 1


def test_a_press_of_a_simulated_button_counts_without_the_way_to_it(study: Study, screen: Screen) -> None:
    screen.begin()
    found = screen.round(1)
    (kept,) = recorded(study, "round")
    late_ms = 1e3 * (kept["activations_s"][0] - kept["target_s"])
    # less what is stated of screen and key; the simulated key goes down while the hand holds it
    assert -100.0 < late_ms + DISPLAY_ms + INPUT_ms < 150.0 + 100.0
    assert kept["timing"]["transport_ms"] == found["transport_ms"]
    assert kept["timing"]["hand"] == "key"


def test_a_round_that_is_not_the_next_one_is_not_kept(study: Study, screen: Screen) -> None:
    screen.begin()
    screen.round(1)
    screen.say("round", **screen_round(1))
    # the page fell behind and gets the step that it is at
    assert screen.hear("step")["trial"]["kept"] == 1
    assert [one["round"] for one in recorded(study, "round")] == [1]


def screen_round(number: int) -> dict[str, Any]:
    """Return a round without a press."""
    delay = {"ms": 0.0, "error_ms": 0.0}
    times = {"start_ms": 1.0, "target_ms": 2.0, "end_ms": 3.0, "frame_ms": 16.7}
    clock = {"clock_ms": None, "clock_error_ms": None}
    return {"number": number, "hand": "key", "display": delay, "input": delay, **times, **clock}


def test_a_trial_that_was_broken_off_goes_on_for_who_has_the_card(
    study: Study, screen: Screen, client: TestClient
) -> None:
    screen.begin()
    screen.round(1)
    with client.websocket_connect(LIVE) as socket:
        other = Screen(socket)
        other.resume({**screen.card, "code": "AAAA-AAAA-AAAA"})
        assert other.step == {}
        assert other.resume(screen.card)["trial"]["kept"] == 1
        assert "another screen" in screen.hear("stopped")["reason"]
        assert other.begin()["kept"] == 1
        assert other.round(2)["finished"]
    assert [(one["attempt"], one["round"]) for one in recorded(study, "round")] == [(1, 1), (2, 2)]


def test_of_a_switch_the_latency_counts_that_the_plan_states_and_of_a_key_that_of_the_page(
    study: Study, screen: Screen
) -> None:
    screen.trial()
    for _ in range(3):
        screen.trial()
    assert screen.step["kind"] == "done"
    (began,) = recorded(study, "began")
    hands = {one["number"]: one["hand"] for one in began["trials"]}
    found = {hands[one["number"]]: one["timing"] for one in recorded(study, "round")}
    assert {hand: (one["hand"], one["input_ms"]) for hand, one in found.items()} == {
        "button": ("key", INPUT_ms),
        "switch": ("switch", 1.0),
        "key": ("key", INPUT_ms),
    }
    for one in recorded(study, "round"):
        if hands[one["number"]] != "button":
            late_ms = 1e3 * (one["activations_s"][0] - one["target_s"])
            assert late_ms == pytest.approx(-100.0 - DISPLAY_ms - one["timing"]["input_ms"], abs=1e-6)
    assert study.verify() == ()


@pytest.fixture
def tapping(own_studio: Studio) -> Study:
    """A frozen study of tapping on two programs; its sessions are open."""
    plan = timing_text(tapping=True, pages=False).partition("[[conditions]]")[0]
    for name in ("fast-tapping", "rapid-trigger"):
        plan += f'[[conditions]]\nname = "{name}"\nkind = "program"\nbutton = "{name}"\n'
    study = frozen_timing(own_studio.project, plan)
    own_studio.part(Studies).open_sessions(NAME, PASSPHRASE, None)
    return study


@pytest.mark.clock
def test_taps_on_the_twin_keep_the_hand_s_times_even_where_they_come_all_at_once(
    tapping: Study, client: TestClient, ask: Callable[..., Any]
) -> None:
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        screen.sit(ask("studies.seat")["seat"])
        assert screen.begin()["rounds"] == 3
        taps_ms = 1e3 * time.monotonic() + 125.0 * np.arange(8)
        for at_ms in taps_ms.tolist():
            screen.say("down", at_ms=at_ms)
            screen.say("up", at_ms=at_ms + 40.0)
        time.sleep(2.5)  # until they were all made, on a busy machine too
        for number, start_ms in enumerate(taps_ms[0] + 1e3 * np.arange(3), start=1):
            over = screen_round(number) | {
                "start_ms": start_ms,
                "end_ms": start_ms + 999.9,
                "target_ms": None,
            }
            screen.say("round", **over)
            screen.hear("kept")
    keys_s = np.concatenate([one["activations_s"] for one in recorded(tapping, "round")])
    assert keys_s.size == taps_ms.size
    delays_s = keys_s - 1e-3 * taps_ms
    assert 0.003 < delays_s.min() < delays_s.max() < 0.03
    assert np.ptp(delays_s[1:]) < 0.004


def test_a_round_without_a_press_is_a_miss_and_is_kept(study: Study, screen: Screen) -> None:
    screen.begin()
    screen.round(1, press=False)
    assert [one["activations_s"] for one in recorded(study, "round")] == [[]]


@pytest.mark.clock
def test_a_device_on_the_table_tells_the_presses_itself(
    study: Study, screen: Screen, ask: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = KeyedRig(presses=50)
    rig.start()
    device = f"serial:{rig.path}"
    monkeypatch.setattr(
        "fdvv_people.pages.play_trials.available_devices", lambda: (((device, "a board"),), ())
    )
    monkeypatch.setattr("fdvv_people.pages.api.study_people.device_names", lambda: (device,))
    assert ask("studies.use", device=device)["device"] == device
    ready = screen.begin()
    assert (ready["on"], ready["signals"]) == ("device", [])
    start_ms, before = 1e3 * time.monotonic(), len(rig.pressed_s)
    while len(rig.pressed_s) == before:
        time.sleep(0.01)
    time.sleep(0.1)
    screen.round(1, press=False, start_ms=start_ms, target_ms=start_ms + 100.0, hand="button")
    (kept,) = recorded(study, "round")
    assert kept["activations_s"][0] == pytest.approx(rig.pressed_s[before], abs=0.01)
    assert (kept["timing"]["source"], kept["timing"]["hand"]) == ("key", "button")
    rig.end()


def test_a_device_that_is_not_there_is_said_in_one_line_and_nothing_is_begun(
    study: Study, screen: Screen, own_studio: Studio
) -> None:
    own_studio.part(Studies).use_device(NAME, "serial:/dev/none", ("serial:/dev/none",))
    screen.say("begin", number=0)
    assert "device" in screen.hear("ready")["error"]
    assert recorded(study, "begun") == []


def test_the_operator_sees_how_far_and_when_but_no_condition(
    study: Study, screen: Screen, ask: Callable[..., Any]
) -> None:
    assert ask("studies.detail")["row"]["kind"] == "timing"
    screen.trial()
    (one,) = ask("timing.progress")["people"]
    assert (one["person"], one["phase"], one["rounds"]) == ("P01", "due", PRESSES)
    (row,) = ask("studies.detail")["people"]
    assert (row["state"], row["answered"], row["trials"], row["here"]) == ("due", 1, 4, True)
    assert "0 of 2" in ask("studies.standing")["sentence"]
    assert ask("studies.verify")["problems"] == []


def test_what_the_codes_hid_is_opened_for_the_key_holder_and_reported(
    study: Study, screen: Screen, ask: Callable[..., Any]
) -> None:
    for _ in range(4):
        screen.trial()
    found = ask("studies.unseal", passphrase=PASSPHRASE, who="A", why="a test")
    assert (found["rows"], found["excluded"]) == (3, 0)
    assert ask("studies.detail")["row"]["state"] == "unsealed"
    report = ask("studies.report")
    assert report["name"] == f"{NAME}-report.html"
    assert all(name in report["html"] for name in ("MX Red", "MX Brown", "own keyboard", study.fingerprint))
    assert ask("studies.standing")["sentence"] == "The study is open; it claims nothing, so read its report."


def test_a_pause_of_the_operator_begins_no_trial_and_loses_no_round(
    study: Study, screen: Screen, ask: Callable[..., Any]
) -> None:
    screen.begin()
    ask("studies.pause", person=None, on=True)
    assert screen.hear("paused")["on"]
    assert screen.round(1)["number"] == 1
    screen.say("begin", number=0)
    assert "pauses" in screen.hear("ready")["error"]


@pytest.mark.parametrize("kind", ["timing", "tapping"])
def test_a_template_is_declared_ready_to_be_frozen_and_says_what_it_comes_to(
    own_studio: Studio, client: TestClient, kind: str
) -> None:
    def ask(name: str, /, **question: Any) -> Any:
        found = client.post(f"/api/studies.{name}", json=question).json()
        assert "error" not in found, found
        return found

    ask("create", name="fresh", template=kind)
    plan = ask("plan", study="fresh")
    assert [one["title"] for one in plan["preview"]] == ["One person", "Compared"]
    assert ask("standing", study="fresh")["sentence"].startswith("Ready to freeze: 12 participants")
    assert ask("detail", study="fresh")["row"]["kind"] == kind
    tried = ask("rehearse", study="fresh")
    with client.websocket_connect(LIVE) as socket:
        page = Screen(socket)
        page.say("look", **tried, holder=page.holder)
        assert page.hear("about")["seat"]
    wrong = plan["text"].replace("rounds = ", "rounds = 0 #")
    assert any("rounds" in line for line in ask("write", study="fresh", text=wrong, keep=False)["problems"])
