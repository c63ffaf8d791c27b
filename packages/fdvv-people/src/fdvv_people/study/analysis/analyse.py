"""Analyse the answers of a study: everything that they say, and what they cannot say."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model.noticeable import Dimension
from fdvv_people.stats.rank_tests import signed_rank
from fdvv_people.study.analysis.choices import choice_results
from fdvv_people.study.analysis.columns import TIMING
from fdvv_people.study.analysis.jnds import jnd_results, jnds_over_people
from fdvv_people.study.analysis.levels import threshold_over_people, threshold_results, timing_results
from fdvv_people.study.analysis.ratings import button_tests, names_of, rated_results, scale_results
from fdvv_people.study.analysis.records import ChoiceResult, ClaimResult, PersonResult, StudyAnalysis
from fdvv_people.study.plan.answers import Answers, Screening, is_answered, screen
from fdvv_people.study.plan.claim import (
    choice_claim,
    claim_scores,
    claim_values,
    is_about_right,
    measure_of,
    measured_by,
    usual_claim,
)
from fdvv_people.study.plan.plan import Claim, StudyPlan
from fdvv_people.study.plan.tasks import task_behind

FEW_PEOPLE = 6
"""People below which the exact signed-rank test cannot be significant at .05, whatever they say."""


def analyse(
    answers: Answers,
    plan: StudyPlan | None = None,
    title: str = "",
    standards: Mapping[str, Mapping[Dimension, float]] = MappingProxyType({}),
) -> StudyAnalysis:
    """Analyse answers as their kind asks for.

    plan : whose claim is the main one, and whose rules leave people out; without one the kind's usual claim
        and the usual rules. title : of the study; by default the plan's. standards : of `standards_of`.

    What too few or broken answers do not allow is left out and noted. InputError where nothing was answered.
    """
    screening = screen(answers, plan.exclusion if plan else None)
    found = screening.answers
    if not screening.answered:
        raise InputError(title or "answers", "whole file", "it holds no answer", "check the mapped columns")
    notes: list[str] = []
    claim = (plan.claim if plan else None) or usual_claim(found)
    registered = bool(plan and plan.claim)
    choices = _choices(found, claim, notes)
    thresholds = threshold_results(found, plan.staircase if plan else None)
    jnds = jnd_results(found, plan.thresholds if plan else None)
    return StudyAnalysis(
        title=title or (next(iter(plan.title.values()), plan.name) if plan else "Answers"),
        kind=found.kind,
        buttons=names_of(found.item),
        stimuli=found.stimuli,
        simulated=found.simulated,
        screening=screening,
        people=_people(screening, claim),
        claim=_claim(found, claim, registered, notes),
        tests=button_tests(found, claim, notes) if claim and _two_rated(found, claim) else (),
        scales=scale_results(found, claim, notes) if claim and _two_rated(found, claim) else (),
        rated=rated_results(found, notes) if task_behind(found.kind).hides_reference else (),
        preference=choices[0] if choices else None,
        by_button=choices[1:],
        thresholds=thresholds,
        threshold=threshold_over_people(thresholds),
        jnds=jnds,
        jnd=jnds_over_people(jnds),
        standards=standards,
        timing=timing_results(found, notes) if found.kind == TIMING else None,
        notes=(*_warnings(screening), *dict.fromkeys(notes)),
    )


def _two_rated(answers: Answers, claim: Claim) -> bool:
    return bool(answers.ratings) and {claim.more, claim.less} <= set(answers.stimuli)


def _choices(answers: Answers, claim: Claim | None, notes: list[str]) -> tuple[ChoiceResult, ...]:
    if claim is None or not (np.any(answers.choice != "") or is_about_right(answers)):
        return ()
    try:
        return choice_results(answers, claim)
    except ModelError as error:
        notes.append(f"Choices cannot be counted: {error}.")
        return ()


def _claim(answers: Answers, claim: Claim | None, registered: bool, notes: list[str]) -> ClaimResult | None:
    """Test the main claim on people's means; None where there is nobody to test."""
    if claim is None:
        return None
    try:
        _, means = claim_scores(answers, claim)
        test = signed_rank(means[np.isfinite(means)])
    except ModelError as error:
        notes.append(f"The main claim cannot be tested: {error}.")
        return None
    return ClaimResult(claim, registered, measure_of(answers, claim), test)


def _people(screening: Screening, claim: Claim | None) -> tuple[PersonResult, ...]:
    answers = screening.answers
    answered = is_answered(answers)
    values = np.full(len(answered), np.nan)
    if claim is not None and (np.any(answers.choice != "") or is_about_right(answers)):
        values = claim_values(answers, choice_claim(answers, claim))
    found = []
    for person in screening.people:
        rows = answers.person == person
        given = rows & answered
        time_s = answers.time_s[given] if answers.time_s is not None else np.empty(0)
        time_s = time_s[np.isfinite(time_s)]
        said = values[given][np.isfinite(values[given])]
        found.append(
            PersonResult(
                person,
                planned=int(rows.sum()),
                answered=int(given.sum()),
                left_out=int(np.sum(given & ~answers.counts)),
                share=float(np.mean((said + 1) / 2)) if said.size else float("nan"),
                differences=_differences(answers, given, claim),
                median_s=float(np.median(time_s)) if time_s.size else float("nan"),
                reason=screening.left_out.get(person, ""),
            )
        )
    return tuple(found)


def _differences(answers: Answers, rows: np.ndarray, claim: Claim | None) -> dict[str, float]:
    if claim is None or not _two_rated(answers, claim):
        return {}
    found = {}
    for rating in answers.ratings:
        values = claim_values(answers, measured_by(claim, rating))[rows]
        values = values[np.isfinite(values)]
        found[rating] = float(values.mean()) if values.size else float("nan")
    return found


def _warnings(screening: Screening) -> tuple[str, ...]:
    people = screening.people_counted
    if people == 0:
        return ("Nobody is left after the rules: nothing is tested.",)
    if people == 1:
        return ("One person is left: all results are about that person, and no test speaks of people.",)
    if people < FEW_PEOPLE:
        text = f"With {people} people no exact signed-rank test can be significant at .05, whatever they say"
        return (f"{text}; look at the people themselves.",)
    return ()
