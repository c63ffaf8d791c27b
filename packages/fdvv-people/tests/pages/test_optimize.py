"""The part of the studio in which a person, or a simulated one, plays for a better button."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient, WebSocketTestSession

from fdvv.model.file import load_builtin, model_from_json
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Problem, TrialState
from fdvv_people.optimize.run.begin import read_grid
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.pages import play_trials
from fdvv_people.pages.optimizations import Optimizations
from fdvv_people.pages.rated_trial import rate_trial, waiting_trial
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.rounds import ClockSource, TaskRounds, read_rounds
from fdvv_people.task.score import Objective, Score
from fdvv_studio.studio.studio import Studio
from tests.studio.conftest import LIVE
from tests.support.grids import grid
from tests.support.pressed_rig import KeyedRig

CREATE = {
    "title": "mine",
    "engine": "sobol",
    "space": "paper",
    "preference": False,
    "simulated": False,
    "level": "easy",
    "also": [],
    "start": "builtin:mx-brown",
    "rig": None,
    "seed": 7,
    "budget": 3,
    "task_presses": 2,
}
TICK_ms = 0.25
AHEAD_ms = 1000.0
"""The page's clock of these tests is so far ahead of the server's."""


class Player:
    """One page that plays. ready : the message with which it began."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self._socket, self.late_ms = socket, 0.0
        self.ready: dict[str, Any] = {}

    def say(self, kind: str, **more: Any) -> None:
        """Send an ask on the channel."""
        self._socket.send_json({"channel": "play", "body": {"type": kind, **more}})

    def hear(self, kind: str) -> dict[str, Any]:
        """Return the next message of a kind, or the first error."""
        while True:
            message = self._socket.receive_json()
            body = {"type": "error", **message} if "error" in message else message["body"]
            if body["type"] in (kind, "error", "over"):
                return dict(body)

    def now_ms(self) -> float:
        """Return the page's clock."""
        return 1e3 * time.monotonic() + AHEAD_ms

    def round(self, number: int, press: bool = True) -> dict[str, Any]:
        """Press once, 100 ms before the target is drawn; return the messages about it."""
        start_ms = at_ms = self.now_ms() - self.late_ms
        if press:
            self.say("down", at_ms=at_ms)
            self.say("up", at_ms=at_ms + 150.0)
            self.hear("click")
            time.sleep(0.35)  # until the finger is where it began
        self.say("round", **self.shown(number, start_ms, at_ms + 100.0))
        return self.hear("kept")

    def deeper(self, number: int, actuation_mm: float) -> tuple[dict[str, Any], float]:
        """Press a key at 50 mm/s and let it go; return the message, and when it was at a depth, ms."""
        start_ms = self.now_ms()
        while (since_ms := self.now_ms() - start_ms) < 300.0:
            depth_mm = min(4.0, since_ms / 20.0)
            speed_mm_s = 50.0 if depth_mm < 4.0 else 0.0
            self.say("follow", at_ms=start_ms + since_ms, displacement_mm=depth_mm, velocity_mm_s=speed_mm_s)
            time.sleep(0.004)
        self.say("follow", at_ms=self.now_ms(), displacement_mm=0.0, velocity_mm_s=0.0)
        time.sleep(0.2)
        key = {"hand": "analog", "input": {"ms": 4.0, "error_ms": 3.0}}
        self.say("round", **{**self.shown(number, start_ms, start_ms + 100.0), **key})
        return self.hear("kept"), 20.0 * actuation_mm

    def beside(self, number: int, rig: KeyedRig) -> tuple[dict[str, Any], float]:
        """Wait for a press on the table; return the message about it, and how late it was by the rig."""
        start_ms, before = self.now_ms(), len(rig.pressed_s)
        while len(rig.pressed_s) == before:
            time.sleep(0.01)
        time.sleep(0.1)
        self.say("round", **self.shown(number, start_ms, start_ms + 100.0))
        pressed_ms = 1e3 * rig.pressed_s[before] + AHEAD_ms
        return self.hear("kept"), pressed_ms - start_ms - 100.0 - 30.0

    def shown(self, number: int, start_ms: float, target_ms: float = 0.0) -> dict[str, Any]:
        """Return a round that is over by now."""
        return {
            "number": number,
            "start_ms": start_ms,
            "target_ms": target_ms,
            "end_ms": self.now_ms(),
            "hand": "key",
            "display": {"ms": 30.0, "error_ms": 17.0},
            "input": {"ms": 10.0, "error_ms": 8.0},
            "clock_ms": -AHEAD_ms,
            "clock_error_ms": 0.5,
            "frame_ms": 16.7,
        }


@contextmanager
def playing(client: TestClient, run: int, **more: Any) -> Iterator[Player]:
    """Open a page on the first trial of a run."""
    with client.websocket_connect(LIVE) as socket:
        player = Player(socket)
        player.say("open", run=run, trial=0, **more)
        player.ready = player.hear("ready")
        yield player


@pytest.fixture
def ask(client: TestClient) -> Callable[..., Any]:
    """Ask the part, and return its answer."""

    def answer(name: str, /, **question: Any) -> Any:
        found = client.post(f"/api/optimize.{name}", json=question).json()
        assert "error" not in found, found
        return found

    return answer


@pytest.fixture
def run(ask: Callable[..., Any]) -> int:
    """Begin a run whose first trial waits to be played."""
    begun = int(ask("create", **CREATE)["run"])
    ask("next", run=begun)
    return begun


def play_simulated(ask: Callable[..., Any], run: int, trials: int) -> Any:
    """Let a simulated person play trials of a run; return its detail then."""
    ask("simulate", run=run, person=3, trials=trials)
    while (found := ask("detail", run=run))["simulated"]["running"]:
        time.sleep(0.05)
    return found


def refusal(client: TestClient, name: str, **question: Any) -> str:
    found = client.post(f"/api/optimize.{name}", json=question)
    assert found.status_code in (400, 422)
    return str(found.json()["error"])


def test_what_a_run_can_be_made_of_is_offered(ask: Callable[..., Any]) -> None:
    found = ask("offers")
    assert {"sobol", "gp"} <= {one["name"] for one in found["engines"]}
    assert all(one["told"] for kind in ("engines", "spaces", "levels", "objectives") for one in found[kind])
    assert [one["name"] for one in found["levels"]] == ["easy", "hard"]
    assert "builtin:mx-clear" in {one["name"] for one in found["starts"]}


def test_a_run_begins_from_the_button_it_was_given(ask: Callable[..., Any]) -> None:
    run = ask("create", **CREATE)["run"]
    assert ask("list")["rows"][0]["title"] == "mine"
    assert ask("next", run=run)["trial"] == 0
    found = ask("detail", run=run)
    (trial,) = found["trials"]
    assert trial["origin"] == "start"
    assert trial["design"] == found["start"]
    assert trial["state"] == "suggested"
    assert len(trial["curve"]["force_cN"]) == 40
    assert ask("best", run=run)["design"] is None
    assert found["strip"] == {"pixels": 144, "zone_px": 100, "zone_half_px": 5, "speed_px_s": 100.0}
    model = ask("model", run=run, design=trial["design"], name="the start")["model"]
    assert model["name"] == "the start"
    assert model["actuation_mm"] == trial["design"]["actuation_mm"]


@pytest.mark.parametrize("space", ["FDV", "FDVV"])
def test_variations_of_a_button_begin_with_the_button_itself(ask: Callable[..., Any], space: str) -> None:
    run = ask("create", **{**CREATE, "space": space, "start": "builtin:mx-clear"})["run"]
    ask("next", run=run)
    (trial,) = ask("detail", run=run)["trials"]
    found = model_from_json(json.dumps(ask("model", run=run, design=trial["design"], name="x")["model"]))
    clear = load_builtin("mx-clear")
    x = np.linspace(0.2, 3.8, 50)
    np.testing.assert_allclose(found.force_cN(x, 100.0), clear.force_cN(x, 100.0), atol=1e-6)
    assert found.actuation_mm == clear.actuation_mm


def test_a_suggestion_can_be_edited_until_it_is_shown_and_abandoned(
    ask: Callable[..., Any], client: TestClient
) -> None:
    run = ask("create", **CREATE)["run"]
    number = ask("next", run=run)["trial"]
    design = ask("detail", run=run)["trials"][number]["design"]
    ask("edit", run=run, trial=number, design={**design, "actuation_mm": 1.0})
    (trial,) = ask("detail", run=run)["trials"]
    assert trial["edited"]
    assert trial["design"]["actuation_mm"] == 1.0
    beyond = {**design, "actuation_mm": 99.0}
    assert "99" in refusal(client, "edit", run=run, trial=number, design=beyond)
    ask("abandon", run=run, trial=number)
    assert "abandoned" in refusal(client, "edit", run=run, trial=number, design=design)
    assert ask("next", run=run)["trial"] == number + 1
    assert ask("list")["rows"][0]["spent"] == 1


@pytest.mark.clock
def test_a_press_comes_out_with_the_asynchrony_that_its_times_say(
    run: int, client: TestClient, own_studio: Studio
) -> None:
    with playing(client, run) as player:
        assert (player.ready["rounds"], player.ready["attempt"]) == (2, 1)
        player.say("ping", sent_ms=5.0)
        pong = player.hear("pong")
        assert pong["sent_ms"] == 5.0
        assert abs(pong["server_ms"] - 1e3 * time.monotonic()) < 500
        first, second = player.round(1), player.round(2)
    # the button takes the same time; 140 ms between hand and target, delays of screen and keyboard among them
    assert first["late_ms"] == pytest.approx(second["late_ms"], abs=5.0)
    assert -140 < first["late_ms"] < 0
    assert (first["finished"], second["finished"]) == (False, True)
    assert 0 <= first["transport_ms"] < 200
    with Optimization.open(own_studio.project / "optimize" / str(run)) as session:
        (trial,) = session.trials
        score = trial.scores["asynchrony_ms"]
    assert trial.state is TrialState.DONE
    assert score.value == pytest.approx(-(first["late_ms"] + second["late_ms"]) / 2)
    rounds = TaskRounds(own_studio.project / "optimize" / str(run))
    counting = rounds.counting(0)
    rounds.close()
    assert [one.timing.display_ms for one in counting] == [30.0, 30.0]
    assert TemporalPointing(rounds=2, quantised=False).scores([one.press for one in counting]) == trial.scores


@pytest.mark.clock
def test_a_key_of_a_keyboard_presses_where_it_reaches_the_buttons_actuation(
    ask: Callable[..., Any], run: int, client: TestClient, own_studio: Studio
) -> None:
    actuation_mm = ask("detail", run=run)["trials"][0]["design"]["actuation_mm"]
    with playing(client, run) as player:
        for number in (1, 2):
            found, crossed_ms = player.deeper(number, actuation_mm)
            # less what the browser and the screen are said to take, alike in all rounds
            assert found["late_ms"] == pytest.approx(crossed_ms - 100.0 - 4.0 - 30.0, abs=0.5)
            assert 0 <= found["transport_ms"] < 200
    rounds = TaskRounds(own_studio.project / "optimize" / str(run))
    counting = rounds.counting(0)
    rounds.close()
    assert {(one.timing.source, one.timing.hand) for one in counting} == {(ClockSource.PAGE, "analog")}
    assert [len(one.activations_s) for one in counting] == [1, 1]


@pytest.mark.clock
@pytest.mark.parametrize("way_ms", [0.0, 45.0, 150.0])
def test_a_long_way_from_hand_to_simulation_moves_no_press(
    run: int, client: TestClient, way_ms: float
) -> None:
    """The way down took long, the way up none: still the simulated finger holds as long as the hand did."""
    with playing(client, run) as player:
        wanted = player.round(1)
        player.late_ms = way_ms
        found = player.round(2)
    assert found["late_ms"] == pytest.approx(wanted["late_ms"], abs=2.0)
    assert found["transport_ms"] > way_ms


@pytest.fixture
def table(monkeypatch: pytest.MonkeyPatch) -> Iterator[KeyedRig]:
    """Put a board on the table, on a real terminal line, that somebody presses now and then."""
    rig = KeyedRig(presses=50)
    monkeypatch.setattr(play_trials, "available_devices", lambda: (((f"serial:{rig.path}", "a board"),), ""))
    rig.start()
    yield rig
    rig.end()


@pytest.mark.clock
def test_a_press_on_a_device_is_timed_by_its_own_clock(
    ask: Callable[..., Any], run: int, client: TestClient, own_studio: Studio, table: KeyedRig
) -> None:
    device = ask("devices")["devices"][0]["name"]
    assert device == f"serial:{table.path}"
    with playing(client, run, device=device) as player:
        assert player.ready["told"].endswith("under your own finger")
        kept = [player.beside(number, table) for number in (1, 2)]
        # no other page gets the device while this one has it
        with playing(client, run, device=device) as other:
            assert "the pointing task" in other.ready["error"]
    rounds = TaskRounds(own_studio.project / "optimize" / str(run))
    timing = rounds.counting(0)[0].timing
    rounds.close()
    assert timing.clock_error_ms is not None
    # as exact as the run itself says that the clocks are joined
    bound_ms = timing.input_error_ms + timing.clock_error_ms + TICK_ms
    for found, wanted_ms in kept:
        assert found["late_ms"] == pytest.approx(wanted_ms, abs=bound_ms)
        assert found["transport_ms"] is None
    assert [found["finished"] for found, _ in kept] == [False, True]
    assert not table.port.outputs.enable
    assert (timing.source, timing.hand, timing.input_ms) == (ClockSource.KEY, "button", 0.0)
    assert 0 < timing.input_error_ms < 20


def test_a_device_that_is_not_listed_is_not_opened(run: int, client: TestClient, table: KeyedRig) -> None:
    for device in ("serial:/dev/null", "host", "../etc"):
        with playing(client, run, device=device) as player:
            assert "choose one of the list" in player.ready["error"]
    with playing(client, run, device=f"serial:{table.path}") as player:
        player.say("round", **{**player.shown(1, player.now_ms()), "clock_ms": None})
        assert "is not yet joined" in player.hear("kept")["error"]


def test_a_fault_at_the_stop_costs_no_press(ask: Callable[..., Any], client: TestClient) -> None:
    """A force that falls away throws the finger at the stop, beyond what the sensor may tell."""
    steep = {"x1_mm": 0.7, "x2_mm": 2.3, "x3_mm": 3.5, "y1_cN": 308.0, "y2_cN": 80.0, "y3_cN": 35.0}
    run = ask("create", **{**CREATE, "task_presses": 3})["run"]
    ask("next", run=run)
    ask("edit", run=run, trial=0, design={**steep, "actuation_mm": 3.0, "vibration_mm": 3.0})
    with playing(client, run) as player:
        found = [player.round(number)["late_ms"] for number in (1, 2, 3)]
    assert found == pytest.approx([found[0]] * 3, abs=5.0)


def test_a_round_without_a_press_is_lost_and_a_trial_broken_off_begins_anew(
    ask: Callable[..., Any], run: int, client: TestClient
) -> None:
    with playing(client, run) as player:
        kept = player.round(1, press=False)
        assert (kept["late_ms"], kept["finished"]) == (None, False)
        player.say("close")
        assert player.hear("over")["reason"] == ""
    assert ask("next", run=run)["trial"] == 0
    with playing(client, run) as player:
        assert player.ready["attempt"] == 2
        assert not player.round(1, press=False)["finished"]
        assert player.round(2, press=False)["finished"]
    with playing(client, run) as player:
        assert "done" in player.ready["error"]


def test_the_page_that_plays_last_plays_alone(run: int, client: TestClient) -> None:
    with playing(client, run) as first, playing(client, run) as second:
        assert second.ready["attempt"] == 2
        assert "played elsewhere" in first.round(1, press=False)["error"]
        assert not second.round(1, press=False)["finished"]


def test_a_simulated_person_plays_to_the_end_of_the_budget(
    ask: Callable[..., Any], client: TestClient
) -> None:
    run = ask("create", **{**CREATE, "simulated": True})["run"]
    found = play_simulated(ask, run, 9)
    assert found["simulated"] == {**found["simulated"], "running": False, "done": 3, "fault": ""}
    assert [one["state"] for one in found["trials"]] == ["done"] * 3
    assert ask("best", run=run)["design"].keys() == found["start"].keys()
    assert "all over" in refusal(client, "next", run=run)


def test_a_run_ends_beside_the_switches_if_it_is_asked_to(ask: Callable[..., Any]) -> None:
    offers = ask("offers")
    assert offers["round_s"] == {"easy": 1.44, "hard": 0.96}
    some = {"simulated": True, "retest": 2, "switches": True, "start": "builtin:mx-brown"}
    run = ask("create", **{**CREATE, **some, "space": "FDV"})["run"]
    planned = ask("detail", run=run)["retest"]
    others = [name for name in offers["switches"] if name != "mx-brown"]
    # the start is one of the switches and comes once in a block
    assert (planned["total"], planned["rivals"]) == (2 * 5, others)
    assert (planned["ending"], planned["means"]) == ([], [])
    found = play_simulated(ask, run, 3 + 2 * 5)["retest"]
    assert found["done"] == found["total"]
    (sentence,) = found["ending"]
    assert sentence.startswith("Against the best of ")
    assert ", simulated" in sentence
    names = [one["name"] for one in found["means"]]
    assert names[0] == "recommended"
    assert names[-3:] == others
    assert {one["trials"] for one in found["means"]} == {2}


def test_a_person_plays_the_fixed_design_of_the_papers_space_too(ask: Callable[..., Any]) -> None:
    asked = ask("create", **{**CREATE, "switches": True, "retest": 2})["run"]
    found = ask("detail", run=asked)["retest"]
    assert found["rivals"] == [*ask("offers")["switches"], "the fixed design"]
    assert found["total"] == 2 * 7
    assert ask("detail", run=ask("create", **CREATE)["run"])["retest"]["rivals"] == []


def test_presses_of_people_and_simulated_ones_are_never_mixed(
    ask: Callable[..., Any], client: TestClient
) -> None:
    own, simulated = (ask("create", **{**CREATE, "simulated": who})["run"] for who in (False, True))
    assert "a person plays this run" in refusal(client, "simulate", run=own, person=0, trials=1)
    ask("next", run=simulated)
    with playing(client, simulated) as player:
        assert "a simulated person plays" in player.ready["error"]


def test_a_run_begins_from_what_others_of_the_project_did(
    ask: Callable[..., Any], own_studio: Studio
) -> None:
    assert ask("offers")["others"] == []
    grid(own_studio.project / "others" / "quick", "easy")
    (own_studio.project / "others" / "unfinished").mkdir()
    summary = "5 designs scored by 2 simulated people, easy"
    assert ask("offers")["others"] == [{"name": "quick", "told": summary}]
    run = ask("create", **{**CREATE, "engine": "gp", "start": None, "others": "quick"})["run"]
    assert ask("detail", run=run)["others"] == summary
    ask("next", run=run)
    (first,) = ask("detail", run=run)["trials"]
    prior = read_grid(own_studio.project / "others" / "quick").prior()
    (expected,) = engine_of("gp").suggest(Problem(paper_space(), (Objective("asynchrony_ms"),), 7, prior), ())
    assert first["design"] == pytest.approx(expected)
    alone = ask("create", **CREATE)["run"]
    assert ask("detail", run=alone)["others"] == ""


@pytest.mark.parametrize(
    ("name", "question", "said"),
    [
        ("detail", {"run": 1}, "there is none"),
        ("next", {"run": 99}, "there is none"),
        ("create", {**CREATE, "engine": "none"}, "use one of"),
        ("create", {**CREATE, "start": "own:../x"}, "no button is called"),
        ("create", {**CREATE, "also": ["beauty"]}, "beauty"),
        ("create", {**CREATE, "budget": 0}, "budget"),
        ("create", {**CREATE, "space": "FDV", "start": None}, "choose one"),
        ("create", {**CREATE, "space": "none"}, "no such space"),
        ("create", {**CREATE, "rig": "../x"}, "rig"),
        ("create", {**CREATE, "others": "../x"}, "is no finished grid in the project's folder others"),
        ("create", {**CREATE, "others": "easy", "space": "FDV"}, "scored designs of the space paper"),
    ],
)
def test_impossible_requests_are_refused_in_one_line(
    client: TestClient, own_studio: Studio, name: str, question: dict[str, Any], said: str
) -> None:
    assert said in refusal(client, name, **question)
    assert not (own_studio.project / "optimize").exists()


def test_a_damaged_run_is_marked_in_the_list_and_hurts_no_other(
    ask: Callable[..., Any], own_studio: Studio
) -> None:
    first, second = ask("create", **CREATE)["run"], ask("create", **CREATE)["run"]
    (own_studio.project / "optimize" / str(first) / "optimize.json").write_text("{}")
    rows = {row["run"]: row["problem"] for row in ask("list")["rows"]}
    assert rows[second] == ""
    assert rows[first]


@pytest.mark.parametrize("also", [[], ["lost_ratio"]])
def test_two_designs_are_compared_until_the_budget_is_spent(
    ask: Callable[..., Any], client: TestClient, also: list[str]
) -> None:
    some = {"engine": "preference", "budget": 2, "start": None, "retest": 1}
    wanted = {**CREATE, "preference": True, "also": also, **some}
    run = ask("create", **wanted)["run"]
    for number, best in enumerate(([1], [0, 1])):
        assert ask("next", run=run) == ask("next", run=run) == {"run": run, "trial": number}
        ask("answer", run=run, trial=number, best=best)
    found = ask("detail", run=run)
    assert [one["answer"] for one in found["pairs"]] == ["second", "equal"]
    assert found["row"]["spent"] == 2
    assert found["start"] == found["pairs"][0]["first"]
    assert ask("best", run=run)["design"].keys() == found["start"].keys()
    retested = ask("next", run=run)["trial"]
    assert retested == 2
    ask("answer", run=run, trial=retested, best=[0])
    assert "all over" in refusal(client, "next", run=run)
    assert ask("detail", run=run)["retest"]["done"] == 1
    assert "answered" in refusal(client, "answer", run=run, trial=0, best=[0])


def test_lines_are_answered_until_the_budget_is_spent_and_the_result_is_compared(
    ask: Callable[..., Any], client: TestClient
) -> None:
    assert [one["name"] for one in ask("offers")["line_engines"]] == ["preference-line"]
    some = {"engine": "preference-line", "budget": 2, "start": None, "retest": 1}
    run = ask("create", **{**CREATE, "preference": True, **some})["run"]
    for number, best in enumerate((8, 3)):
        assert ask("next", run=run) == ask("next", run=run) == {"run": run, "trial": number}
        assert "designs 0 to 8" in refusal(client, "answer", run=run, trial=number, best=[9])
        ask("answer", run=run, trial=number, best=[best])
    found = ask("detail", run=run)
    assert found["on_lines"]
    assert [one["best"] for one in found["lines"]] == [8, 3]
    assert (found["row"]["spent"], found["searched"], found["pairs"]) == (2, True, [])
    assert found["start"] == found["lines"][0]["stops"][4]
    assert ask("best", run=run)["design"] in [stop for one in found["lines"] for stop in one["stops"]]
    assert "was answered" in refusal(client, "answer", run=run, trial=0, best=[1])
    ask("answer", run=run, trial=ask("next", run=run)["trial"], best=[0])
    assert "all over" in refusal(client, "next", run=run)
    assert ask("detail", run=run)["retest"]["done"] == 1


def test_several_objectives_make_a_front_to_pick_from(ask: Callable[..., Any], own_studio: Studio) -> None:
    many = {**CREATE, "also": ["lost_ratio"], "simulated": True, "engine": "random"}
    run = ask("create", **many)["run"]
    scores = [(60.0, 0.2), (80.0, 0.0), (90.0, 0.3)]
    with Optimization.open(own_studio.project / "optimize" / str(run)) as session:
        for number, (late_ms, lost) in enumerate(scores):
            session.ask()
            session.show(number)
            session.answer(number, {"asynchrony_ms": Score(late_ms), "lost_ratio": Score(lost)})
    found = ask("detail", run=run)
    assert [one["front"] for one in found["trials"]] == [True, True, False]
    assert ask("best", run=run)["design"] in [one["design"] for one in found["trials"][:2]]


WISHES = {
    **CREATE,
    "engine": "sobol",
    "also": ["liking"],
    "retest": 2,
    "budget": 2,
    "start": "builtin:mx-brown",
}


def pressed_to_the_end(client: TestClient, run: int) -> dict[str, Any]:
    """Play both rounds of the first trial without a press; return what is said of the last."""
    with playing(client, run) as player:
        player.round(1, press=False)
        return player.round(2, press=False)


def test_a_trial_counts_once_its_questions_are_answered_and_they_are_on_the_disk(
    ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    run = ask("create", **WISHES)["run"]
    ask("next", run=run)
    asked = ask("detail", run=run)["questions"]
    assert (asked["trial"], asked["least"], asked["most"], len(asked["items"])) == (None, 1, 7, 4)
    assert "waits for no answers" in refusal(client, "rate", run=run, trial=0, answers=[4, 4, 4, 4])
    assert pressed_to_the_end(client, run)["finished"]
    found = ask("detail", run=run)
    assert (found["trials"][0]["state"], found["questions"]["trial"]) == ("shown", 0)
    with playing(client, run) as player:
        assert "waits for answers" in player.ready["error"]
    assert "from 1 to 7" in refusal(client, "rate", run=run, trial=0, answers=[4, 4, 4, 8])
    ask("rate", run=run, trial=0, answers=[4, 5, 6, 7])
    found = ask("detail", run=run)
    assert found["questions"]["trial"] is None
    assert found["trials"][0]["scores"]["liking"]["value"] == 5.5
    text = (own_studio.project / "optimize" / str(run) / "rounds.jsonl").read_text()
    assert '"answers": [4, 5, 6, 7]' in text or '"answers":[4,5,6,7]' in text


def test_a_studio_that_was_killed_before_the_answers_asks_again_and_loses_no_press(
    ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    """What a killed studio leaves: presses on the disk, and a trial that was shown and never scored."""
    run = ask("create", **WISHES)["run"]
    ask("next", run=run)
    pressed_to_the_end(client, run)
    before = (own_studio.project / "optimize" / str(run) / "rounds.jsonl").read_bytes()
    other = Optimizations(own_studio)
    with other.session(run) as session:
        waiting = waiting_trial(session, read_rounds(other.folder(run)))
    assert waiting is not None
    rate_trial(other, run, waiting.number, [6, 6, 6, 6])
    after = (own_studio.project / "optimize" / str(run) / "rounds.jsonl").read_bytes()
    assert after.startswith(before)
    (trial,) = ask("detail", run=run)["trials"]
    assert trial["state"] == "done"
    assert trial["scores"]["asynchrony_ms"]["value"] == 400.0


def test_a_compromise_is_taken_from_the_front_and_played_again_with_its_questions(
    ask: Callable[..., Any], client: TestClient
) -> None:
    run = ask("create", **{**WISHES, "simulated": True, "budget": 6, "retest": 2})["run"]
    assert ask("detail", run=run)["compromise"] is None
    found = play_simulated(ask, run, 6)
    front = [one for one in found["trials"] if one["front"]]
    assert found["compromise"] in [one["number"] for one in front]
    assert all(set(one["expected"]) == {"asynchrony_ms", "liking"} for one in front)
    other = front[-1]["number"]
    ask("take", run=run, trial=other)
    found = ask("detail", run=run)
    assert found["compromise"] == other
    assert ask("best", run=run)["design"] == found["trials"][other]["design"]
    retest = play_simulated(ask, run, 4)["retest"]
    assert (retest["done"], retest["total"]) == (4, 4)
    assert "liking" in retest["sentence"] or "liked" in retest["sentence"]
    assert "between the search and its retest" in refusal(client, "take", run=run, trial=other)


def test_others_who_were_asked_nothing_are_no_beginning_for_several_wishes(
    ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    grid(own_studio.project / "others" / "easy", "easy")
    asked = {**WISHES, "others": "easy"}
    assert "others scored asynchrony alone" in refusal(client, "create", **asked)
