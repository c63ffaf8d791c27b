from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.stats.share import clustered_share
from fdvv_people.stats.thurstone import (
    d_prime_2afc,
    d_prime_abx,
    d_prime_duo_trio,
    d_prime_of_people,
    d_prime_of_share,
    share_2afc,
    share_abx_independent,
    share_duo_trio,
)
from tests.stats.golden import golden


def test_all_three_functions_agree_with_psyphy_on_200_shares() -> None:
    for one in golden("d_prime"):
        for function, name in (
            (share_2afc, "forced"), (share_duo_trio, "differencing"), (share_abx_independent, "independent")
        ):  # fmt: skip
            # psyphy searches to some 1e-5
            assert d_prime_of_share(one["pc"], function) == pytest.approx(one[name], abs=2e-4), name


def test_what_people_do_who_feel_so_gives_each_share() -> None:
    random = np.random.default_rng(1)
    a, b = random.normal(0.0, 1.0, 400_000), random.normal(1.3, 1.0, 400_000)
    x = random.normal(1.3, 1.0, 400_000)
    error = 4 * 0.5 / math.sqrt(400_000)
    assert abs(np.mean(b > a) - share_2afc(1.3)) < error
    assert abs(np.mean(np.abs(x - b) < np.abs(x - a)) - share_duo_trio(1.3)) < error
    assert abs(np.mean((x > 0.65) == (b > a)) - share_abx_independent(1.3)) < error


def test_the_interval_of_two_afc_is_that_of_the_share() -> None:
    from scipy.stats import binomtest, norm

    for correct, n in ((15, 20), (3, 20), (334, 432), (10, 20)):
        interval = binomtest(correct, n).proportion_ci()
        found = d_prime_2afc(correct, n)
        expected = [math.sqrt(2) * norm.ppf(one) for one in (correct / n, interval.low, interval.high)]
        assert [found.d, found.low, found.high] == pytest.approx(expected, abs=1e-8)
        assert found.p == pytest.approx(binomtest(correct, n).pvalue)


def test_a_preference_has_a_sign_and_strict_abx_has_none() -> None:
    assert d_prime_2afc(5, 20).d == pytest.approx(-d_prime_2afc(15, 20).d)
    below = d_prime_abx(9, 20)
    assert (below.d, below.low) == (0.0, 0.0)
    assert below.high > 1
    assert below.p > 0.5
    assert d_prime_abx(15, 20).d == d_prime_duo_trio(15, 20).d


@pytest.mark.parametrize("function", [d_prime_2afc, d_prime_abx, d_prime_duo_trio])
def test_where_every_answer_is_correct_only_the_lower_bound_tells_something(function: Any) -> None:
    found = function(20, 20)
    assert (found.d, found.high) == (math.inf, math.inf)
    assert 1.0 < found.low < 4.0


def test_where_none_is_correct_two_afc_is_bounded_from_above_alone() -> None:
    found = d_prime_2afc(0, 20)
    assert (found.d, found.low) == (-math.inf, -math.inf)
    assert found.high == pytest.approx(-d_prime_2afc(20, 20).low)


def test_the_exact_p_of_guessing_agrees_with_scipy() -> None:
    from scipy.stats import binomtest

    for correct in (0, 5, 10, 15, 20):
        expected = binomtest(correct, 20, alternative="greater").pvalue
        assert d_prime_abx(correct, 20).p == pytest.approx(expected)


def test_over_people_the_bounds_are_those_of_the_share_over_people() -> None:
    found = clustered_share([30, 28, 25, 36, 20, 22], [36] * 6)
    d = d_prime_of_people(found, "2afc")
    assert [share_2afc(one) for one in (d.d, d.low, d.high)] == pytest.approx(
        [found.share, found.low, found.high]
    )
    assert d.people == 6
    assert d.low < d_prime_2afc(found.successes, found.n).low


def test_the_interval_holds_the_truth_at_least_as_often_as_it_says() -> None:
    random = np.random.default_rng(2)
    for d, function, estimate in ((1.0, share_2afc, d_prime_2afc), (2.0, share_duo_trio, d_prime_abx)):
        found = [estimate(int(k), 40) for k in random.binomial(40, function(d), 150)]
        assert sum(one.low <= d <= one.high for one in found) >= 134


def test_counts_that_cannot_be_are_refused() -> None:
    with pytest.raises(ModelError, match="0 to n successes"):
        d_prime_2afc(21, 20)
