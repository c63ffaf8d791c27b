"""A pause is on the study's record: it holds until whoever leads the study ends it."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import EVERYBODY
from tests.support.kill import Killed, kill_at
from tests.support.studies import CHEAP, small_study


@pytest.fixture
def study(tmp_path: Path) -> Study:
    """A study with two people."""
    found = small_study(tmp_path)
    for _ in range(2):
        found.enrol(cost=CHEAP)
    return found


def test_a_pause_holds_whoever_opens_the_study_next(study: Study) -> None:
    assert study.paused == frozenset()
    study.pause("P02")
    study.pause()
    assert Study.open(study.folder).paused == {"P02", EVERYBODY}
    study.pause("P02", on=False)
    assert Study.open(study.folder).paused == {EVERYBODY}
    study.pause(on=False)
    assert Study.open(study.folder).paused == frozenset()
    assert study.verify() == ()


def test_what_is_so_already_is_not_written_again(study: Study) -> None:
    before = len(study.history())
    study.pause("P01", on=False)
    study.pause("P01")
    study.pause("P01")
    assert len(study.history()) == before + 1
    assert study.history()[-1]["paused"]["person"] == "P01"


def test_nobody_is_paused_who_is_not_there_and_nothing_before_it_is_frozen(
    study: Study, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match="is not in this study"):
        study.pause("P09")
    draft = Study.declare(tmp_path / "draft", study.folder / "study.toml")
    with pytest.raises(InputError, match="is not frozen"):
        draft.pause()
    assert draft.paused == frozenset()


@pytest.mark.parametrize("step", range(4))
def test_a_pause_that_is_killed_is_in_force_or_not_and_the_record_whole(
    tmp_path: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = small_study(tmp_path)
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        study.pause()
    assert study.verify() == ()
    study.pause()
    assert study.paused == {EVERYBODY}
    assert study.verify() == ()
