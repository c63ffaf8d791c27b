"""One condition against the best of several: exact for one other, honest for many."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import dunnett, multivariate_t, ttest_rel

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.best_of import against_best, luckiest


def noise(seed: int, blocks: int, conditions: int) -> FloatArray:
    """Draw scores that differ by chance and by block alone."""
    random = np.random.default_rng(seed)
    return random.standard_normal((blocks, conditions)) + 3 * random.standard_normal((blocks, 1))


def test_against_one_other_it_is_the_paired_t_test() -> None:
    scores = noise(1, 7, 2)
    found = against_best(scores)
    assert found is not None
    oracle = ttest_rel(scores[:, 0], scores[:, 1])
    interval = oracle.confidence_interval(0.95)
    assert (found.low, found.high) == pytest.approx((interval.low, interval.high))
    one_sided = ttest_rel(scores[:, 0], scores[:, 1], alternative="greater")
    assert found.chance == pytest.approx(1 - one_sided.pvalue)


def test_the_chance_is_that_of_a_multivariate_t() -> None:
    scores = noise(2, 5, 4) + np.array([1.5, 0.0, 0.3, 0.6])
    found = against_best(scores)
    assert found is not None
    means = scores.mean(axis=0)
    left = scores - scores.mean(axis=1, keepdims=True) - means + scores.mean()
    freedom = 4 * 3
    shape = np.sum(left**2) / freedom / 5 * (np.eye(3) + 1)
    # all differences above 0: by symmetry the distribution function at them
    oracle = multivariate_t(np.zeros(3), shape, freedom, seed=0).cdf(means[0] - means[1:], maxpts=200_000)
    assert found.chance == pytest.approx(float(oracle), abs=2e-3)
    assert found.best == int(np.argmax(means[1:]))


def test_the_upper_bound_is_that_of_dunnett() -> None:
    scores = noise(3, 40, 4)
    oracle = dunnett(*scores[:, 1:].T, control=scores[:, 0], alternative="less", random_state=0)
    # without blocks there are as many degrees of freedom as 4 groups of 40 leave
    bounds = oracle.confidence_interval(0.975)
    means = scores.mean(axis=0)
    error = np.sqrt(2 * np.mean(scores.var(axis=0, ddof=1)) / 40)
    factor = (bounds.high - (means[1:] - means[0])) / error
    assert factor == pytest.approx(luckiest(3, 4 * 39), abs=0.03)


@pytest.mark.parametrize("others", [1, 2, 4])
def test_among_equals_each_is_the_best_equally_often(others: int) -> None:
    chances = [against_best(noise(seed, 6, 1 + others)) for seed in range(400)]
    mean = np.mean([found.chance for found in chances if found])
    assert mean == pytest.approx(1 / (1 + others), abs=0.04)


@pytest.mark.parametrize("truth", [(0.0, 0.0, 0.0, 0.0), (0.0, 0.5, 0.0, -2.0), (1.0, 0.0, 0.9, 0.0)])
@pytest.mark.parametrize("blocks", [3, 8])
def test_the_interval_holds_the_difference_to_the_true_best(truth: tuple[float, ...], blocks: int) -> None:
    """Over many runs of noise: 95 % at least, whichever of the others is the best by luck."""
    wanted, held = truth[0] - max(truth[1:]), []
    for seed in range(1500):
        found = against_best(noise(seed, blocks, 4) + np.array(truth))
        assert found is not None
        held.append(found.low <= wanted <= found.high)
    assert np.mean(held) > 0.95 - 3 * np.sqrt(0.05 * 0.95 / 1500)


def test_blocks_that_are_all_alike_leave_no_doubt() -> None:
    found = against_best(np.tile([2.0, 1.0, 0.5], (3, 1)))
    assert found is not None
    assert (found.low, found.high, found.chance, found.best) == (1.0, 1.0, 1.0, 0)


def test_one_block_says_nothing_and_no_other_is_refused() -> None:
    assert against_best(np.zeros((1, 3))) is None
    with pytest.raises(ModelError, match="at least one other"):
        against_best(np.zeros((3, 1)))
