"""Choices of answers: shares with intervals that count people, ties split and dropped, distances felt."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.stats.post_hoc import holm
from fdvv_people.stats.rank_tests import SignedRank, signed_rank
from fdvv_people.stats.share import clustered_share, share, sign_test
from fdvv_people.study.analysis.ratings import names_of
from fdvv_people.study.analysis.records import ALL_BUTTONS, ChoiceResult
from fdvv_people.study.plan.answers import Answers, means_by
from fdvv_people.study.plan.claim import choice_claim, claim_values
from fdvv_people.study.plan.plan import Claim
from fdvv_people.study.plan.tasks import task_behind

RIGHT, WRONG = "right", "wrong"


def choice_results(answers: Answers, claim: Claim) -> tuple[ChoiceResult, ...]:
    """Count choices over all buttons, then at each, with Holm's correction; nothing where nobody chose."""
    values = claim_values(answers, choice_claim(answers, claim))
    whole = _result(answers, claim, ALL_BUTTONS, answers.counts, values)
    if whole is None:
        return ()
    found = [
        _result(answers, claim, button, answers.counts & (answers.item == button), values)
        for button in names_of(answers.item)
    ]
    buttons = [one for one in found if one is not None]
    exact = {one.button: one.test.p_exact for one in buttons if one.test}
    corrected = dict(zip(exact, holm(list(exact.values())), strict=True))
    return (whole, *(replace(one, p_holm=corrected.get(one.button)) for one in buttons))


def _result(
    answers: Answers, claim: Claim, button: str, rows: np.ndarray, values: FloatArray
) -> ChoiceResult | None:
    found, person = values[rows], answers.person[rows]
    more, equal, less = (int(np.sum(found == one)) for one in (1.0, 0.0, -1.0))
    n = more + equal + less
    if not n:
        return None
    right = choice_claim(answers, claim).measure == "correct"
    halves = means_by(found, person)
    tested = halves[np.isfinite(halves)]
    several = tested.size > 1
    # less, equal and more of every person, (people, 3)
    _, places = np.unique(person, return_inverse=True)
    counts: FloatArray = np.stack([np.bincount(places, found == one) for one in (-1.0, 0.0, 1.0)], axis=1)
    given = counts[counts.any(axis=1)]
    people_share = clustered_share(given[:, 2], given.sum(axis=1).astype(int)) if several else None
    test: SignedRank | None = signed_rank(tested / 2) if several else None
    return ChoiceResult(
        button=button,
        more=RIGHT if right else claim.more,
        less=WRONG if right else claim.less,
        more_count=more,
        equal_count=equal,
        less_count=less,
        missing=int(np.sum(rows)) - n,
        share=share(more, n),
        people_share=people_share,
        split=(more + equal / 2) / n,
        dropped=share(more, more + less) if equal and more + less else None,
        test=test,
        sign=sign_test(tested),
        p_holm=None,
        d=task_behind(answers.kind).distances(right, counts, people_share),
    )
