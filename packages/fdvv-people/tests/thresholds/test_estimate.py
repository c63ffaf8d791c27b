"""Estimates find the JNDs of simulated observers, with intervals that hold them as often as they say."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.thresholds.belief import Trial
from fdvv_people.thresholds.choose import next_change
from fdvv_people.thresholds.estimate import estimate
from fdvv_people.thresholds.observer import JND, PARAMETERS, log_strength, share_correct
from fdvv_people.thresholds.prior import ThresholdPrior
from tests.support.campaign import in_turn

PRIOR = ThresholdPrior()


def drawn_observer(random: np.random.Generator) -> np.ndarray:
    return np.asarray(PRIOR.mean + np.linalg.cholesky(PRIOR.covariance) @ random.normal(size=PARAMETERS))


def chosen(observer: np.ndarray, count: int, random: np.random.Generator) -> list[Trial]:
    trials: list[Trial] = []
    for _ in range(count):
        change = next_change(trials, PRIOR, largest=(2.0, 4.0, 4.0))
        right = random.random() < share_correct(observer, np.array([change]))[0]
        trials.append((change, bool(right)))
    return trials


def measured(seeds: range, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return errors of the logarithm, whether the interval held, and the claimed errors, (observers, 3)."""
    errors, held, claimed = [], [], []
    for seed in seeds:
        random = np.random.default_rng(seed)
        observer = drawn_observer(random)
        found = estimate(chosen(observer, count, random), PRIOR).jnds
        truth = dict(zip(DIMENSIONS, np.exp(observer[JND]), strict=True))
        errors.append([np.log(found[one].ratio / truth[one]) for one in DIMENSIONS])
        held.append([found[one].low <= truth[one] <= found[one].high for one in DIMENSIONS])
        claimed.append([found[one].log_error for one in DIMENSIONS])
    return np.array(errors), np.array(held), np.array(claimed)


def test_a_few_observers_are_found_within_the_errors_that_are_claimed() -> None:
    errors, held, claimed = measured(range(700, 708), 24)
    assert held.mean() > 0.8
    assert np.sqrt(np.mean(errors**2)) == pytest.approx(np.sqrt(np.mean(claimed**2)), rel=0.4)
    assert np.sqrt(np.mean(errors**2)) < 0.85 * PRIOR.jnd_spread


@pytest.mark.slow
@in_turn(8)
def test_intervals_hold_95_percent_of_observers_drawn_from_the_prior() -> None:
    errors, held, claimed = measured(range(1000, 1150), 54)
    assert 0.93 <= held.mean() <= 0.97
    assert np.sqrt(np.mean(errors**2)) == pytest.approx(np.sqrt(np.mean(claimed**2)), rel=0.08)


def test_more_trials_make_the_error_smaller() -> None:
    random = np.random.default_rng(700)
    trials = chosen(drawn_observer(random), 60, random)
    errors = [estimate(trials[:count], PRIOR).jnds["force"].log_error for count in (0, 12, 60)]
    assert errors[0] == pytest.approx(PRIOR.jnd_spread, rel=0.03)
    assert errors[0] > errors[1] > errors[2]


def test_trials_that_changed_one_dimension_alone_are_counted_by_it() -> None:
    trials: list[Trial] = [((0.1, 0.0, 0.0), True), ((0.1, 0.0, 0.3), False), ((0.0, 0.0, 0.3), True)]
    found = estimate(trials, PRIOR)
    assert [found.jnds[one].trials for one in DIMENSIONS] == [1, 0, 1]
    assert found.trials == 3


def test_the_surface_ends_at_the_jnds_and_is_one_jnd_everywhere_for_a_sure_belief() -> None:
    sure = ThresholdPrior(
        jnd_spread=1e-4,
        exponent_spread=1e-4,
        summation_spread=1e-4,
        lapse_spread=1e-4,
        jnd_ratio=(0.1, 0.4, 0.3),
    )
    points = estimate((), sure).surface("force", "vibration", 9)
    np.testing.assert_allclose(points[0, :, 0], [0.1, 0.0], rtol=1e-3, atol=1e-9)
    np.testing.assert_allclose(points[-1, :, 0], [0.0, 0.3], rtol=1e-3, atol=1e-9)
    changes = np.column_stack([points[:, 0, 0], np.zeros(9), points[:, 1, 0]])
    np.testing.assert_allclose(log_strength(sure.mean, changes), 0.0, atol=1e-3)
    # squares add up, as the prior says: an ellipse
    np.testing.assert_allclose((points[:, 0, 0] / 0.1) ** 2 + (points[:, 1, 0] / 0.3) ** 2, 1.0, rtol=1e-3)
    assert np.all(points[:, :, 1] <= points[:, :, 0])
    assert np.all(points[:, :, 0] <= points[:, :, 2])
