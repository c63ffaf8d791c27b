"""fdvv tune as a person runs it: asked, killed, gone on with, refused."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import click
import pytest

from fdvv.model.file import load_model
from fdvv.rendering.session_log import ANSWERS
from fdvv.testing.conformance import plain_surface
from fdvv.testing.scripted import ScriptedDevice
from tests.support.command_line import Run

SIMULATED = ("tune", "mx-clear", "--simulated-observer", "--velocity", "100")
SHORT = (*SIMULATED, "--comparisons", "3")
BY_PERSON = ("tune", "mx-clear", "--device", "serial:x", "--velocity", "100", "--json")


class Rig(ScriptedDevice):
    """A serial rig with a person at it."""

    def upload_program(self, image: bytes) -> None:
        self.upload(plain_surface(), 4.0)


@pytest.fixture
def person(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the list from which the next answers are taken."""
    answers: list[str] = []

    def prompt(text: str, type: click.Choice[str], **_: Any) -> str:
        answer = answers.pop(0)
        assert answer in type.choices
        return answer

    monkeypatch.setattr("fdvv.rendering.session.open_device", lambda *_: Rig())
    monkeypatch.setattr("fdvv.cli.rendering.tune.click.prompt", prompt)
    return answers


def answers_in(folder: str) -> list[dict[str, Any]]:
    """Return the answers on file in a session."""
    records = [json.loads(line)["record"] for line in Path(folder, ANSWERS).read_text().splitlines()]
    return [record["answer"] for record in records if "answer" in record]


def test_a_simulated_observer_tunes_a_model_and_every_word_says_simulated(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv(*SHORT, "-o", "t.fdvv.json")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("mx-clear on twin (simulated), answers of a simulated observer\n")
    assert ran.out.endswith("written to t.fdvv.json\n")
    model = load_model(tmp_path / "t.fdvv.json")
    assert model.provenance.simulated
    assert "by a simulated observer (evidence of nothing)" in model.provenance.method
    assert model.vibration("press", 100.0) is not None


def test_json_holds_scores_errors_and_the_receipt(fdvv: Run) -> None:
    found = fdvv(*SHORT, "--json").json
    (velocity,) = found["velocities"]
    assert found["simulated"]
    assert found["answers"] == velocity["answers"] == 3
    assert {"score", "error", "objective", "vibration"} == set(velocity["candidates"][0])
    assert found["receipt"]["task"] == "tune"


def test_a_killed_tuning_loses_no_answer_and_ends_as_one_that_was_not(fdvv: Run, tmp_path: Path) -> None:
    long = (*SIMULATED, "--velocity", "50", "--rate", "--repeats", "2", "-o", "t.fdvv.json")
    path = tmp_path / "s" / ANSWERS
    running = subprocess.Popen(
        [sys.executable, "-m", "fdvv", *long, "--session", "s"], cwd=tmp_path, stderr=subprocess.DEVNULL
    )
    until_s = time.monotonic() + 40
    while not (path.exists() and path.read_bytes().count(b"\n") > 4):
        assert time.monotonic() < until_s
        time.sleep(0.01)
    running.send_signal(signal.SIGKILL)
    running.wait(20)
    kept = path.read_bytes()
    assert not (tmp_path / "t.fdvv.json").exists()

    going_on = fdvv(*long, "--session", "s")
    assert going_on.status == 0, going_on.err
    assert re.search(r"the session in s, with \d+ answers, goes on", going_on.err)
    assert path.read_bytes().startswith(kept[: kept.rfind(b"\n") + 1])
    torn = (tmp_path / "t.fdvv.json").read_text()
    assert fdvv(*long, "--session", "whole").status == 0
    assert (tmp_path / "t.fdvv.json").read_text() == torn


def test_a_person_compares_by_number_and_may_press_again(fdvv: Run, person: list[str]) -> None:
    person += ["r", "1", "2", "0"]
    ran = fdvv(*BY_PERSON, "--comparisons", "3", "--session", "s")
    assert ran.status == 0, ran.err
    assert ran.json["observer"] == "person"
    asked = [line for line in ran.err.splitlines() if line.startswith("question")]
    assert asked[:2] == [
        f"question 1 of 3 at most, press {i}: 100 mm/s, down to the stop and let go" for i in (1, 2)
    ]
    assert len(asked) == 8
    assert [given["answer"] for given in answers_in("s")] == ["first", "second", "neither"]


def test_a_person_rates_from_1_to_7(fdvv: Run, person: list[str]) -> None:
    person += [str(1 + i % 7) for i in range(12)]
    ran = fdvv(*BY_PERSON, "--rate", "--repeats", "2", "--session", "s")
    assert ran.status == 0, ran.err
    assert ran.json["answers"] == 12
    assert [given["answer"] for given in answers_in("s")] == [1 + i % 7 for i in range(12)]


def test_nothing_that_a_person_sees_tells_templates_apart(fdvv: Run, person: list[str]) -> None:
    """Two runs whose orders differ, by the seed, look the same until the end."""
    shown = []
    for seed in ("1", "2"):
        person += ["0"] * 6
        shown.append(fdvv(*BY_PERSON, "--comparisons", "6", "--seed", seed, "--session", seed).err)
    assert shown[0] == shown[1]
    asked, other = ([given["templates"] for given in answers_in(folder)] for folder in ("1", "2"))
    assert asked != other


def test_show_tells_how_far_a_tuning_is(fdvv: Run) -> None:
    assert fdvv(*SHORT, "--session", "s").status == 0
    lines = fdvv("show", "s").out.splitlines()
    assert lines[0] == "tune mx-clear on twin (simulated)"
    assert lines[-2] == "3 answers"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("tune", "mx-clear"), "nobody can feel a simulated device"),
        (("tune", "mx-clear", "--simulated-observer", "--device", "serial:x"), "a person presses it"),
        (("tune", "mx-red", "--simulated-observer"), "it has none of the press to tune"),
        ((*SHORT, "-o", "t.txt"), "end it in .fdvv.json"),
        ((*SHORT, "--exciter", "none.exciter.json"), "does not exist"),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_line(
    fdvv: Run, arguments: tuple[str, ...], message: str
) -> None:
    ran = fdvv(*arguments)
    assert ran.status == 2
    assert message in ran.err
    assert ran.err.count("\n") == 1
