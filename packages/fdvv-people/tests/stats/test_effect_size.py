from __future__ import annotations

import math

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.stats.effect_size import cohen_dz, reduction


def test_dz_is_t_over_the_root_of_people() -> None:
    from scipy.stats import ttest_1samp

    differences = np.random.default_rng(1).normal(2.0, 3.0, 12)
    assert cohen_dz(differences).value == pytest.approx(ttest_1samp(differences, 0).statistic / math.sqrt(12))


def test_the_interval_of_dz_is_near_the_exact_one_of_the_noncentral_t() -> None:
    from scipy.optimize import brentq
    from scipy.stats import nct

    n = 60
    differences = np.random.default_rng(2).normal(0.8, 1.0, n)
    found, root = cohen_dz(differences), math.sqrt(n)
    t = found.value * root
    exact = [brentq(lambda d, q=q: nct.cdf(t, n - 1, d * root) - q, 0.2, 2) for q in (0.975, 0.025)]
    assert (found.low, found.high) == pytest.approx(exact, abs=0.08)


@pytest.mark.slow
def test_intervals_hold_the_truth_about_as_often_as_they_say() -> None:
    random, hits = np.random.default_rng(3), 0
    for _ in range(60):
        found = cohen_dz(random.normal(0.5, 1.0, 25))
        assert found.low is not None
        assert found.high is not None
        hits += found.low <= 0.5 <= found.high
    # 57 are expected; 95 % of such runs lie within 53 to 60
    assert hits >= 52


def test_a_seed_repeats_an_interval_and_another_moves_it() -> None:
    differences = np.random.default_rng(4).normal(1.0, 1.0, 10)
    assert cohen_dz(differences, 1) == cohen_dz(differences, 1) != cohen_dz(differences, 2)


def test_a_reduction_is_a_ratio_of_means() -> None:
    found = reduction([60.0, 70, 65, 66, 64], [80.0, 85, 82, 81, 90])
    assert found.value == pytest.approx(1 - 65.0 / 83.6)
    assert found.low is not None
    assert found.high is not None
    assert found.low < found.value < found.high


def test_of_too_few_or_equal_people_no_interval_is_reported() -> None:
    assert cohen_dz([1.0, 2.0, 3.0]).low is None
    assert cohen_dz([2.0] * 8).value == math.inf
    assert cohen_dz([0.0] * 8).value == 0.0


def test_a_missing_difference_is_refused() -> None:
    with pytest.raises(ModelError, match="person 2"):
        cohen_dz([1.0, math.nan, 2.0])
