"""What holds in a study of any kind: what ships, who sits in it, who leaves, and who may go on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.kind import StudyKind, all_kinds, kind_of
from fdvv_people.study.labels import KIND as LABELS
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.timing.participant import TimingParticipant
from tests.support import studies, study_people, timing
from tests.support.studies import all_files
from tests.support.study_people import CHEAP, CONSENT, StillStage, answer_of
from tests.support.timing import Clock

SHIPPED = [(kind, name) for kind in all_kinds() for name in kind.templates]


@pytest.mark.parametrize(("kind", "name"), SHIPPED, ids=[name for _, name in SHIPPED])
def test_a_shipped_study_can_be_run_as_it_is(kind: StudyKind[Any], name: str, tmp_path: Path) -> None:
    path = write_template(name, tmp_path / "mine", "mine")
    study = Study.open(path.parent)
    assert kind.problems(study.plan) == ()
    assert (study.plan.name, study.plan.kind) == ("mine", name)
    assert kind_of(path) is kind_of(path.parent) is study.kind is kind


def test_what_is_not_there_or_does_not_say_so_is_no_timing_study(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('format = "fdvv-study"\n')
    assert kind_of(tmp_path) is kind_of(tmp_path / "none") is LABELS


class Labels:
    """Somebody who sits in a frozen study of labels, with a break of 2 min every minute."""

    passphrase = study_people.PASSPHRASE

    def __init__(self, folder: Path) -> None:
        self.clock, self.study = Clock(), self.freeze(folder)
        self.person, self.code = self.study.enrol(cost=CHEAP)
        self.one = self.resume()

    def freeze(self, folder: Path) -> Study:
        return study_people.frozen_study(folder, tables=CONSENT, break_every_min=1.0, break_min=2.0)

    def resume(self, study: Study | None = None, code: str | KeyHolder | None = None) -> Any:
        return Participant.resume(
            study or self.study, self.person, code or self.code, StillStage(), clock=self.clock
        )

    def play(self, one: Any, number: int = 0) -> None:
        """Do a trial in a minute and a second, after the pages before it."""
        while (step := one.step()).kind == "page":
            study_people.do_step(one, step)
        one.show_trial(number)
        self.clock.now_s += 61.0
        one.answer(number, answer_of(one.state.started.trials[number]))


class Timing(Labels):
    """Somebody who sits in a timing study, likewise."""

    passphrase = studies.PASSPHRASE

    def freeze(self, folder: Path) -> Study:
        breaks = "break_every_min = 1\nbreak_min = 2"
        return timing.frozen(folder, timing.SMALL.replace("break_every_min = 0", breaks))

    def resume(self, study: Study | None = None, code: str | KeyHolder | None = None) -> Any:
        return TimingParticipant.resume(study or self.study, self.person, code or self.code, clock=self.clock)

    def play(self, one: Any, number: int = 0) -> None:
        while (step := one.step()).kind == "page":
            timing.do_step(one, step, self.clock)
        begun = one.begin(number, "page")
        self.clock.now_s += 61.0
        for round_ in range(1, begun.rounds + 1):
            timing.press(one, number, round_)


@pytest.fixture(params=[Labels, Timing])
def sat(request: pytest.FixtureRequest, tmp_path: Path) -> Labels:
    return request.param(tmp_path / "study")  # type: ignore[no-any-return]


def test_who_does_not_consent_leaves_nothing_but_that_they_were_there(sat: Labels) -> None:
    assert sat.one.answer_page("consent", {}, agreed=False).kind == "declined"
    assert sat.study.person("P01").state == "deleted"
    assert not [path for path in (sat.study.folder / "people").rglob("*") if path.is_file()]
    assert sat.study.verify() == ()
    with pytest.raises(InputError, match="withdrawn"):
        sat.resume()
    sat.one.close()


@pytest.mark.parametrize("delete", [True, False])
def test_who_withdraws_is_gone_and_their_data_too_if_they_wish(sat: Labels, delete: bool) -> None:
    sat.play(sat.one)
    assert sat.one.withdraw(delete).kind == "withdrawn"
    assert (sat.study.folder / "people/P01/session.jsonl").exists() != delete
    assert sat.study.verify() == ()
    with pytest.raises(InputError, match="withdrawn"):
        sat.resume()
    (view,) = study_progress(sat.study, sat.clock())
    assert view.state == view.place == sat.study.person("P01").state == ("deleted" if delete else "withdrawn")


def test_a_break_cannot_be_skipped_and_is_kept_across_a_crash(sat: Labels) -> None:
    sat.play(sat.one)
    assert (sat.one.step().kind, sat.one.step().left_s) == ("break", 120.0)
    sat.one._session.close()  # as a process that is killed does
    sat.clock.now_s += 50.0
    with sat.resume() as again:
        assert (again.step().kind, again.step().left_s) == ("break", 70.0)
        for skipping in (again.end_break, lambda: sat.play(again, 1)):
            with pytest.raises(ModelError):
                skipping()
        sat.clock.now_s += 70.0
        assert again.end_break().number == 1


def test_without_the_run_key_nobody_begins_or_comes_back_and_opening_is_on_record(sat: Labels) -> None:
    sat.one.close()
    study, before = Study.open(sat.study.folder), all_files(sat.study.folder)
    for refused in (lambda: study.enrol(cost=CHEAP), lambda: sat.resume(study)):
        with pytest.raises(InputError, match="sessions are not open"):
            refused()
    assert (study.sessions_open, all_files(study.folder)) == (False, before)
    study.open_sessions(sat.passphrase)
    assert study.history()[-1].keys() == {"opened"}
    assert sat.passphrase not in repr(study.run_key)
    sat.resume(study).close()


def test_for_who_lost_the_card_the_keeper_can_go_on_in_one_process_at_a_time(sat: Labels) -> None:
    sat.play(sat.one)
    sat.one.close()
    with pytest.raises(InputError, match="code"):
        sat.resume(code="0000-0000-0000")
    with sat.resume(code=sat.study.key_holder(sat.passphrase)) as again:
        assert again.state.trials_over == 1
        with pytest.raises(InputError, match="another process"):
            sat.resume()
