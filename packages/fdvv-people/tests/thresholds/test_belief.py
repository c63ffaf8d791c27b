"""Beliefs are those that Bayes' rule gives, whatever the trials, and follow from the trials alone."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.thresholds.belief import Trial, belief_after, share_and_slope
from fdvv_people.thresholds.observer import JND, LAPSE, PARAMETERS, share_correct
from fdvv_people.thresholds.prior import ThresholdPrior

PRIOR = ThresholdPrior()


def answered(count: int, seed: int = 700) -> list[Trial]:
    """Return trials of changes about the expected JNDs, answered by an observer drawn from the prior."""
    random = np.random.default_rng(seed)
    observer = PRIOR.mean + np.linalg.cholesky(PRIOR.covariance) @ random.normal(size=PARAMETERS)
    trials: list[Trial] = []
    for _ in range(count):
        change = np.array(PRIOR.jnd_ratio) * random.choice([0.5, 1.0, 2.0], 3) * random.permutation([1, 0, 0])
        right = random.random() < share_correct(observer, change[None])[0]
        force, snap, vibration = change.tolist()
        trials.append(((force, snap, vibration), bool(right)))
    return trials


def test_before_the_first_trial_the_belief_is_the_prior() -> None:
    found = belief_after((), PRIOR)
    np.testing.assert_allclose(found.mean, PRIOR.mean, atol=0.01)
    np.testing.assert_allclose(np.cov(found.parameters.T), PRIOR.covariance, atol=0.02)


@pytest.mark.parametrize("count", [1, 12, 60])
def test_means_and_spreads_are_those_of_many_draws_from_the_prior(count: int) -> None:
    trials = answered(count)
    random = np.random.default_rng(0)
    drawn = PRIOR.mean + random.normal(size=(100_000, PARAMETERS)) @ np.linalg.cholesky(PRIOR.covariance).T
    log_likely = np.zeros(len(drawn))
    for change, right in trials:
        share = share_correct(drawn, np.array([change]))[:, 0]
        log_likely += np.log(share if right else 1 - share)
    weights = np.exp(log_likely - log_likely.max())
    weights /= weights.sum()
    mean = weights @ drawn
    spread = np.sqrt(weights @ (drawn - mean) ** 2)
    found = belief_after(trials, PRIOR)
    np.testing.assert_allclose(found.mean[JND], mean[JND], atol=0.04)
    np.testing.assert_allclose(
        np.sqrt(found.weights @ (found.parameters - found.mean) ** 2), spread, rtol=0.07
    )


def test_the_order_of_trials_does_not_matter() -> None:
    trials = answered(30)
    first, again = belief_after(trials, PRIOR), belief_after(trials[::-1], PRIOR)
    np.testing.assert_allclose(first.mean, again.mean, atol=1e-6)


@pytest.mark.parametrize("right", [True, False])
def test_thirty_answers_alike_leave_a_belief_of_many_particles(right: bool) -> None:
    found = belief_after([((0.12, 0.0, 0.0), right)] * 30, PRIOR)
    assert found.effective > 400
    assert (found.mean[0] < PRIOR.mean[0]) == right


def test_slopes_are_those_of_the_shares() -> None:
    random = np.random.default_rng(3)
    observer = PRIOR.mean + 0.3 * random.normal(size=PARAMETERS)
    changes = np.array([[0.1, 0.0, 0.0], [0.1, 0.5, 0.0], [0.05, 0.2, 0.3]])
    share, slope = share_and_slope(observer, changes)
    np.testing.assert_allclose(share, share_correct(observer, changes))
    for place, step in enumerate(1e-6 * np.eye(PARAMETERS)):
        numeric = (share_correct(observer + step, changes) - share_correct(observer - step, changes)) / 2e-6
        np.testing.assert_allclose(slope[:, place], numeric, atol=1e-8)


def test_a_prior_that_is_none_is_refused() -> None:
    for change in ({"jnd_spread": 0.0}, {"lapse_ratio": 1.0}, {"summation": 1.0}, {"jnd_ratio": (0.1, 0.2)}):
        with pytest.raises(ModelError, match="no observer"):
            ThresholdPrior(**change)
    assert ThresholdPrior(lapse_ratio=0.5).mean[LAPSE] == pytest.approx(0.0)
