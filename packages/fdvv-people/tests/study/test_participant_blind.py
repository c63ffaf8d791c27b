"""An operator who reads every byte of a running study, and all it says, learns nothing of an assignment."""

from __future__ import annotations

import base64
import json
import logging
import re
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import msgspec
import pytest

from fdvv.errors import DeviceError, InputError
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import Schedule, open_schedule
from fdvv_people.study.files.run_key import RunKey
from fdvv_people.study.files.seal import KeyHolder, unlock_with_code
from fdvv_people.study.plan.trial import StudyTrial
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.stimulus.finger import SimulatedFingerRenderer
from tests.support.studies import in_haste
from tests.support.study_people import PASSPHRASE, PLAN, StillStage, answer_of, do_all, enrolled, frozen_study

ONE, OTHER = "plain-curve-at-all-speeds", "curves-that-follow-the-velocity-of-a-press"
"""Names of stimuli so long that no random bytes hold them, and of different length."""
WHOLE = PLAN.replace('name = "FD"', f'name = "{ONE}"').replace('name = "FDVV"', f'name = "{OTHER}"')
NAMED = WHOLE[: WHOLE.rindex("[[items]]")] + WHOLE[WHOLE.index("[[ratings]]") :]
"""One item, for the orders of items differ between people and are no secret."""
PEOPLE = 6
RANDOM = ("chain", "mark", "salt", "crc32", "next")
BOX = re.compile(r"[A-Za-z0-9+/=]{16,}")


def ticking() -> Callable[[], float]:
    """Return a clock that goes on by a quarter of a second whenever it is read."""
    return count(5000.0, 0.25).__next__


class Running:
    """A study in which everybody answers alike, by label, at the same pace; what the labels hide differs.

    Attributes
    ----------
    codes, schedules : of the people; an operator has neither. said : what errors said.
    """

    def __init__(self, folder: Path, people: int = PEOPLE) -> None:
        self.study = frozen_study(folder, text=NAMED, rounds=4)
        self.codes: dict[str, str] = {}
        self.schedules: dict[str, Schedule] = {}
        self.sessions: list[Participant] = []
        self.said: dict[str, list[str]] = {}
        for _ in range(people):
            self._join()

    def _join(self) -> None:
        uses = iter(range(1000))
        stage = StillStage(lambda: next(uses) == 6)
        one, code = enrolled(self.study, stage, clock=ticking())
        self.codes[one.person] = code
        self.schedules[one.person] = self.study.schedule(one.person, code)
        self.sessions.append(one)
        self.said[one.person] = []
        while one.step().number < 4:
            self._trial(one)
        one.show_trial(4)

    def _trial(self, one: Participant) -> None:
        step = one.step()
        try:
            one.show_trial(step.number)
            for label in ("A", "B"):
                one.go_to(label)
            one.answer(step.number, answer_of(one.state.started.trials[step.number]))
        except DeviceError as error:
            self.said[one.person].append(f"{error!r} {error.__cause__!r}")
            one.reconnect(StillStage())

    def close(self) -> None:
        for one in self.sessions:
            one.close()


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Running:
    with in_haste():
        return Running(tmp_path_factory.mktemp("blind") / "study")


def everything(study: Study) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(study.folder.rglob("*")) if path.is_file()}


def strings_in(value: Any) -> list[str]:
    """Return every string in a JSON value, keys too."""
    if isinstance(value, dict):
        return [text for pair in value.items() for one in pair for text in strings_in(one)]
    if isinstance(value, list):
        return [text for one in value for text in strings_in(one)]
    return [value] if isinstance(value, str) else []


def opened(data: bytes, depth: int = 3) -> list[bytes]:
    """Return bytes, and what they hold in base 64 or hexadecimal, however deep."""
    found = [data]
    for text in BOX.findall(data.decode("latin-1")) if depth else ():
        for decode in (base64.b64decode, bytes.fromhex):
            try:
                found += opened(decode(text), depth - 1)
            except ValueError:
                continue
    return found


def assignments(trials: tuple[StudyTrial, ...]) -> list[dict[str, str]]:
    return [trial.labels for trial in trials]


def test_the_people_of_this_test_have_different_assignments(running: Running) -> None:
    drawn = {json.dumps(assignments(one.trials)) for one in running.schedules.values()}
    assert len(drawn) > 1


def test_no_file_of_a_person_holds_the_name_of_a_rendering_a_code_or_a_key(running: Running) -> None:
    secrets = [ONE, OTHER, *running.codes.values(), PASSPHRASE]
    secrets += [code.replace("-", "") for code in running.codes.values()]
    secrets += [one.key for one in running.schedules.values()]
    secrets += ["correct", 'labels":{']
    for path, data in everything(running.study).items():
        if path.name == "study.toml":
            continue
        for piece in opened(data):
            for secret in secrets:
                assert secret.encode() not in piece, f"{path.name} holds {secret}"
            assert not any(bytes.fromhex(one.key) in piece for one in running.schedules.values())


def test_files_are_as_long_whatever_is_assigned(running: Running) -> None:
    sizes: dict[str, set[int]] = {}
    for path, data in everything(running.study).items():
        if "people" in path.parts:
            # checksums are decimal numbers
            sizes.setdefault(path.name, set()).add(len(re.sub(rb'"crc32": \d+', b"", data)))
    assert set(sizes) == {"schedule.json", "session.jsonl", "session.head", "sealed.jsonl", "sealed.head"}
    assert {name: len(found) for name, found in sizes.items()} == dict.fromkeys(sizes, 1)


def plainly(data: bytes, person: str) -> list[Any]:
    """Read a file's lines without what is drawn at random: boxes, chains and salts."""

    def bare(value: Any) -> Any:
        if isinstance(value, dict):
            return {k: bare(v) for k, v in value.items() if k not in RANDOM}
        if isinstance(value, list):
            return [bare(one) for one in value]
        if isinstance(value, str) and len(value) > 200:
            return len(value)
        return "P" if value == person else value

    text = data.decode()
    lines = [text] if text.lstrip().startswith("{\n") else text.splitlines()
    return [bare(json.loads(line)) for line in lines]


def test_all_that_is_plain_is_the_same_whatever_is_assigned(running: Running) -> None:
    seen: dict[str, list[Any]] = {}
    for path, data in everything(running.study).items():
        if "people" in path.parts:
            plain = plainly(data, path.parent.name)
            assert seen.setdefault(path.name, plain) == plain
    # and what is the same tells of every answer, and of the device that went away
    assert len([1 for line in seen["session.jsonl"] if "answered" in json.dumps(line)]) == 4
    assert "interrupted" in json.dumps(seen["session.jsonl"])


def test_the_operators_view_is_the_same_whatever_is_assigned(running: Running) -> None:
    people = study_progress(running.study, 6000.0)
    same = {msgspec.json.encode(msgspec.structs.replace(view, person="P")) for view in people}
    assert len(same) == 1
    assert people[0].done == 3  # and one of practice
    assert people[0].interruptions == 1


def test_an_error_tells_the_same_whatever_was_rendered(running: Running) -> None:
    assert len({json.dumps(said) for said in running.said.values()}) == 1
    assert "went away" in running.said["P01"][0]


def test_nothing_that_the_operator_has_and_no_code_opens_a_schedule(running: Running) -> None:
    study = running.study
    texts = {
        text for data in everything(study).values() for line in data.splitlines() for text in words_in(line)
    }
    # the operator took part too: their own code, key and schedule are theirs to know
    mine = running.schedules["P01"]
    guessed = [base64.b64decode(study.seal.text), bytes.fromhex(mine.key)]
    words = [*running.codes.values(), mine.key[:12], study.fingerprint[:14], *(text[:12] for text in texts)]
    path = study.person_folder("P02") / "schedule.json"
    locked = json.loads(path.read_text())["locked"]
    for word in dict.fromkeys(words):
        for key in (None, RunKey.drawn(), *(RunKey(data, study.seal.text) for data in guessed)):
            with pytest.raises(InputError):
                unlock_with_code(locked, word, run_key=key)
            with pytest.raises(InputError):
                open_schedule(path, word, key)
    with pytest.raises(InputError, match="sessions are not open"):
        Study.open(study.folder).schedule("P02", running.codes["P02"])
    keeper_text = (study.folder / "keeper.json").read_text()
    for word in [study.fingerprint, mine.key, study.seal.text, *running.codes.values()]:
        with pytest.raises(InputError, match="does not open it"):
            KeyHolder.open(keeper_text, word)


def words_in(line: bytes) -> list[str]:
    try:
        return strings_in(json.loads(line))
    except ValueError:
        return []


def test_keys_that_the_operator_can_make_open_no_box(running: Running) -> None:
    study, mine = running.study, running.schedules["P01"]
    keys = [base64.b64decode(study.seal.text), bytes.fromhex(mine.key), bytes(32)]
    boxes = [json.loads((study.person_folder("P02") / "schedule.json").read_text())["sealed"]]
    lines = (study.person_folder("P02") / "sealed.jsonl").read_text().splitlines()
    boxes += [json.loads(line)["record"]["entry"]["record"]["sealed"] for line in lines[1:]]
    assert len(boxes) == 6
    for key in keys:
        for box in boxes:
            with pytest.raises(InputError):
                KeyHolder(key).unlock(box)


def test_nobody_goes_on_with_somebody_elses_session_on_their_own_code(running: Running) -> None:
    with pytest.raises(InputError, match="code"):
        Participant.resume(running.study, "P02", running.codes["P01"], StillStage())


def test_a_session_says_nothing_on_the_way(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.DEBUG):
        Running(tmp_path / "study", people=1).close()
    printed = capfd.readouterr()
    assert (printed.out, printed.err, caplog.text) == ("", "", "")


def test_a_refused_answer_tells_nothing_of_what_the_labels_hide(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study", text=NAMED)
    one, _ = enrolled(study, StillStage())
    one.show_trial(0)
    bad = msgspec.structs.replace(answer_of(one.state.started.trials[0]), choice=ONE)
    with pytest.raises(InputError) as caught:
        one.answer(0, bad)
    assert OTHER not in str(caught.value)
    assert ONE not in f"{one!r} {one.step()!r} {one.trial!r}"
    one.close()


@pytest.mark.slow
def test_the_same_holds_with_renderings_that_are_pressed_on_the_twin(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study", text=NAMED, rounds=2)
    seen: dict[str, list[Any]] = {}
    drawn: set[str] = set()
    while len(drawn) < 2:
        one, code = enrolled(study, SimulatedFingerRenderer(study.folder), clock=ticking())
        drawn.add(json.dumps(assignments(study.schedule(one.person, code).trials)))
        do_all(one)
        one.close()
        for path in sorted(study.person_folder(one.person).iterdir()):
            plain = plainly(path.read_bytes(), one.person)
            assert seen.setdefault(path.name, plain) == plain
