"""A session whose process or device is killed at any moment: no answer is lost, no trial is met again."""

from __future__ import annotations

import os
import random
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from fdvv.errors import DeviceError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import TrialFace
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.session.participant import Participant
from tests.hatchery import Hatchery, fork_and_kill
from tests.support.campaign import campaign, in_turn
from tests.support.studies import attended
from tests.support.study_people import (
    CHEAP,
    CONSENT,
    PASSPHRASE,
    StillStage,
    answer_of,
    do_all,
    do_step,
    enrolled,
    frozen_study,
)
from tests.support.study_witness import Witness, check_labels

FASTER = 60.0
"""The clock of these sessions: a break of three seconds takes a twentieth of one."""


def quick_clock() -> float:
    return FASTER * time.time()


def hatch() -> None:
    """Fork lives and kill them.

    Nothing is forced to the disk: a process that is killed takes nothing with it that the system has, only a
    power cut does.
    """
    os.fsync = lambda fd: None
    warm_up()
    fork_and_kill(live)


def warm_up() -> None:
    with tempfile.TemporaryDirectory() as folder:
        one, _ = enrolled(frozen_study(Path(folder) / "study"), StillStage())
        do_all(one)
        one.close()


def live(folder: str, person: str, code: str, into: int) -> None:
    """Go on with a session, then with further ones, and acknowledge each thing, until somebody kills it."""
    study = attended(Path(folder), PASSPHRASE)

    def say(*words: object) -> None:
        os.write(into, (" ".join(map(str, words)) + "\n").encode())

    def on_prepare(labels: Mapping[str, Stimulus]) -> None:
        say("prepared", one.person, one.state.open, *(f"{k}={v.name}" for k, v in labels.items()))

    while True:
        if not code:
            person, code = study.enrol(cost=CHEAP)
            say("enrolled", person, code)
        one = Participant.resume(study, person, code, StillStage(on_prepare=on_prepare), clock=quick_clock)
        while (step := one.step()).kind not in ENDS:
            say("met", person, *step_name(step))
            if step.left_s:
                time.sleep(0.01)
                continue
            do_step(one, step)
            if step.number >= 0:
                say("answered", person, step.number, one.state.answers[step.number].answer.choice)
        one.close()
        say("done", person)
        code = ""


def step_name(step: Step[TrialFace]) -> tuple[str, str]:
    return step.kind, step.page or str(step.number)


def check_kills(folder: Path, kills: int, seed: int, rounds: int) -> Witness:
    """Kill sessions again and again, and hold what they acknowledged against what is kept."""
    study = frozen_study(folder, tables=CONSENT, rounds=rounds, break_every_min=0.2, break_min=0.05)
    rng, witness = random.Random(seed), Witness(study)
    hatchery = Hatchery("tests.study.test_participant_killed")
    for _ in range(kills):
        after, after_s = rng.randint(0, 20), rng.uniform(0.0, 0.03)
        for line in hatchery.killed(folder, witness.person, witness.code, after=after, after_s=after_s):
            witness.hear(line.split())
        if witness.person:
            witness.check()
    hatchery.close()
    assert study.verify(passphrase=PASSPHRASE) == ()
    check_labels(study, witness, PASSPHRASE)
    return witness


@pytest.mark.slow
def test_a_killed_session_loses_no_answer_and_meets_no_trial_again(tmp_path: Path) -> None:
    witness = check_kills(tmp_path / "study", kills=4, seed=1, rounds=3)
    assert witness.person


@pytest.mark.slow
@campaign("seed", range(5), part=1)
def test_no_answer_is_lost_at_five_hundred_random_moments(
    tmp_path: Path, seed: int, record_property: Callable[[str, object], None]
) -> None:
    witness = check_kills(tmp_path / "study", kills=100, seed=seed, rounds=12)
    record_property("answers", len(witness.answers))
    assert len(witness.answers) > 100
    assert witness.done


def run_through_losses(study: Study, new_stage: Callable[[], Any]) -> Participant:
    """Run a session on stages that go away, one after the other; each tells the labels that it prepared."""
    stage = new_stage()
    one, _ = enrolled(study, stage)
    labels: dict[int, Mapping[str, Stimulus]] = {}
    answered: list[tuple[int, str]] = []
    while (step := one.step()).kind != "done":
        assert step.number not in [number for number, _ in answered]
        try:
            one.show_trial(step.number)
            assert labels.setdefault(step.number, stage.labels) == stage.labels
            for label in step.trial.labels:
                one.go_to(label)
            answer = answer_of(one.state.started.trials[step.number], one.state.attempts[step.number])
            one.answer(step.number, answer)
            answered.append((step.number, answer.choice))
        except DeviceError:
            one.reconnect(stage := new_stage())
    assert [(number, event.answer.choice) for number, event in one.state.answers.items()] == answered
    assert len(one.state.answers) + len(one.state.skipped) == len(one.state.started.trials)
    one.close()
    assert study.verify(passphrase=PASSPHRASE) == ()
    return one


def run_with_a_failing_device(study: Study, seed: int, share: float) -> tuple[Participant, int]:
    """Run a session whose device goes away now and then; return it, and how often it went."""
    rng, gone = random.Random(seed), list[bool]()

    def dies() -> bool:
        gone.append(rng.random() < share)
        return gone[-1]

    return run_through_losses(study, lambda: StillStage(dies)), sum(gone)


def test_a_device_may_go_away_at_any_moment_of_a_session(tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "study", rounds=3)
    one, lost = run_with_a_failing_device(study, 1, 0.2)
    assert lost >= one.state.interruptions > 0


@pytest.mark.slow
@in_turn(5)
def test_no_answer_is_lost_when_the_device_goes_away_five_hundred_times(
    tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    study = frozen_study(tmp_path / "study", rounds=25)
    lost = answers = skipped = seed = 0
    while lost < 500:
        one, more = run_with_a_failing_device(study, seed, 0.2)
        lost, seed = lost + more, seed + 1
        answers, skipped = answers + len(one.state.answers), skipped + len(one.state.skipped)
    for name, count in (("lost", lost), ("answers", answers), ("skipped", skipped)):
        record_property(name, count)
