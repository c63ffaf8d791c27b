"""Rows of unsealed answers: what was answered by label joined with what the labels hid."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.study import (
    EQUAL,
    Answered,
    Answers,
    PageAnswered,
    Rendered,
    Settled,
    StudyPlan,
    StudyTrial,
    TrialAnswer,
    Value,
    event_of,
)
from fdvv.workflow._study_exclude import exclude_people, trial_reason
from fdvv.workflow._study_people import Person, Schedule, SealedTrial
from fdvv.workflow._study_seal import Keeper


@dataclass(frozen=True)
class Row:
    """A trial of a person, unsealed. answer : None where there is none. rendered : by label."""

    person: str
    trial: StudyTrial
    ratio: float
    answer: TrialAnswer | None
    rendered: tuple[Rendered, ...] = ()
    excluded: str = ""

    @property
    def choice(self) -> str:
        """Get what was chosen: a stimulus's name, "equal", or "" where nothing was."""
        label = self.answer.choice if self.answer else ""
        return label if label in ("", EQUAL) else self.trial.labels[label]

    @property
    def correct(self) -> float:
        """Get 1, 0, or nan where nothing is right or nothing was answered."""
        if not self.trial.correct or self.answer is None:
            return math.nan
        return float(self.answer.choice == self.trial.correct)


@dataclass(frozen=True)
class UnsealedPerson:
    """What was unsealed of a person. pages : the answers on pages, by page and question."""

    person: Person
    rows: tuple[Row, ...]
    practice: tuple[Row, ...] = ()
    pages: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)


def unseal_person(
    plan: StudyPlan,
    person: Person,
    schedule: Schedule,
    session: Sequence[dict[str, Any]],
    sealed: Sequence[dict[str, Any]],
    keeper: Keeper,
    damaged: bool = False,
) -> UnsealedPerson:
    """Join a person's schedule with the records of both logs.

    damaged : the logs are not as they were written: nothing of them counts. InputError on a record that none
    of the study's programs wrote.
    """
    rendered = [_sealed(record, keeper, person.name) for record in sealed]
    found = {one.number: one for one in rendered}  # of those of one number the last one counts
    try:
        events = [event_of(record) for record in session]
    except ModelError as error:
        raise InputError(person.name, "session", str(error), "install the fdvv that ran the study") from error
    answers = {event.number: event.answer for event in events if isinstance(event, Answered)}
    settled = {(event.item, event.round) for event in events if isinstance(event, Settled)}
    rows = [
        _row(plan, person.name, trial, answers.get(trial.number), found.get(trial.number), damaged)
        for trial in schedule.trials
        if trial.number in answers or (trial.item, trial.round) not in settled
    ]
    return UnsealedPerson(
        person,
        tuple(row for row in rows if not row.trial.practice),
        tuple(row for row in rows if row.trial.practice and row.answer),
        {event.name: event.values for event in events if isinstance(event, PageAnswered)},
    )


def _sealed(record: Mapping[str, Any], keeper: Keeper, name: str) -> SealedTrial:
    return msgspec.json.decode(keeper.unlock(record["sealed"], f"{name}/sealed.jsonl"), type=SealedTrial)


def _row(
    plan: StudyPlan,
    person: str,
    trial: StudyTrial,
    answer: TrialAnswer | None,
    sealed: SealedTrial | None,
    damaged: bool,
) -> Row:
    ratio = (sealed.ratio if sealed else trial.ratio) if plan.kind == "staircase" else math.nan
    if answer is None:
        return Row(person, trial, ratio, None)
    rendered = sealed.rendered if sealed else ()
    reason = "the person's files were changed" if damaged else trial_reason(plan.exclusion, rendered)
    return Row(person, trial, ratio, answer, rendered, reason)


def answers_of(plan: StudyPlan, people: Sequence[UnsealedPerson]) -> Answers:
    """Give the answers as columns, with the frozen rules applied."""
    rows = [row for one in people for row in one.rows]
    stimuli = stimuli_in_order(plan)
    answers = Answers(
        kind=plan.kind,
        stimuli=stimuli,
        person=_words([row.person for row in rows]),
        item=_words([row.trial.item for row in rows]),
        round=np.array([row.trial.round for row in rows], int),
        choice=_words([row.choice for row in rows]),
        correct=np.array([row.correct for row in rows], float),
        ratings={one.name: _ratings(rows, one.name, stimuli) for one in plan.ratings},
        ratio=np.array([row.ratio for row in rows], float),
        time_s=np.array([row.answer.time_s if row.answer else math.nan for row in rows], float),
        excluded=_words([row.excluded for row in rows]),
        simulated=any(one.person.simulated for one in people),
    )
    labels = [row.answer.choice if row.answer else "" for row in rows]
    return exclude_people(answers, labels, plan.exclusion)


def stimuli_in_order(plan: StudyPlan) -> tuple[str, ...]:
    """Give the names of what is compared; of two the second is the one that the claim says is more."""
    names = tuple(stimulus.name for stimulus in plan.items[0].stimuli)
    claim = plan.claim
    return (claim.less, claim.more) if claim and {claim.less, claim.more} == set(names) else names


def _ratings(rows: Sequence[Row], rating: str, stimuli: Sequence[str]) -> np.ndarray:
    """Give what was rated, (rows, stimuli); nan where nothing was."""
    found = np.full((len(rows), len(stimuli)), np.nan)
    for i, row in enumerate(rows):
        given = row.answer.ratings.get(rating, {}) if row.answer else {}
        for label, points in given.items():
            if label in row.trial.labels and label != "X":
                found[i, stimuli.index(row.trial.labels[label])] = points
    return found


def _words(words: Sequence[str]) -> np.ndarray:
    return np.array(words, np.str_)
