from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_people.stats.share import (
    beta_binomial_fit,
    binomial_p,
    clopper_pearson,
    clustered_share,
    intraclass_correlation,
    share,
    share_of_totals,
    wilson,
)
from tests.stats.golden import TENTHS, golden
from tests.support.campaign import campaign


def some_counts(sets: int = 200) -> tuple[Any, Any]:
    random = np.random.default_rng(4)
    n = random.integers(1, 500, sets)
    k = random.integers(0, n + 1)
    k[:10], k[10:20] = 0, n[10:20]
    return k, n


def test_334_of_432_is_what_the_paper_prints() -> None:
    found, exact = share(334, 432), share(334, 432, "clopper-pearson")
    assert f"{100 * found.share:.2f} %" == "77.31 %"
    assert [round(100 * one, 2) for one in (found.low, found.high)] == [73.13, 81.01]
    assert [round(100 * one, 2) for one in (exact.low, exact.high)] == [73.07, 81.18]


def test_no_other_count_of_432_gives_the_papers_share() -> None:
    assert [k for k in range(433) if f"{100 * k / 432:.2f}" == "77.31"] == [334]


@pytest.mark.slow
def test_both_intervals_agree_with_statsmodels_on_200_counts() -> None:
    from statsmodels.stats.proportion import proportion_confint  # type: ignore[import-untyped]

    k, n = some_counts()
    for ours, theirs in ((wilson(k, n), "wilson"), (clopper_pearson(k, n), "beta")):
        low, high = proportion_confint(k, n, method=theirs)
        # statsmodels leaves what rounding leaves of 0 and 1
        assert np.abs(ours[0] - low).max() < 1e-12
        assert np.abs(ours[1] - high).max() < 1e-12


@TENTHS
def test_both_intervals_and_the_exact_p_agree_with_scipy_on_200_counts(start: int) -> None:
    from scipy.stats import binomtest

    k, n = (column[start::10] for column in some_counts())
    for ours, scipys in ((wilson(k, n), "wilson"), (clopper_pearson(k, n), "exact")):
        for i in range(len(k)):
            expected = binomtest(int(k[i]), int(n[i])).proportion_ci(method=scipys)  # type: ignore[arg-type]
            assert [ours[0][i], ours[1][i]] == pytest.approx([expected.low, expected.high], abs=1e-9)
    for chance in (0.5, 0.3):
        ps = [binomtest(int(a), int(b), chance).pvalue for a, b in zip(k, n, strict=True)]
        assert binomial_p(k, n, chance).tolist() == pytest.approx(ps, rel=1e-9)
    assert binomial_p(0, 0) == 1.0


def test_people_as_people_agrees_with_survey_on_200_studies() -> None:
    expected = [one for one in golden("clustered") if one["share"] is not None]
    assert len(expected) == 200
    for one in expected:
        found = clustered_share(one["k"], one["n"])
        people = sum(n > 0 for n in one["n"])
        assert found.share == pytest.approx(one["share"])
        assert found.people == people
        # survey lets answers count for more than there are, where people are more alike than chance
        if found.high - found.low <= one["interval"][1] - one["interval"][0] + 1e-6:
            assert [found.low, found.high] == pytest.approx(one["interval"], abs=1e-6)
        else:
            plain = share(found.successes, found.n, "clopper-pearson")
            assert (found.low, found.high) == pytest.approx((plain.low, plain.high))


@campaign("start", range(20), part=1)
def test_the_beta_binomial_agrees_with_VGAM(start: int) -> None:
    compared = 0
    for one in golden("clustered")[start::20]:
        if one["mu"] is None or one["rho"] < 1e-4:
            continue
        k, n = (np.array(one[name], dtype=np.float64) for name in ("k", "n"))
        mean, alike = beta_binomial_fit(k[n > 0], n[n > 0])
        assert [mean, alike] == pytest.approx([one["mu"], one["rho"]], abs=2e-5)
        compared += 1
    assert compared >= 150 // 20


def test_the_beta_binomial_interval_ends_where_scipys_likelihood_has_fallen() -> None:
    from scipy.optimize import minimize_scalar
    from scipy.stats import betabinom, chi2

    def likelihood(k: Any, n: Any, mean: float) -> float:
        def falling(log_size: float) -> float:
            size = math.exp(log_size)
            return -float(betabinom.logpmf(k, n, mean * size, (1 - mean) * size).sum())

        return -float(minimize_scalar(falling, bounds=(-6, 12), method="bounded").fun)

    for one in golden("clustered")[:1]:
        k, n = (np.array([v for v, m in zip(one[name], one["n"], strict=True) if m]) for name in ("k", "n"))
        found = clustered_share(k, n, "beta-binomial")
        best = likelihood(k, n, beta_binomial_fit(k.astype(float), n.astype(float))[0])
        for bound in (found.low, found.high):
            fallen = 2 * (best - likelihood(k, n, bound))
            assert fallen == pytest.approx(chi2.ppf(0.95, 1), abs=2e-3)


def test_likeness_agrees_with_the_intraclass_correlation_of_pingouin_on_200_studies() -> None:
    for k, n, expected in golden("icc", "answers_pingouin"):
        assert intraclass_correlation(k, np.full(len(k), n)) == pytest.approx(max(expected, 0.0), abs=1e-9)


def test_where_everybody_always_says_the_same_people_alone_are_counted() -> None:
    found = clustered_share([36] * 12, [36] * 12)
    assert (found.share, found.high) == (1.0, 1.0)
    assert found.low == pytest.approx(0.025 ** (1 / 12))
    assert clustered_share([0] * 12, [36] * 12).high == pytest.approx(1 - 0.025 ** (1 / 12))
    # half of the people always, the others never: their answers are people's, no more
    split = clustered_share([36] * 6 + [0] * 6, [36] * 12)
    assert split.icc == 1.0
    assert split.high - split.low > 0.55


@pytest.mark.parametrize("method", ["korn-graubard", "beta-binomial", "bootstrap"])
def test_a_share_of_people_lies_in_its_interval_and_repeats(method: Any) -> None:
    k, n = [30, 28, 25, 36, 20, 22, 31, 27, 29, 33, 26, 27, 0], [36] * 12 + [0]
    found = clustered_share(k, n, method)
    plain = share(334, 432)
    assert (found.successes, found.n, found.people) == (334, 432, 12)
    assert found.low < plain.low < found.share < plain.high < found.high
    assert clustered_share(k, n, method) == found


def test_alike_people_whose_answers_are_not_count_as_many_as_there_are_answers() -> None:
    found, plain = clustered_share([27, 28] * 6, [36] * 12), share(330, 432, "clopper-pearson")
    assert found.icc == 0.0
    assert (found.low, found.high) == (plain.low, plain.high)


def test_totals_alone_lie_between_answers_that_are_independent_and_people_who_never_change() -> None:
    widths = []
    for icc in (0.0, 0.05, 0.1, 0.3, 1.0):
        found = share_of_totals(334, 432, 12, icc)
        widths.append(found.high - found.low)
    assert widths == sorted(widths)
    plain = share(334, 432, "clopper-pearson")
    assert widths[0] == pytest.approx(plain.high - plain.low)
    assert share_of_totals(9 * 36, 432, 12, 1.0).low == pytest.approx(share(9, 12, "clopper-pearson").low)


@settings(deadline=None, max_examples=80)
@given(st.integers(1, 200), st.floats(0, 1))
def test_intervals_hold_the_share_and_mirror(n: int, part: float) -> None:
    k = round(part * n)
    for method in ("wilson", "clopper-pearson"):
        here, there = share(k, n, method), share(n - k, n, method)
        assert 0 <= here.low <= here.share <= here.high <= 1
        assert (here.low, here.high) == pytest.approx((1 - there.high, 1 - there.low), abs=1e-12)


@pytest.mark.slow
@campaign("spread", [0.0, 0.05, 0.2], part=1)
def test_intervals_over_people_hold_the_truth_about_as_often_as_they_say(spread: float) -> None:
    random = np.random.default_rng(9)
    hits: dict[Any, int] = {"korn-graubard": 0, "beta-binomial": 0, "plain": 0}
    for _ in range(400):
        size = (1 - spread) / spread if spread else 0.0
        own = random.beta(0.77 * size, 0.23 * size, 12) if spread else np.full(12, 0.77)
        k = random.binomial(36, own)
        for method in ("korn-graubard", "beta-binomial"):
            found = clustered_share(k, [36] * 12, method)
            hits[method] += found.low <= 0.77 <= found.high
        plain = share(int(k.sum()), 432)
        hits["plain"] += plain.low <= 0.77 <= plain.high
    assert hits["korn-graubard"] >= 400 * 0.92
    assert hits["beta-binomial"] >= 400 * 0.88
    if spread == 0.2:
        assert hits["plain"] < 400 * 0.75


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (lambda: share(5, 0), "at least 1 answer"),
        (lambda: share(6, 5), "0 to n successes"),
        (lambda: binomial_p(6, 5), "no count"),
        (lambda: clustered_share([3], [4]), "at least 2 people"),
        (lambda: clustered_share([3, 5], [4, 4]), "for each person"),
    ],
)
def test_counts_that_cannot_be_are_refused(call: Any, reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        call()
