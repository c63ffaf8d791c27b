"""."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.post_hoc import holm
from fdvv_people.stats.rank_tests import friedman, ranked_pairs, signed_rank, signed_ranks, turnable_ranks
from fdvv_people.stats.share import sign_test
from tests.stats.golden import TENTHS, golden
from tests.support.campaign import campaign


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
        expected = friedmanchisquare(*scores.T)
        assert friedman(scores).chi2 == pytest.approx(expected.statistic)
        assert friedman(scores).p == pytest.approx(expected.pvalue)


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
    ("call", "reason"),
    [
        (lambda: friedman([[1.0, 2.0], [1.0, math.nan], [2.0, 1.0]]), "missing"),
        (lambda: friedman(np.ones((5, 3))), "alike"),
        (lambda: ranked_pairs(np.ones((5, 3)), ["a", "b"]), "different names"),
        (lambda: ranked_pairs(np.ones((5, 2)), ["a", "b"], against="c"), "no condition 'c'"),
    ],
)
def test_what_cannot_be_tested_is_refused(call: Any, reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        call()


ZEROS: Any = (("wilcoxon", "wilcox"), ("pratt", "pratt"))
"""What we call each way with zeros, and what SciPy calls it."""

SETS = campaign("start", range(12), part=1)
"""Of the 200 drawn sets of differences: every twelfth from the start that is drawn."""


def some_differences(sets: int = 200, most: int = 11) -> list[FloatArray]:
    """Return differences of every kind: many ties and zeros, few, none, and means of six ratings."""
    random = np.random.default_rng(7)
    kinds: list[Any] = [
        lambda n: random.integers(-3, 5, n).astype(float),
        lambda n: random.integers(-15, 20, n).astype(float),
        lambda n: random.normal(0.4, 1.0, n),
        lambda n: (random.integers(6, 43, n) / 6 - random.integers(6, 43, n) / 6).round(12),
    ]
    found = [kinds[i % 4](int(random.integers(3, most))) for i in range(sets)]
    return [x if x.any() else x + 1 for x in found]


def test_twelve_people_all_in_one_direction_give_what_the_paper_prints() -> None:
    found = signed_rank(np.arange(12) / 6 + 0.5)
    assert (round(found.z, 2), round(found.p_asymptotic, 3)) == (-3.06, 0.002)
    assert found.p_exact == 2 / 2**12
    assert (found.effect, found.w_minus, found.n) == (1.0, 0.0, 12)


@pytest.mark.parametrize(
    ("z", "p", "x"),
    [
        ("-3.06", 0.002, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]),
        ("-2.987", 0.003, [-1, 2, 3, 4, 5, 6, 7, 8, 8, 10, 10, 10]),
        ("-2.94", 0.003, [-1, 1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]),
        ("-2.748", 0.006, [1, 2, 3, -4, 5, 6, 7, 8, 9, 9, 11, 11]),
        ("-2.158", 0.031, [1, 2, 3, -4, 4, 6, -7, 8, 9, 10, 11, 12]),
    ],
)
def test_each_z_and_p_that_the_paper_prints_comes_out_of_some_twelve_people(
    z: str, p: float, x: list[int]
) -> None:
    found = signed_rank(x)
    assert f"{found.z:.{len(z) - 3}f}" == z
    assert round(found.p_asymptotic, 3) == p


@SETS
def test_the_asymptotic_p_agrees_with_scipy_of_each_kind_of_zeros(start: int) -> None:
    from scipy import stats

    wilcoxon: Any = stats.wilcoxon
    for x in some_differences()[start::12]:
        for ours, theirs in ZEROS:
            found = signed_rank(x, ours)
            plain = wilcoxon(x, zero_method=theirs, method="asymptotic", correction=False)
            corrected = wilcoxon(x, zero_method=theirs, method="asymptotic", correction=True)
            assert found.statistic == plain.statistic
            assert found.z == pytest.approx(-abs(plain.zstatistic), abs=1e-12)
            assert found.p_asymptotic == pytest.approx(plain.pvalue, rel=1e-12)
            if found.z < 0:
                assert found.p_corrected == pytest.approx(min(1, corrected.pvalue), rel=1e-12)


@SETS
def test_the_exact_p_agrees_with_turning_all_signs_of_each_kind_of_zeros(start: int) -> None:
    for x in some_differences()[start::12]:
        for zeros, _ in ZEROS:
            ranks = turnable_ranks(x, zeros)
            signs = np.array(list(product((0, 1), repeat=x.size)))
            middle = ranks.sum() / 2
            away = np.abs(signs @ ranks - middle)
            share = np.mean(away >= abs(ranks[x > 0].sum() - middle) - 1e-9)
            assert signed_rank(x, zeros).p_exact == pytest.approx(share, rel=1e-12)


@pytest.mark.slow
def test_the_exact_p_agrees_with_scipys_permutations() -> None:
    from scipy.stats import PermutationMethod, wilcoxon

    for x in some_differences(12, 8):
        for ours, theirs in ZEROS:
            expected = wilcoxon(x, zero_method=theirs, method=PermutationMethod(n_resamples=10**6))
            assert signed_rank(x, ours).p_exact == pytest.approx(expected.pvalue, abs=1e-12)


@TENTHS
def test_it_agrees_with_coin_exactRankTests_and_R_on_200_sets_with_ties_zeros_and_missing_people(
    start: int,
) -> None:
    for one in golden("signed_rank")[start::10]:
        x = np.array(one["x"], dtype=np.float64)
        found, pratt = signed_rank(x), signed_rank(x, "pratt")
        assert found.w_plus == one["V"]
        assert found.missing == int(np.isnan(x).sum())
        for ours, name in (
            (found.p_corrected, "corrected"),
            (found.p_exact, "exact"),
            (found.p_exact, "exact_coin"),
            (found.z, "z"),
            (found.p_asymptotic, "asymptotic"),
            (pratt.z, "z_pratt"),
            (pratt.p_exact, "exact_pratt"),
        ):
            expected = -abs(one[name]) if name.startswith("z") else one[name]
            assert ours == pytest.approx(expected, abs=2e-10), name
        if one["shift"] is not None:
            assert [found.shift, found.low, found.high] == pytest.approx([one["shift"], *one["interval"]])


@TENTHS
def test_the_effect_agrees_with_pingouin_on_200_sets(start: int) -> None:
    for x, effect, statistic in golden("signed_rank", "answers_pingouin")[start::10]:
        found = signed_rank(x)
        assert found.effect == pytest.approx(effect)
        assert found.statistic == statistic


def test_many_studies_at_once_are_each_what_one_is_alone() -> None:
    random = np.random.default_rng(3)
    many = random.integers(-4, 6, (60, 14)) / 6
    many[random.random(many.shape) < 0.1] = np.nan
    found = signed_ranks(many)
    for i, one in enumerate(many):
        alone = signed_rank(one)
        for name in ("w_plus", "w_minus", "z", "p_asymptotic", "p_corrected", "p_exact", "effect"):
            assert getattr(found, name)[i] == pytest.approx(getattr(alone, name), rel=1e-12), name
    assert np.isnan(signed_ranks(many, exact=False).p_exact).all()


def test_studies_do_not_fit_in_one_chunk_and_agree_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    many = np.random.default_rng(5).integers(-9, 12, (50, 16)).astype(float)
    whole = signed_ranks(many).p_exact
    monkeypatch.setattr("fdvv_people.stats.rank_tests.CHUNK_BYTES", 4000)
    assert signed_ranks(many).p_exact.tolist() == pytest.approx(whole.tolist(), rel=1e-13)


@settings(deadline=None, max_examples=25)
@given(st.lists(st.integers(-6, 6), min_size=1, max_size=14))
def test_turning_everybody_around_changes_only_the_sign(x: list[int]) -> None:
    here, there = signed_rank(x), signed_rank([-one for one in x])
    assert (here.z, here.p_exact, here.w_plus) == (there.z, there.p_exact, there.w_minus)
    assert here.effect == -there.effect
    assert here.shift == -there.shift


@settings(deadline=None, max_examples=25)
@given(st.lists(st.integers(-36, 36), min_size=2, max_size=14))
def test_means_of_six_ratings_tie_as_their_sums_do(sums: list[int]) -> None:
    # 5 1/6 less 4 5/6 and 1/3 are the same difference, whatever rounding makes of them
    apart = [(one + 50) / 6 - 50 / 6 for one in sums]
    assert signed_rank(apart).p_exact == signed_rank(sums).p_exact
    assert signed_rank(apart).z == signed_rank(sums).z


def test_the_exact_test_keeps_its_level_where_nobody_differs_on_the_whole() -> None:
    random = np.random.default_rng(11)
    p = signed_ranks(random.integers(-6, 7, (4000, 12)) / 6).p_exact
    assert np.mean(p <= 0.05) <= 0.05 + 3 * math.sqrt(0.05 * 0.95 / 4000)


def test_the_interval_of_the_shift_holds_the_truth_at_least_as_often_as_it_says() -> None:
    random = np.random.default_rng(12)
    found = [signed_rank(random.normal(0.7, 1.0, 12)) for _ in range(150)]
    hits = sum(one.low <= 0.7 <= one.high for one in found if one.low is not None and one.high is not None)
    assert hits >= 150 * (0.95 - 3 * math.sqrt(0.95 * 0.05 / 150))


def test_where_nobody_differs_nothing_speaks_for_a_difference() -> None:
    found = signed_rank([0.0, 0.0, math.nan, 0.0])
    assert (found.n, found.zeros, found.missing) == (3, 3, 1)
    assert (found.z, found.p_asymptotic, found.p_exact, found.effect) == (0.0, 1.0, 1.0, 0.0)


def test_below_six_people_no_interval_of_95_percent_exists() -> None:
    assert signed_rank([1.0, 2, 3, 4, 5]).low is None
    assert signed_rank([1.0, 2, 3, 4, 5, 6]).low == 1.0


@pytest.mark.parametrize(
    ("x", "reason"),
    [([], "at least one person"), ([math.nan], "at least one person"), ([math.inf], "infinite"),
     ([[1.0, 2.0]], "one difference a person")],
)  # fmt: skip
def test_differences_that_cannot_be_tested_are_refused(x: Any, reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        signed_rank(x)


@SETS
def test_the_sign_test_agrees_with_scipy_and_statsmodels(start: int) -> None:
    from scipy.stats import binomtest
    from statsmodels.stats.descriptivestats import sign_test as theirs  # type: ignore[import-untyped]

    for x in some_differences()[start::12]:
        found = sign_test(np.append(x, np.nan))
        n = found.plus + found.minus
        assert found.p == pytest.approx(binomtest(found.plus, n).pvalue, rel=1e-10)
        assert found.p == pytest.approx(min(1, theirs(x)[1]), rel=1e-9)
        assert n + found.zeros == x.size
