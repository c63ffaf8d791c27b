"""What labels hid, joined with the answers, and written as plain tables."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fdvv.force_text import force_number, force_text
from fdvv.io.files import private_folder, write_atomic
from fdvv_people.study.analysis.code_book import csv_text, write_answers
from fdvv_people.study.files.opened import CHANGED, OpenedPerson
from fdvv_people.study.files.people import Person
from fdvv_people.study.plan.answers import Answers, screen
from fdvv_people.study.plan.events import StaircaseConverged, TrialAnswered
from fdvv_people.study.plan.plan import Exclusion, StudyPlan
from fdvv_people.study.plan.trial import EQUAL, Rendered, StudyTrial, TrialAnswer

RENDERED_FILE = "rendered.csv"
RENDERED = (
    *("person", "trial", "practice", "item", "round", "label", "stimulus", "ratio", "switches", "presses"),
    *("largest_error_cN", "errors_cN", "velocities_mm_s", "vibrations", "faults", "excluded"),
)
"""Columns of rendered.csv: a row is a label of an answered trial; blanks part the numbers in a cell."""


def trial_reason(rule: Exclusion, rendered: Sequence[Rendered]) -> str:
    """Return why an answered trial does not count, from what was rendered in it; empty if it does."""
    if not rendered:
        return "no record of what was rendered"
    faults = next((one.faults for one in rendered if one.faults), ())
    if rule.fault and faults:
        return f"device fault: {faults[0]}"
    fewest = min(one.presses for one in rendered)
    if fewest < rule.presses:
        return f"a rendering was pressed {fewest} times, fewer than {rule.presses}"
    known = [[error for error in one.error_cN if error is not None] for one in rendered]
    worst = max(float(np.median(errors)) if errors else 0.0 for errors in known)
    if worst > rule.error_cN:
        return (
            f"half the presses of a rendering missed its force by {force_text(worst, '.1f')}, more than "
            f"{force_number(rule.error_cN)}"
        )
    return ""


def exclude_people(answers: Answers, labels: Sequence[str], rule: Exclusion) -> Answers:
    """Leave out people by rule, beside the trials that are left out already.

    labels : (n,) the label that was chosen in each row, "" where none was: only here it is still known.
    """
    assert answers.excluded is not None
    excluded = answers.excluded.astype(object)
    for person in dict.fromkeys(answers.person.tolist()):
        rows = answers.person == person
        given = [label for label, here in zip(labels, rows, strict=True) if here and label]
        # "equal" is no label: who never feels a difference answers in earnest
        labelled = Counter(label for label in given if label != EQUAL)
        share = max(labelled.values(), default=0) / max(1, len(given))
        if share > rule.same_choice:
            reason = f"the person gave one label in {100 * share:.0f} % of the trials"
            excluded[rows & (excluded == "")] = reason
    return screen(replace(answers, excluded=excluded.astype(np.str_)), rule).answers


@dataclass(frozen=True)
class UnsealedTrial:
    """A trial of a person, unsealed. answer : None where there is none. rendered : by label."""

    person: str
    trial: StudyTrial
    ratio: float
    answer: TrialAnswer | None
    rendered: tuple[Rendered, ...] = ()
    excluded: str = ""
    change: tuple[float, ...] = ()

    @property
    def choice(self) -> str:
        """What was chosen: a stimulus's name, "equal" or another word, or "" where nothing was."""
        label = self.answer.choice if self.answer else ""
        return self.trial.labels.get(label, label)

    @property
    def correct(self) -> float:
        """1, 0, or nan where nothing is right or nothing was answered."""
        if not self.trial.correct or self.answer is None:
            return math.nan
        return float(self.answer.choice == self.trial.correct)


@dataclass(frozen=True)
class UnsealedPerson:
    """What was unsealed of a person."""

    person: Person
    rows: tuple[UnsealedTrial, ...]
    practice: tuple[UnsealedTrial, ...] = ()


def _person(plan: StudyPlan, one: OpenedPerson) -> UnsealedPerson:
    """Join a person's schedule with the records of both logs."""
    answers = {event.number: event.answer for event in one.events if isinstance(event, TrialAnswered)}
    settled = {(event.item, event.round) for event in one.events if isinstance(event, StaircaseConverged)}
    rows = [
        _row(plan, one, trial, answers.get(trial.number))
        for trial in one.schedule.trials
        if trial.number in answers or (trial.item, trial.round) not in settled
    ]
    return UnsealedPerson(
        one.person,
        tuple(row for row in rows if not row.trial.practice),
        tuple(row for row in rows if row.trial.practice and row.answer),
    )


def _row(plan: StudyPlan, one: OpenedPerson, trial: StudyTrial, answer: TrialAnswer | None) -> UnsealedTrial:
    sealed = one.rendered.get(trial.number)
    ratio = (sealed.ratio if sealed else trial.ratio) if plan.staircase else math.nan
    change = sealed.change if sealed else ()
    if answer is None:
        return UnsealedTrial(one.person.name, trial, ratio, None)
    rendered = sealed.rendered if sealed else ()
    reason = CHANGED if one.changed else trial_reason(plan.exclusion, rendered)
    return UnsealedTrial(one.person.name, trial, ratio, answer, rendered, reason, change)


def answers_of(plan: StudyPlan, people: Sequence[UnsealedPerson]) -> Answers:
    """Return the answers as columns, with the frozen rules applied."""
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
        change=np.array([_change(row) for row in rows], float).reshape(-1, 3) if plan.thresholds else None,
    )
    labels = [row.answer.choice if row.answer else "" for row in rows]
    return exclude_people(answers, labels, plan.exclusion)


def _change(row: UnsealedTrial) -> tuple[float, ...]:
    return row.change if row.answer and row.change else (math.nan,) * 3


def stimuli_in_order(plan: StudyPlan) -> tuple[str, ...]:
    """Return the names of what is compared; of two the second is the one that the claim says is more."""
    names = tuple(stimulus.name for stimulus in plan.items[0].stimuli)
    claim = plan.claim
    return (claim.less, claim.more) if claim and {claim.less, claim.more} == set(names) else names


def _ratings(rows: Sequence[UnsealedTrial], rating: str, stimuli: Sequence[str]) -> np.ndarray:
    """Return what was rated, (rows, stimuli); nan where nothing was."""
    found = np.full((len(rows), len(stimuli)), np.nan)
    for i, row in enumerate(rows):
        given = row.answer.ratings.get(rating, {}) if row.answer else {}
        for label, points in given.items():
            if label in row.trial.labels and label != "X":
                found[i, stimuli.index(row.trial.labels[label])] = points
    return found


def _words(words: Sequence[str]) -> np.ndarray:
    return np.array(words, np.str_)


def unseal_labels(plan: StudyPlan, people: Sequence[OpenedPerson], folder: Path) -> Answers:
    """Join the answers of people with what their labels hid, and write them; see `StudyKind.unseal`."""
    unsealed = [_person(plan, one) for one in people]
    answers = answers_of(plan, unsealed)
    # labels of a trial that is still to be answered stay sealed
    trials = [row for one in unsealed for row in (*one.practice, *one.rows) if row.answer]
    labels = (label for row in trials for label in _labels(row))
    private_folder(folder)
    write_answers(folder, answers, plan)
    write_atomic(folder / RENDERED_FILE, csv_text(RENDERED, labels))
    return answers


def _labels(row: UnsealedTrial) -> Iterator[Sequence[object]]:
    trial, answer = row.trial, row.answer
    assert answer is not None
    for one in row.rendered:
        errors = [error for error in one.error_cN if error is not None]
        yield (
            *(row.person, trial.number, int(trial.practice), trial.item, trial.round),
            *(one.label, one.stimulus),
            "" if row.ratio != row.ratio else f"{row.ratio:.6g}",
            *(sum(label == one.label for _, label in answer.switches), one.presses),
            f"{max(errors):.3f}" if errors else "",
            *(_numbers(one.error_cN), _numbers(one.velocity_mm_s)),
            *(one.vibrations, "; ".join(one.faults), row.excluded),
        )


def _numbers(values: Sequence[float | None]) -> str:
    return " ".join("nan" if value is None else f"{value:.3f}" for value in values)
