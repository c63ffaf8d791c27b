from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.study.golden import golden

from fdvv.errors import ModelError
from fdvv.study import friedman, holm, ranked_pairs, signed_rank


def test_it_agrees_with_R_on_200_studies_with_ties() -> None:
    for one in golden("friedman"):
        found = friedman(one["scores"])
        assert found.chi2 == pytest.approx(one["chi2"], abs=1e-8)
        assert found.p == pytest.approx(one["p"], abs=1e-8)


def test_it_agrees_with_pingouin_on_200_studies() -> None:
    for scores, F, p, W, chi2 in golden("friedman", "answers_pingouin"):
        found = friedman(scores)
        assert [found.W, found.chi2, found.F] == pytest.approx([W, chi2, F], abs=1e-9)
        # pingouin takes 2 / people from both degrees of freedom, as Kendall and Babington Smith did
        df, less = len(scores[0]) - 1, 2 / len(scores)
        from scipy.stats import f

        assert p == pytest.approx(f.sf(F, df - less, (len(scores) - 1) * (df - less)), abs=1e-9)


def test_it_agrees_with_scipy() -> None:
    from scipy.stats import friedmanchisquare

    random = np.random.default_rng(1)
    for _ in range(200):
        scores = random.integers(0, 9, (int(random.integers(3, 20)), int(random.integers(3, 8))))
        told = friedmanchisquare(*scores.T)
        assert friedman(scores).chi2 == pytest.approx(told.statistic)
        assert friedman(scores).p == pytest.approx(told.pvalue)


def test_people_who_agree_wholly_have_the_concordance_1() -> None:
    found = friedman(np.tile([10.0, 20, 30], (6, 1)))
    assert (found.W, found.F, found.F_p) == (1.0, math.inf, 0.0)
    assert found.mean_ranks == (1.0, 2.0, 3.0)


def test_pairs_are_signed_rank_tests_corrected_together() -> None:
    scores = np.random.default_rng(2).integers(0, 101, (14, 4)).astype(float)
    names = ["reference", "FDVV", "FD", "anchor"]
    pairs = ranked_pairs(scores, names)
    assert [(one.first, one.second) for one in pairs] == [
        (a, b) for i, a in enumerate(names) for b in names[i + 1 :]
    ]
    assert pairs[1].test == signed_rank(scores[:, 0] - scores[:, 2])
    assert tuple(one.holm_p for one in pairs) == holm([one.test.p_exact for one in pairs])


def test_pairs_against_one_put_it_first_wherever_it_stands() -> None:
    scores = np.random.default_rng(3).normal(size=(8, 3))
    pairs = ranked_pairs(scores, ["a", "b", "c"], against="b")
    assert [(one.first, one.second) for one in pairs] == [("b", "a"), ("b", "c")]
    assert pairs[0].test.shift == -signed_rank(scores[:, 0] - scores[:, 1]).shift


def test_a_missing_rating_leaves_its_person_out_of_its_pairs_alone() -> None:
    scores = np.random.default_rng(4).normal(size=(8, 3))
    scores[2, 1] = np.nan
    pairs = ranked_pairs(scores, ["a", "b", "c"])
    assert [one.test.n for one in pairs] == [7, 8, 7]


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: friedman([[1.0, 2.0], [1.0, math.nan], [2.0, 1.0]]), "missing"),
        (lambda: friedman(np.ones((5, 3))), "alike"),
        (lambda: ranked_pairs(np.ones((5, 3)), ["a", "b"]), "different names"),
        (lambda: ranked_pairs(np.ones((5, 2)), ["a", "b"], against="c"), "no condition 'c'"),
    ],
)
def test_what_cannot_be_tested_is_refused(call: Any, told: str) -> None:
    with pytest.raises(ModelError, match=told):
        call()
