"""A participant's screen and the operator's, asked as their pages ask: who sits where, and what is sent."""

from __future__ import annotations

import json
import secrets
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from starlette.testclient import TestClient

from fdvv.errors import InputError
from fdvv_people.pages.api.study import StudyScreen
from fdvv_people.pages.participant.messages import StudyResume
from fdvv_people.pages.studies import DEVICE_SUFFIX, Studies
from fdvv_people.study.admin.study import Study
from fdvv_studio.studio.studio import Studio
from tests.browser.study_screens import NAME, PASSPHRASE, frozen_study, names_in, plan_text
from tests.pages.screens import Page
from tests.studio.conftest import LIVE

SAME = ("about", "card", "step", "ready", "felt", "broke", "paused", "stopped", "error")


class Screen(Page):
    """A page on which labels are felt and answered."""

    def feel(self, label: str) -> dict[str, Any]:
        """Have a label under the hand; return what is sent about it."""
        self.say("go", label=label)
        return self.hear("felt")

    def show(self) -> dict[str, Any]:
        """Show the trial that the step names; return what is sent about it."""
        self.say("shown", number=self.step["task"]["number"])
        return self.hear("ready")

    def answer(self, choice: str = "A", **more: Any) -> dict[str, Any]:
        """Answer the trial that the step tells; return the next step, or the error."""
        task = self.step["task"]
        ratings = {"realism": dict.fromkeys(task["rated"], 4)}
        self.say("answer", **{"number": task["number"], "choice": choice, "ratings": ratings, **more})
        return self.hear("step")


@pytest.fixture
def study(own_studio: Studio) -> Study:
    """A frozen study of four trials; its sessions are open in the studio."""
    study = frozen_study(own_studio.project, plan_text(2, 2, reference=True, switch_s=0.0))
    own_studio.part(Studies).open_sessions(NAME, PASSPHRASE, None)
    return study


@pytest.fixture
def screen(study: Study, ask: Callable[..., Any], client: TestClient) -> Iterator[Screen]:
    """The screen of somebody who sat down."""
    with client.websocket_connect(LIVE) as socket:
        found = Screen(socket)
        found.sit(ask("seat")["seat"])
        yield found


def where(ask: Callable[..., Any]) -> dict[str, Any]:
    """Return the place of the first person."""
    return dict(ask("detail")["people"][0])


def test_a_seat_is_taken_once_and_its_code_is_forgotten_when_the_person_goes_on(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    seat = ask("seat")["seat"]
    assert ask("detail")["waiting"] == 1
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        first = screen.holder
        card = screen.sit(seat)
    assert ask("detail")["waiting"] == 0
    with client.websocket_connect(LIVE) as socket:
        again, somebody = Screen(socket), secrets.token_hex(8)
        # who else has the link can neither join nor learn who does
        again.say("look", study=NAME, seat=seat, holder=somebody)
        assert not again.hear("about")["seat"]
        again.say("sit", study=NAME, seat=seat, holder=somebody, language="en")
        assert "is taken" in again.hear("card")["error"]
        again.holder = first
        again.say("look", study=NAME, seat=seat, holder=first)
        assert again.hear("about")["seat"]
        # the page was loaded again before anybody could write down the code
        assert again.sit(seat) == card
        again.show()
    with client.websocket_connect(LIVE) as socket:
        late = Screen(socket)
        late.say("sit", study=NAME, seat=seat, holder=first, language="en")
        assert "is taken" in late.hear("card")["error"]
        assert late.resume(card)["task"]["number"] == 0
    assert [one.name for one in study.people()] == ["P01"]


def test_answers_lead_on_to_the_end_and_the_operator_sees_how_far(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        screen.sit(ask("seat")["seat"])
        assert screen.step["task"]["places"] == ["X", "A", "B"]
        for done in range(4):
            assert (where(ask)["answered"], where(ask)["here"]) == (done, True)
            screen.show()
            screen.feel("B")
            screen.answer("equal")
    assert screen.step["kind"] == "done"
    assert (where(ask)["state"], where(ask)["answered"], where(ask)["here"]) == ("done", 4, False)


def test_an_answer_out_of_turn_is_refused_and_a_stale_page_gets_the_current_step(
    screen: Screen, ask: Callable[..., Any]
) -> None:
    # nothing is shown yet
    assert screen.answer()["task"]["number"] == 0
    screen.show()
    assert "not offered" in screen.answer("C")["error"]
    assert "not rated" in screen.answer(ratings={"realism": {"A": 4}})["error"]
    assert "none of this trial" in screen.feel("Z")["error"]
    assert screen.answer()["task"]["number"] == 1
    # sent twice: the first answer stands
    assert screen.answer(number=0)["task"]["number"] == 1
    assert where(ask)["answered"] == 1


def test_a_wrong_code_takes_nobodys_screen_away_and_the_right_one_does(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    with client.websocket_connect(LIVE) as one, client.websocket_connect(LIVE) as other:
        first, second = Screen(one), Screen(other)
        card = first.sit(ask("seat")["seat"])
        assert "code" in second.resume({**card, "code": "AAAA-AAAA-AAAA"})["error"]
        first.show()
        assert second.resume(card)["task"]["number"] == 0
        assert "another screen" in first.hear("stopped")["reason"]
        second.show()
        assert second.answer()["task"]["number"] == 1


def test_who_comes_back_while_a_lost_page_still_takes_them_up_waits_for_it(
    screen: Screen, own_studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    studies = own_studio.part(Studies)
    with studies.screens.exclusive(NAME, screen.card["person"]):
        monkeypatch.setattr("fdvv_people.pages.screens.PATIENCE_s", 0.05)
        assert "taken up elsewhere" in screen.resume(screen.card)["error"]
        monkeypatch.setattr("fdvv_people.pages.screens.PATIENCE_s", 10.0)
        screen.say("resume", study=NAME, person=screen.card["person"], code=screen.card["code"])
        time.sleep(0.05)
    assert screen.hear("step")["task"]["number"] == 0


def test_what_a_page_sent_before_it_went_away_takes_nobody_up_after_it_has_gone(
    study: Study, own_studio: Studio
) -> None:
    person, code = study.enrol()
    sent: list[Any] = []
    screen = StudyScreen(own_studio, sent.append)
    screen.close()
    screen.receive(StudyResume(NAME, person, code))
    assert sent == []
    assert own_studio.part(Studies).screens.find(NAME, person) is None


def test_a_pause_holds_every_answer_back_until_it_is_over(screen: Screen, ask: Callable[..., Any]) -> None:
    screen.show()
    assert ask("pause", person="P01", on=True)["people"][0]["paused"]
    assert screen.hear("paused")["on"]
    assert "pauses" in screen.answer()["error"]
    assert "pauses" in screen.feel("A")["error"]
    ask("pause", person="P01", on=False)
    assert not screen.hear("paused")["on"]
    assert screen.answer()["task"]["number"] == 1
    ask("pause", person=None, on=True)
    assert screen.hear("paused")["on"]


def test_a_pause_outlives_the_studio_and_is_on_record(
    study: Study, ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    with client.websocket_connect(LIVE) as socket:
        card = Screen(socket).sit(ask("seat")["seat"])
    ask("pause", person=None, on=True)
    own_studio.close()  # and what it knew with it
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        screen.say("resume", study=NAME, person=card["person"], code=card["code"])
        assert screen.hear("paused")["on"]
        ask("open", passphrase=PASSPHRASE)
        screen.hear("step")
        assert {"type": "paused", "on": True} in screen.heard
        screen.show()
        assert "pauses" in screen.answer()["error"]
    assert ask("detail")["paused"]
    assert [line.split()[-1] for line in ask("detail")["history"][-2:]] == ["paused", "opened"]
    assert study.verify() == ()


def test_without_the_key_holder_a_restarted_studio_seats_nobody_and_no_code_opens_the_blind(
    study: Study, ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    with client.websocket_connect(LIVE) as socket:
        card = Screen(socket).sit(ask("seat")["seat"])
    own_studio.close()
    assert not ask("detail")["open"]
    refused = client.post("/api/studies.seat", json={"study": NAME}).json()
    assert "sessions are not open" in refused["error"]
    with pytest.raises(InputError, match="sessions are not open"):
        Study.open(study.folder).schedule(card["person"], card["code"])
    wrong = client.post("/api/studies.open", json={"study": NAME, "passphrase": "guess"}).json()
    assert "passphrase" in wrong["error"]
    keeper = (study.folder / "keeper.json").rename(study.folder.parent / "moved.json")
    assert (
        "keeper.json" in client.post("/api/studies.open", json={"study": NAME, "passphrase": PASSPHRASE}).text
    )
    assert ask("open", passphrase=PASSPHRASE, keeper=keeper.read_text())["open"]
    assert ask("seat")["seat"]
    assert study.history()[-1].keys() == {"opened"}


def test_sessions_that_are_opened_again_still_know_how_much_was_counted(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        card = screen.sit(ask("seat")["seat"])
        saved = {path: path.read_bytes() for path in study.folder.rglob("*") if path.is_file()}
        screen.show()
        screen.answer()
    while where(ask)["here"]:
        time.sleep(0.01)
    for path, data in saved.items():
        path.write_bytes(data)
    ask("open", passphrase=PASSPHRASE)
    assert "an older one lies in its place" in ask("verify")["problems"][0]
    with client.websocket_connect(LIVE) as socket:
        assert "an older one" in Screen(socket).resume(card)["error"]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems cannot hide it")
def test_a_studio_that_holds_a_run_key_hides_its_memory(own_studio: Studio) -> None:
    study = frozen_study(own_studio.project, plan_text(2, 2, reference=True, switch_s=0.0))
    program = (
        "import sys, ctypes; from pathlib import Path; from fdvv_studio.studio.studio import Studio\n"
        "from fdvv_people.pages.studies import Studies\n"
        "Studio(Path(sys.argv[1])).part(Studies).open_sessions(sys.argv[2], sys.argv[3], None)\n"
        "print(ctypes.CDLL(None).prctl(3, 0, 0, 0, 0))"
    )
    command = [sys.executable, "-c", program, str(own_studio.project), study.folder.name, PASSPHRASE]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "0\n"


def test_a_button_that_breaks_is_set_up_anew_and_the_trial_goes_on(
    screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    from fdvv.errors import DeviceError
    from fdvv_people.study.stimulus.twin import TwinRenderer

    def fails(_self: TwinRenderer, _label: str) -> None:
        raise DeviceError("the twin fell to zero force: a test")

    screen.show()
    with monkeypatch.context() as broken:
        broken.setattr(TwinRenderer, "show", fails)
        screen.say("go", label="A")
        message = screen.hear("broke")
    assert message == {"type": "broke"}
    screen.say("again")
    screen.hear("step")
    assert screen.step["task"]["number"] == 0
    screen.show()
    assert screen.feel("A")["label"] == "A"
    assert screen.answer()["task"]["number"] == 1


def test_a_device_on_the_table_renders_a_study_and_is_nobody_elses_meanwhile(
    study: Study, ask: Callable[..., Any], client: TestClient, own_studio: Studio
) -> None:
    assert ask("detail")["device"] == "twin"
    there = client.post("/api/studies.devices", json={}).json()["devices"]
    assert [one["name"] for one in there][:2] == ["twin", "host"]
    refused = client.post("/api/studies.use", json={"study": NAME, "device": "/dev/null"}).json()
    assert "there is no" in refused["error"]
    assert ask("use", device="host")["device"] == "host"
    with client.websocket_connect(LIVE) as one, client.websocket_connect(LIVE) as other:
        screen, late = Screen(one), Screen(other)
        screen.sit(ask("seat")["seat"])
        # nothing is drawn of what lies on the table
        assert (screen.show()["travel_mm"], screen.heard[-1]["signals"]) == (0.0, [])
        late.say("sit", study=NAME, seat=ask("seat")["seat"], holder=late.holder, language="en")
        assert "is used by the study" in late.hear("card")["error"]
        for label in "XAB":
            assert screen.feel(label)["label"] == label
        assert screen.answer("B")["task"]["number"] == 1
        screen.say("withdraw")
        assert screen.hear("step")["kind"] == "withdrawn"
        late.sit(ask("seat")["seat"])
    # kept beside the study: after a restart nobody is led to another button
    assert Studies(own_studio).device(NAME) == "host"
    assert study.verify() == ()


def test_a_device_that_a_file_defines_is_not_run_from_a_studys_folder(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    rig, there = study.folder.parent / "rig.py", study.folder.with_suffix(DEVICE_SUFFIX)
    rig.write_text("from pathlib import Path\nPath(__file__).with_name('it ran').touch()\n")
    there.write_text(f"rig:{rig}:X\n")
    with client.websocket_connect(LIVE) as line:
        screen = Screen(line)
        screen.say("sit", study=NAME, seat=ask("seat")["seat"], holder=screen.holder, language="en")
        assert "device: there is no 'rig:" in screen.hear("card")["error"]
    assert not rig.with_name("it ran").exists()


def test_a_person_is_withdrawn_and_deleted_while_they_sit_there(
    screen: Screen, study: Study, ask: Callable[..., Any]
) -> None:
    screen.show()
    screen.answer()
    assert ask("withdraw", person="P01", delete=True)["people"][0]["state"] == "deleted"
    assert screen.hear("step")["kind"] == "withdrawn"
    assert "withdrawn" in screen.resume(screen.card)["error"]
    assert not (study.folder / "people" / "P01" / "session.jsonl").exists()


def test_no_message_names_what_a_label_hides_and_the_operators_none_holds_a_code(
    screen: Screen, ask: Callable[..., Any], client: TestClient
) -> None:
    """And for each button all that is sent before it is pressed is the same, whichever label hides what."""
    descriptions: dict[str, set[str]] = {}
    for _ in range(4):
        item = screen.step["task"]["item"]
        ready = {**screen.show(), "number": 0}
        descriptions.setdefault(item, set()).add(
            json.dumps([ready, *(screen.feel(label) for label in "XAB")])
        )
        screen.answer()
    heard = json.dumps(screen.heard)
    assert {one["type"] for one in screen.heard} <= set(SAME)
    assert names_in(heard) == []
    assert {len(kinds) for kinds in descriptions.values()} == {1}
    seen = json.dumps([ask("detail"), ask("verify"), client.post("/api/studies.list", json={}).json()])
    assert names_in(seen) == []
    assert screen.card["code"] not in seen


def test_no_results_are_shown_before_the_seal_is_opened_on_record(
    study: Study, ask: Callable[..., Any], client: TestClient
) -> None:
    with client.websocket_connect(LIVE) as socket:
        screen = Screen(socket)
        screen.sit(ask("seat")["seat"])
        screen.show()
        for label in "XAB":
            screen.feel(label)
        screen.answer("B")
    sealed = client.post("/api/studies.report", json={"study": NAME}).json()
    assert "is sealed" in sealed["error"]
    opening = {"study": NAME, "who": "the keeper", "why": "the last person is done"}
    wrong = client.post("/api/studies.unseal", json={**opening, "passphrase": "guess"}).json()
    assert "passphrase" in wrong["error"]
    assert ask("detail")["row"]["state"] == "frozen"
    assert ask("unseal", passphrase=PASSPHRASE, **opening)["rows"] == 4
    found = ask("detail")
    assert found["row"]["state"] == "unsealed"
    assert any("the last person is done" in line for line in found["history"])
    refused = client.post("/api/studies.seat", json={"study": NAME}).json()
    assert "unsealed" in refused["error"]


def test_a_study_is_declared_from_every_template_changed_and_checked(
    client: TestClient, own_studio: Studio
) -> None:
    def post(name: str, /, **question: Any) -> Any:
        return client.post(f"/api/studies.{name}", json=question).json()

    names = [one["name"] for one in post("offers")["templates"]]
    assert len(names) == 10
    for name in names:
        assert post("create", name=f"of-{name}", template=name) == {"study": f"of-{name}"}
        found = post("plan", study=f"of-{name}")
        assert found["problems"] == []
        assert found["preview"]
    text = post("plan", study="of-realism")["text"]
    broken = post("write", study="of-realism", text=text.replace("rounds = 6", "rounds = -6"), keep=False)
    assert len(broken["problems"]) == 1
    assert "rounds" in broken["problems"][0]
    assert "rounds" in post("write", study="of-realism", text=broken["text"], keep=True)["error"]
    assert post("write", study="of-realism", text=text.replace("rounds = 6", "rounds = 3"), keep=True)[
        "preview"
    ]
    assert "rounds = 3" in post("plan", study="of-realism")["text"]
    assert {row["state"] for row in post("list")["rows"]} == {"draft"}


@pytest.mark.parametrize(
    ("name", "question", "said"),
    [
        ("create", {"name": "../x", "template": "realism"}, "no name of a study"),
        ("create", {"name": "x", "template": "none"}, "no study is called"),
        ("detail", {"study": "none"}, "holds no study"),
        ("seat", {"study": "draft"}, "is not frozen"),
        ("freeze", {"study": "draft", "passphrase": ""}, "passphrase"),
        ("pause", {"study": "none", "person": None, "on": True}, "holds no study"),
    ],
)
def test_impossible_requests_are_refused_in_one_line_without_a_path(
    client: TestClient, own_studio: Studio, name: str, question: dict[str, Any], said: str
) -> None:
    Study.declare_text(own_studio.project / "studies" / "draft", plan_text(), own_studio.project)
    error = client.post(f"/api/studies.{name}", json=question).json()["error"]
    assert said in error
    assert str(own_studio.project) not in error


def test_a_changed_study_is_marked_in_the_list_and_hurts_no_other(
    study: Study, client: TestClient, own_studio: Studio
) -> None:
    Study.declare_text(own_studio.project / "studies" / "other", plan_text(), own_studio.project)
    path = study.folder / "study.toml"
    path.write_text(path.read_text().replace("rounds = 2", "rounds = 3"))
    rows = {row["name"]: row for row in client.post("/api/studies.list", json={}).json()["rows"]}
    assert rows["other"]["state"] == "draft"
    assert rows[NAME]["state"] == "broken"
    assert "changed" in rows[NAME]["problem"]
