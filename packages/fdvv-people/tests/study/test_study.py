"""A study in a folder: declared, frozen, people enrolled."""

from __future__ import annotations

import contextlib
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.io.files import write_atomic
from fdvv.model.file import load_builtin, model_to_json, save_model
from fdvv_people.study.admin.review import review_study
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.layout import Frozen
from fdvv_people.study.files.people import Schedule, lock_schedule, room_bytes
from fdvv_people.study.files.run_key import RunKey
from fdvv_people.study.files.seal import KeyHolder, new_key_holder
from fdvv_people.study.stimulus.renderer import stimulus_model
from tests.support.kill import Killed, kill_at
from tests.support.studies import CHEAP, PASSPHRASE, all_files, in_haste, plan_file, small_study


@pytest.fixture(scope="module")
def frozen(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Return a frozen study; tests enrol in it."""
    with in_haste():
        return small_study(tmp_path_factory.mktemp("frozen"))


def test_a_declared_study_holds_its_plan_and_every_file_that_it_names(tmp_path: Path) -> None:
    path = plan_file(tmp_path / "desk")
    study = Study.declare(tmp_path / "study", path)
    assert (study.folder / "study.toml").read_bytes() == path.read_bytes()
    kept = study.folder / "buttons" / "own.fdvv.json"
    assert kept.read_bytes() == (tmp_path / "desk" / "own.fdvv.json").read_bytes()
    assert study.frozen is None
    assert study.fingerprint == ""
    assert study.people() == ()
    assert study.verify() == ("is not frozen",)


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        ("own.fdvv.json", "none.fdvv.json", "no such file beside the plan"),
        ("own.fdvv.json", "../own.fdvv.json", "outside the folder"),
        ("own.fdvv.json", "/etc/hostname", "outside the folder"),
        ('kind = "realism"', "kind = ", "study"),
    ],
)
def test_a_plan_that_cannot_be_declared_leaves_no_study(
    tmp_path: Path, before: str, after: str, reason: str
) -> None:
    path = plan_file(tmp_path / "desk")
    path.write_text(path.read_text().replace(before, after))
    with pytest.raises(InputError, match=reason):
        Study.declare(tmp_path / "study", path)
    with pytest.raises(InputError, match="holds no study"):
        Study.open(tmp_path / "study")


def test_a_folder_with_something_in_it_is_not_taken(tmp_path: Path) -> None:
    path = plan_file(tmp_path / "desk")
    with pytest.raises(InputError, match="is not empty"):
        Study.declare(tmp_path / "desk", path)


@pytest.mark.parametrize("step", range(5))
def test_a_declaration_that_is_killed_leaves_the_folder_free(
    tmp_path: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = plan_file(tmp_path / "desk")
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        Study.declare(tmp_path / "study", path)
    if not (tmp_path / "study").exists():
        Study.declare(tmp_path / "study", path)
    assert Study.open(tmp_path / "study").plan.name == "small"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["desk", "study"]


def test_a_declaration_may_be_made_in_the_empty_folder_one_stands_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = plan_file(tmp_path / "desk")
    (tmp_path / "study").mkdir()
    monkeypatch.chdir(tmp_path / "study")
    Study.declare(Path(), path)
    assert Path("study.toml").is_file()


def test_a_plan_may_be_changed_until_it_is_frozen(tmp_path: Path) -> None:
    path = plan_file(tmp_path / "desk")
    study = Study.declare(tmp_path / "study", path)
    study.change_plan(path.read_text().replace('name = "small"', 'name = "smaller"'))
    assert study.plan.name == "smaller"
    study.freeze(PASSPHRASE, CHEAP)
    with pytest.raises(InputError, match="is frozen"):
        study.change_plan(path.read_text())
    with pytest.raises(InputError, match="was frozen before"):
        study.freeze(PASSPHRASE, CHEAP)


def test_a_plan_with_problems_is_not_frozen(tmp_path: Path) -> None:
    path = plan_file(tmp_path / "desk")
    path.write_text(path.read_text().replace('title = { en = "Consent" }', "title = {}"))
    study = Study.declare(tmp_path / "study", path)
    with pytest.raises(InputError, match="there is no text"):
        study.freeze(PASSPHRASE, CHEAP)
    assert study.frozen is None


def test_a_button_beside_the_plan_is_frozen_and_from_then_on_the_copy_is_played(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    plan_file(folder).rename(folder / "study.toml")
    assert review_study(folder).problems == ()
    study = Study.open(folder)
    study.freeze(PASSPHRASE, CHEAP)
    assert (folder / "buttons" / "own.fdvv.json").read_bytes() == (folder / "own.fdvv.json").read_bytes()
    stimulus = study.plan.items[1].stimuli[1]
    before = stimulus_model(stimulus, folder)
    save_model(load_builtin("mx-red"), folder / "own.fdvv.json")
    assert stimulus_model(stimulus, folder) == before
    assert study.verify() == ()
    (note,) = review_study(folder).notes
    assert "own.fdvv.json beside the study differs" in note
    save_model(load_builtin("mx-red"), folder / "buttons" / "own.fdvv.json")
    assert study.verify() == ("buttons/own.fdvv.json: was changed since the study was frozen",)


def test_freezing_keeps_what_was_looked_at_where_both_are_there(tmp_path: Path) -> None:
    study = Study.declare(tmp_path / "study", plan_file(tmp_path / "desk"))
    kept = (study.folder / "buttons" / "own.fdvv.json").read_bytes()
    save_model(load_builtin("mx-red"), study.folder / "own.fdvv.json")
    study.freeze(PASSPHRASE, CHEAP)
    assert (study.folder / "buttons" / "own.fdvv.json").read_bytes() == kept


def test_freezing_again_gives_another_fingerprint(tmp_path: Path) -> None:
    one, other = small_study(tmp_path / "1"), small_study(tmp_path / "2")
    assert one.plan == other.plan
    assert one.fingerprint != other.fingerprint
    assert len(one.fingerprint) == 19


@pytest.mark.parametrize("step", range(1, 10, 3))
def test_freezing_that_is_killed_leaves_a_study_that_is_frozen_or_not(
    tmp_path: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study.declare(tmp_path / "study", plan_file(tmp_path / "desk"))
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        study.freeze(PASSPHRASE, CHEAP)
    if study.frozen is None:
        study.freeze(PASSPHRASE, CHEAP)
    assert study.verify(study.fingerprint, PASSPHRASE) == ()
    study.enrol(cost=CHEAP)


def test_a_person_gets_a_name_a_place_and_a_code(frozen: Study) -> None:
    before = len(frozen.people())
    person, code = frozen.enrol("en", consent="on paper", cost=CHEAP)
    found = frozen.person(person)
    assert (found.name, found.place, found.language) == (f"P{before + 1:02d}", before, "en")
    assert found.state == "enrolled"
    schedule = frozen.schedule(person, code.lower().replace("-", " "))
    assert [trial.number for trial in schedule.trials] == list(range(5))
    assert [trial.practice for trial in schedule.trials] == [True, *[False] * 4]
    keeper = frozen.key_holder(PASSPHRASE)
    assert frozen.schedule(person, keeper) == schedule
    with frozen.session_log(schedule) as log:
        assert log.about["consent"] == "on paper"


def test_the_code_is_in_no_file(frozen: Study) -> None:
    _, code = frozen.enrol(cost=CHEAP)
    for path in all_files(frozen.folder):
        data = path.read_bytes().upper()
        assert code.encode() not in data
        assert code.replace("-", "").encode() not in data


def test_a_wrong_code_opens_nothing(frozen: Study) -> None:
    one, _ = frozen.enrol(cost=CHEAP)
    _, code = frozen.enrol(cost=CHEAP)
    with pytest.raises(InputError, match="is not the code of this person"):
        frozen.schedule(one, code)
    with pytest.raises(InputError, match="is not in this study"):
        frozen.schedule("P99", code)


def test_people_and_simulated_ones_do_not_mix(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    study.enrol(simulated=True, cost=CHEAP)
    with pytest.raises(InputError, match="simulated people only"):
        study.enrol(cost=CHEAP)


def test_who_comes_for_somebody_that_withdrew_takes_their_place(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    for _ in range(3):
        study.enrol(cost=CHEAP)
    study.withdraw("P02")
    assert study.enrol(cost=CHEAP)[0] == "P04"
    assert [person.place for person in study.people()] == [0, 1, 2, 1]


@pytest.mark.parametrize("step", range(0, 20, 5))
def test_an_enrolment_that_is_killed_is_whole_or_never_was(
    tmp_path: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = small_study(tmp_path)
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        study.enrol(cost=CHEAP)
    assert study.verify(study.fingerprint, PASSPHRASE) == ()
    before = len(study.people())
    person, code = study.enrol(cost=CHEAP)
    assert person == f"P{before + 1:02d}"
    assert len(study.schedule(person, code).trials) == 5
    assert study.verify(study.fingerprint, PASSPHRASE) == ()


def test_locked_schedules_are_as_long_whatever_was_drawn(frozen: Study) -> None:
    schedules = []
    for _ in range(6):
        person, code = frozen.enrol(cost=CHEAP)
        schedules.append(frozen.schedule(person, code))
    lengths = {(frozen.person_folder(one.person) / "schedule.json").stat().st_size for one in schedules}
    assert len({str(one.trials) for one in schedules}) > 1
    assert len(lengths) == 1


@pytest.mark.parametrize("kind", ["realism", "abx", "2afc", "mushra"])
def test_the_room_of_a_schedule_does_not_depend_on_what_was_drawn(kind: str, tmp_path: Path) -> None:
    from fdvv_people.study.plan.plan_file import read_plan_text
    from fdvv_people.study.plan.schedule import draw_schedule

    text = plan_file(tmp_path, kind, 7).read_text().replace('"FDVV"', '"a much longer näme"')
    plan = read_plan_text(text.replace('rendered = "a much longer näme"', 'rendered = "FDVV"'), "plan")
    drawn = [draw_schedule(plan, 0, np.random.default_rng(seed)) for seed in range(40)]
    schedules = [Schedule("0" * 64, "P01", "0" * 64, trials) for trials in drawn]
    assert len({room_bytes(schedule) for schedule in schedules}) == 1
    holder, _ = new_key_holder(PASSPHRASE, CHEAP)
    assert len({len(lock_schedule(one, holder.seal, "0" * 12, CHEAP)) for one in schedules[:6]}) == 1


def test_the_keepers_file_of_another_study_is_refused(tmp_path: Path, frozen: Study) -> None:
    _, text = new_key_holder(PASSPHRASE, CHEAP)
    write_atomic(tmp_path / "other.json", text)
    with pytest.raises(InputError, match="of another study"):
        frozen.key_holder(PASSPHRASE, tmp_path / "other.json")
    assert isinstance(frozen.key_holder(PASSPHRASE), KeyHolder)


def test_a_built_in_button_that_another_version_ships_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from fdvv_people.study.files import layout as _study_files

    study = small_study(tmp_path)
    assert study.frozen is not None
    assert list(study.frozen.builtins) == ["mx-clear"]
    other = load_builtin("mx-black")
    monkeypatch.setattr(_study_files, "load_builtin", lambda _name: other)
    assert model_to_json(other)
    assert "built-in button mx-clear: is not the one" in study.verify()[0]
    with pytest.raises(InputError, match="mx-clear"):
        study.enrol(cost=CHEAP)


def test_a_study_that_was_frozen_before_run_keys_runs_as_before_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv_people.study.admin.planned.Frozen", partial(Frozen, version=1))
    study = Study.open(small_study(tmp_path).folder)
    person, code = study.enrol(cost=CHEAP)
    assert study.schedule(person, code).person == person
    assert study.code_alone == (person,)
    study.open_sessions(PASSPHRASE)
    later, code = study.enrol(cost=CHEAP)
    assert study.code_alone == (person,)
    with pytest.raises(InputError, match="sessions are not open"):
        Study.open(study.folder).schedule(later, code)
    assert study.verify(passphrase=PASSPHRASE) == ()


def put_schedule(study: Study, run_key: RunKey | None) -> tuple[str, str]:
    """Enrol somebody as a forger does who knows the program and all files: with another run key, or none."""
    right, study.run_key = study.run_key, run_key
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Study, "_run_key", lambda _study, _simulated: run_key)
        found = study.enrol(cost=CHEAP)
    study.run_key = right
    return found


def test_a_schedule_that_somebody_else_drew_is_noticed_and_not_run(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    person, code = put_schedule(study, RunKey(b"a guess", study.seal.text))
    assert Study.open(study.folder).verify() == ()
    wanted = [
        "counts.json: was changed by somebody without the key of this study",
        f"people/{person}/schedule.json: was made without the key of this study",
    ]
    assert list(study.verify(passphrase=PASSPHRASE)) == wanted
    with pytest.raises(InputError, match="without the key"):
        study.schedule(person, code)


def test_a_schedule_that_a_code_alone_opens_is_noticed_and_not_run(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    person, code = put_schedule(study, None)
    problem = f"people/{person}/schedule.json: is opened by a code alone"
    assert study.verify()[0].startswith(problem)
    with pytest.raises(InputError, match="by a code alone"):
        study.schedule(person, code)


def test_the_run_key_of_another_study_opens_nothing(tmp_path: Path) -> None:
    one, other = small_study(tmp_path / "one"), small_study(tmp_path / "other")
    one.run_key = other.run_key
    assert not one.sessions_open
    with pytest.raises(InputError, match="sessions are not open"):
        one.enrol(cost=CHEAP)
