"""The main claim of a study as one number a person, and its one test: planning and analysis use the same."""

from __future__ import annotations

import numpy as np

from fdvv.study._answers import Answers
from fdvv.study._claim_values import claim_values, means_by
from fdvv.study._plan import Claim
from fdvv.study._signed_rank import signed_ranks
from fdvv.units import FloatArray

SMALLEST_p = 0.1
"""Of sums of signed numbers that lie within their standard deviation."""


def claim_scores(answers: Answers, claim: Claim) -> tuple[tuple[str, ...], FloatArray]:
    """Give people, sorted, and one score each: the mean of `claim_values` over all trials that count.

    Above 0 speaks for the claim; nan where nothing counts. ModelError on a claim that the answers know
    nothing of.
    """
    values = np.where(answers.counts, claim_values(answers, claim), np.nan)
    return tuple(np.unique(answers.person).tolist()), means_by(values, answers.person)


def claim_p(scores: FloatArray) -> FloatArray:
    """Give the two-sided p of many studies' scores, (studies, people), nan where missing.

    Wilcoxon's signed-rank test, exact with ties; people without a leaning are left out, as in the paper's
    own. It counts people, not trials, as independent.
    """
    return signed_ranks(scores).p_exact


def claim_holds(scores: FloatArray, alpha: float) -> np.ndarray:
    """Tell in which studies claim_p is at most alpha, (studies,) of bool; only close ones are worked out.

    With |z| of the ranks' signs: p is at most 2 exp(-z² / 2) (Hoeffding 1963), and at least 0.1 where |z| is
    at most 1 (Oleszkiewicz 1996). Both hold for any ranks, ties and zeros.
    """
    z = signed_ranks(scores, exact=False).z
    found = 2 * np.exp(-0.5 * z**2) <= alpha
    close = ~found & ((np.abs(z) > 0.99) | (alpha >= SMALLEST_p))
    if close.any():
        found[close] = claim_p(scores[close]) <= alpha
    return np.asarray(found)
