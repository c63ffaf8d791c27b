"""Sessions of participants: kept step by step, gone on with where they ended."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import DeviceError, InputError, ModelError
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.plan import Stimulus, Thresholds
from fdvv_people.study.plan.threshold_trials import practice_change, trial_change
from fdvv_people.study.plan.trial import TrialAnswer
from fdvv_people.study.session.participant import Participant
from fdvv_people.thresholds.belief import Trial
from tests.support.study_people import (
    CONSENT,
    PASSPHRASE,
    PLAN,
    StillStage,
    answer_of,
    do_all,
    enrolled,
    frozen_study,
)
from tests.support.timing import Clock


def test_a_whole_session_ends_as_done_and_the_study_is_whole(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study", tables=CONSENT)
    stage = StillStage()
    one, code = enrolled(study, stage)
    do_all(one)
    assert one.step().kind == "done"
    assert len(one.state.answers) == 5
    one.close()
    assert stage.closed
    assert study.person("P01").state == "finished"
    assert study.verify(passphrase=PASSPHRASE) == ()
    with Participant.resume(study, "P01", code, StillStage()) as again:
        assert again.step().kind == "done"
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_who_comes_back_with_the_code_goes_on_with_the_same_trial(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study")
    first, later = StillStage(), StillStage()
    one, code = enrolled(study, first)
    do_all(one, 2)
    one.show_trial(2)
    one.close()
    with Participant.resume(study, "P01", code.lower().replace("-", " "), later) as again:
        assert (again.step().number, again.step().again) == (2, True)
        with pytest.raises(ModelError, match="not shown"):
            again.answer(2, TrialAnswer("A"))
        again.show_trial(2)
        assert later.labels == first.labels
        do_all(again)
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_of_a_trial_the_first_answer_stands(tmp_path: Path) -> None:
    one, _ = enrolled(frozen_study(tmp_path / "study"), StillStage())
    one.show_trial(0)
    one.show_trial(0)
    good = answer_of(one.state.started.trials[0])
    after = one.answer(0, good)
    assert one.answer(0, TrialAnswer("B")) == after
    assert one.state.answers[0].answer.choice == good.choice
    assert one.state.attempts == {0: 1}
    one.close()


def test_what_the_answer_does_not_tell_is_filled_in(tmp_path: Path) -> None:
    clock = Clock()
    one, _ = enrolled(frozen_study(tmp_path / "study"), StillStage(), clock=clock)
    one.show_trial(0)
    for label in ("A", "B", "A"):
        clock.now_s += 1.5
        one.go_to(label)
    one.answer(0, answer_of(one.state.started.trials[0]))
    kept = one.state.answers[0].answer
    assert kept.switches == ((1.5, "A"), (3.0, "B"), (4.5, "A"))
    assert kept.presses == {"A": 2, "B": 2}
    assert kept.time_s == 4.5
    one.close()


def test_somebody_is_enrolled_in_their_language_and_simulated_people_are_marked(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study")
    one, code = Participant.enrol(study, "de", StillStage(), simulated=True)
    assert (one.person, one.language, one.state.started.simulated) == ("P01", "de", True)
    assert len(code) == 14
    one.close()
    with pytest.raises(InputError, match="language"):
        Participant.enrol(study, "fi", StillStage(), simulated=True)
    with pytest.raises(InputError, match="simulated"):
        Participant.enrol(study, "de", StillStage())


@pytest.mark.parametrize("at", range(4))
def test_a_device_that_goes_away_costs_the_trial_and_not_the_answer(tmp_path: Path, at: int) -> None:
    study = frozen_study(tmp_path / "study")
    uses = iter(range(100))
    one, _ = enrolled(study, StillStage(lambda: next(uses) == at))
    lost = 0
    while (step := one.step()).kind != "done":
        try:
            one.show_trial(step.number)
            for label in step.trial.labels:
                one.go_to(label)
            one.answer(step.number, answer_of(one.state.started.trials[step.number]))
        except DeviceError as error:
            lost += "FD" not in str(error)
            # an answer that was given stands, though the device could not tell of it
            assert one.step().again == (at < 3)
            assert one.step().number == step.number
            one.reconnect(StillStage())
    # prepare, A, B, what was rendered: the last is asked for when the answer is given already
    assert lost == 1
    assert len(one.state.answers) == 5
    assert one.state.interruptions == (at < 3)
    one.close()
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_a_trial_that_brings_the_device_down_again_and_again_is_given_up(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study")
    one, _ = enrolled(study, StillStage())
    for _ in range(3):
        uses = iter([False, False, True])
        one.reconnect(StillStage(lambda uses=uses: next(uses)))  # type: ignore[misc]
        assert one.step().number == 0
        one.show_trial(0)
        one.go_to("A")
        with pytest.raises(DeviceError):
            one.go_to("B")
        # without a device nothing is noted, however often it is tried
        with pytest.raises(DeviceError):
            one.show_trial(one.step().number)
    one.reconnect(StillStage())
    assert one.step().number == 1
    do_all(one)
    assert sorted(one.state.answers) == [1, 2, 3, 4]
    assert one.state.skipped == {0}
    one.close()
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_another_stage_in_the_middle_of_a_trial_shows_it_again(tmp_path: Path) -> None:
    first, second = StillStage(), StillStage()
    one, _ = enrolled(frozen_study(tmp_path / "study"), first)
    one.show_trial(0)
    one.reconnect(second)
    assert first.closed
    assert one.step().again
    one.show_trial(0)
    assert second.labels == first.labels
    one.close()


STAIRCASE = PLAN.replace('kind = "realism"', 'kind = "staircase"').replace("{more}", "ties = false\n{more}")


def test_a_staircase_comes_nearer_with_right_answers_and_ends_by_its_rule(tmp_path: Path) -> None:
    text = STAIRCASE[: STAIRCASE.index("[[ratings]]")].replace(', rendered = "FD" ', " ") + "{tables}"
    rule = "[staircase]\nstart_ratio = 0.4\nsteps_ratio = [2.0]\ndown = 1\nreversals = 3\n"
    rule += "trials = 12\ndropped = 0\n"
    study = frozen_study(tmp_path / "study", text=text, rounds=1, practice=0, tables=rule)
    ratios: list[float] = []

    def keep(labels: dict[str, object]) -> None:
        ratios.append(max(one.force_ratio for one in labels.values()) - 1.0)  # type: ignore[attr-defined]

    stage = StillStage(on_prepare=keep)  # type: ignore[arg-type]
    one, code = enrolled(study, stage)
    for count, right in enumerate([True, True, False, True, False]):
        number = one.step().number
        assert number == count
        one.show_trial(number)
        # what is right is known to the stage alone
        (stronger,) = (label for label, what in stage.labels.items() if what.name == "FDVV")
        other = "B" if stronger == "A" else "A"
        one.answer(number, TrialAnswer(stronger if right else other))
        if count == 1:
            one.close()
            one = Participant.resume(study, "P01", code, stage := StillStage(on_prepare=keep))  # type: ignore[arg-type]
    assert ratios == pytest.approx([0.4, 0.2, 0.1, 0.2, 0.1])
    # three turns: the other trials of this staircase are not met
    assert one.step().number == 12
    assert one.step().trial.item != one.state.started.trials[0].item
    one.close()


def test_the_operators_view_tells_where_everybody_is(tmp_path: Path) -> None:
    study: Study = frozen_study(tmp_path / "study", tables=CONSENT)
    one, _ = enrolled(study, StillStage())
    two, _ = enrolled(study, StillStage())
    do_all(one, 2)
    first, second = study_progress(study, 0.0)
    assert (first.kind, first.done, first.trials) == ("trial", 1, 4)
    assert (second.kind, second.page) == ("page", "consent")
    one.close()
    two.close()


def test_thresholds_resume_with_the_change_that_the_answers_so_far_ask_for(tmp_path: Path) -> None:
    text = STAIRCASE[: STAIRCASE.index("[[items]]")].replace('"staircase"', '"thresholds"')
    text += '[[items]]\nname = "Clear"\nstimuli = [\n    {{ name = "standard", button = "mx-clear" }},\n'
    text += '    {{ name = "comparison", button = "mx-clear" }},\n]\n{tables}'
    study = frozen_study(
        tmp_path / "study", text=text, rounds=1, practice=1, tables="[thresholds]\ntrials = 6\n"
    )
    changes: list[tuple[float, ...]] = []

    def keep(labels: Mapping[str, Stimulus]) -> None:
        (more,) = (one for one in labels.values() if one.name == "comparison")
        changes.append((more.force_ratio - 1, more.snap_ratio - 1, more.vibration_ratio - 1))

    def answered(one: Participant, stage: StillStage, right: bool) -> None:
        number = one.step().number
        one.show_trial(number)
        (stronger,) = (label for label, what in stage.labels.items() if what.name == "comparison")
        one.answer(number, TrialAnswer(stronger if right else "AB".replace(stronger, "")))

    stage = StillStage(on_prepare=keep)
    one, code = enrolled(study, stage)
    rights = [True, True, False, True, True, False, True]
    for count, right in enumerate(rights):
        if count == 4:
            one.show_trial(one.step().number)
            one._session.close()  # as a process that is killed does
            stage = StillStage(on_prepare=keep)
            one = Participant.resume(study, "P01", code, stage)
            assert one.step().again
        answered(one, stage, right)
    assert one.step().kind == "done"
    one.close()
    # the trial of the crash was shown twice, with one and the same change
    assert changes[4] == changes[5]
    rule = Thresholds(trials=6)
    assert changes[0] == pytest.approx(practice_change(rule, 0))
    shown = [*changes[1:5], *changes[6:]]
    history: list[Trial] = []
    for change, right in zip(shown, rights[1:], strict=True):
        wanted = trial_change(rule, history)
        assert change == pytest.approx(wanted)
        history.append((wanted, right))
    # what is analysed is what was sealed
    answers = study.unseal(PASSPHRASE, who="me", why="a test")
    assert answers.change is not None
    np.testing.assert_allclose(answers.change, shown)
    assert answers.correct.tolist() == [float(right) for right in rights[1:]]
