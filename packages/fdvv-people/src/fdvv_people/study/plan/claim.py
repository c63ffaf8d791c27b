"""The main claim of a study as one number a person, and its one test: planning and analysis use the same."""

from __future__ import annotations

import numpy as np
from msgspec import structs

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.rank_tests import signed_ranks
from fdvv_people.study.plan.answers import Answers, means_by
from fdvv_people.study.plan.plan import Claim
from fdvv_people.study.plan.tasks import task_behind
from fdvv_people.study.plan.trial import EQUAL

CHOICE, CORRECT = "choice", "correct"
"""Measures that are no rating: what was chosen, and whether that was right."""

SMALLEST_p = 0.1
"""Of sums of signed numbers that lie within their standard deviation."""


def is_about_right(answers: Answers) -> bool:
    """Return whether the answers of a study are right or wrong rather than a liking."""
    return task_behind(answers.kind).right_or_wrong and bool(np.isfinite(answers.correct).any())


def usual_claim(answers: Answers) -> Claim | None:
    """Return the claim of a study that declared none: the second stimulus over the first.

    None where nothing was compared in that way: staircases, thresholds, timing, or more than two stimuli.
    """
    adaptive = task_behind(answers.kind).adaptive
    if is_about_right(answers) and not adaptive:
        first, second = (*answers.stimuli, "", "")[:2]
        return Claim(more=second or "right", less=first or "wrong", measure=CORRECT)
    if len(answers.stimuli) != 2 or adaptive or answers.kind == "timing":
        return None
    measures = [CHOICE] if np.any(answers.choice != "") else list(answers.ratings)
    return Claim(more=answers.stimuli[1], less=answers.stimuli[0], measure=measures[0]) if measures else None


def measured_by(claim: Claim, measure: str) -> Claim:
    return structs.replace(claim, measure=measure)


def measure_of(answers: Answers, claim: Claim) -> str:
    """Return the claim's measure; a choice that names no stimulus, as in ABX, counts as right or wrong."""
    named = task_behind(answers.kind).names_stimulus
    return CORRECT if claim.measure == CHOICE and not named else claim.measure


def choice_claim(answers: Answers, claim: Claim) -> Claim:
    """Return the same claim about what was chosen, or was right."""
    if claim.measure == CORRECT or not task_behind(answers.kind).names_stimulus:
        return measured_by(claim, CORRECT)
    return measured_by(claim, CHOICE)


def claim_values(answers: Answers, claim: Claim) -> FloatArray:
    """Return for every row how far it speaks for the claim, (n,).

    A choice is 1 for it, -1 against it, 0 for equal; a right answer is 1, a wrong one -1; of ratings it is
    their difference. nan where there is no answer. ModelError on a name that the answers do not hold.
    """
    measure = measure_of(answers, claim)
    if measure == CORRECT:
        return np.asarray(2.0 * answers.correct - 1.0)
    for name in (claim.more, claim.less):
        if name not in answers.stimuli:
            raise ModelError(f"the claim is about {name!r}, the answers about {', '.join(answers.stimuli)}")
    if measure == CHOICE:
        sides = [answers.choice == claim.more, answers.choice == claim.less, answers.choice == EQUAL]
        return np.select(sides, [1.0, -1.0, 0.0], np.nan)
    if measure not in answers.ratings:
        there = ", ".join((CHOICE, *answers.ratings))
        raise ModelError(f"the claim is measured by {measure!r}, there are {there}")
    columns = answers.ratings[measure]
    more, less = (answers.stimuli.index(name) for name in (claim.more, claim.less))
    return np.asarray(columns[:, more] - columns[:, less])


def claim_scores(answers: Answers, claim: Claim) -> tuple[tuple[str, ...], FloatArray]:
    """Return people, sorted, and one score each: the mean of `claim_values` over all trials that count.

    Above 0 speaks for the claim; nan where nothing counts. ModelError on a claim that the answers know
    nothing of.
    """
    values = np.where(answers.counts, claim_values(answers, claim), np.nan)
    return tuple(np.unique(answers.person).tolist()), means_by(values, answers.person)


def claim_p(scores: FloatArray) -> FloatArray:
    """Return the two-sided p of many studies' scores, (studies, people), nan where missing.

    Wilcoxon's signed-rank test, exact with ties; people without a leaning are left out, as in the paper's
    own. It counts people, not trials, as independent.
    """
    return signed_ranks(scores).p_exact


def claim_holds(scores: FloatArray, alpha: float) -> np.ndarray:
    """Return in which studies claim_p is at most alpha, (studies,) of bool; only close ones are worked out.

    With |z| of the ranks' signs: p is at most 2 exp(-z² / 2) (Hoeffding 1963), and at least 0.1 where |z| is
    at most 1 (Oleszkiewicz 1996). Both hold for any ranks, ties and zeros.
    """
    z = signed_ranks(scores, exact=False).z
    found = 2 * np.exp(-0.5 * z**2) <= alpha
    close = ~found & ((np.abs(z) > 0.99) | (alpha >= SMALLEST_p))
    if close.any():
        found[close] = claim_p(scores[close]) <= alpha
    return np.asarray(found)
