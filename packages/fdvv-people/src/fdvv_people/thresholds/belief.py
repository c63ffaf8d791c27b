"""The belief about an observer after some trials, as weighted particles; it follows from the trials alone.

Nothing is carried from trial to trial, so that whoever resumes believes the same. Fisher scoring finds the
most likely parameters; particles are drawn about them from a t distribution, and some from the prior, with a
quasi-random sequence (Sobol), and each is weighted by the posterior over the density that it was drawn from.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fdvv.model.noticeable import AT_JND
from fdvv.units import FloatArray
from fdvv_people.thresholds.observer import EXPONENT, JND, LAPSE, PARAMETERS, SUMMATION, share_correct, summed
from fdvv_people.thresholds.prior import ThresholdPrior

Change = tuple[float, float, float]
"""By how much force, snap and vibration of a comparison grow, as ratios of the standard."""

Trial = tuple[Change, bool]
"""What was changed, and whether the changed one was picked."""

PARTICLES, FEW_PARTICLES = 4096, 512
"""For an estimate, and to choose a trial by: half the spread of a JND between either is below 0.03 of it."""

FREEDOM, BROADER = 6.0, 1.1
"""Of the t distribution: heavy tails, and somewhat broader than the normal approximation, cover skew."""

PRIOR_SHARE = 0.15
"""Of the particles: while little is known the posterior has the prior's tails."""

ROUNDS, ENOUGH = 30, 1e-8  # assumed: the mode only places the particles, whose weights make up for errors
SEED = 1  # any will do, always the same: whoever resumes believes the same


@dataclass(frozen=True, eq=False)
class Belief:
    """Weighted particles. parameters : (particles, PARAMETERS), of `observer`. weights : add up to 1."""

    parameters: FloatArray
    weights: FloatArray

    @property
    def effective(self) -> float:
        """How many equally weighted particles say as much."""
        return float(1.0 / np.sum(self.weights**2))

    @property
    def mean(self) -> FloatArray:
        return np.asarray(self.weights @ self.parameters)


def belief_after(trials: Sequence[Trial], prior: ThresholdPrior, particles: int = PARTICLES) -> Belief:
    """Return the belief after trials, in any order. particles : a power of 2."""
    return _belief(tuple(trials), prior, particles)


@lru_cache(maxsize=64)
def _belief(trials: tuple[Trial, ...], prior: ThresholdPrior, particles: int) -> Belief:
    normal, scale = _drawn(particles)
    mean, root = prior.mean, np.asarray(np.linalg.cholesky(prior.covariance))
    if not trials:
        return Belief(mean + normal @ root.T, np.full(particles, 1.0 / particles))
    counts = _counted(trials)
    mode, precision = _most_likely(mean, np.asarray(np.linalg.inv(prior.covariance)), counts)
    broad = np.asarray(BROADER * np.linalg.cholesky(np.linalg.inv(precision)))
    first = int(PRIOR_SHARE * particles)
    found = np.concatenate(
        [mean + normal[:first] @ root.T, mode + (normal[first:] * scale[first:, None]) @ broad.T]
    )
    log_prior = _log_normal(found, mean, root)
    log_drawn = np.logaddexp(
        log_prior + math.log(first / particles), _log_t(found, mode, broad) + math.log(1 - first / particles)
    )
    share = share_correct(found, counts.changes)
    log_weight = log_prior + np.log(share) @ counts.right + np.log1p(-share) @ counts.wrong - log_drawn
    weights = np.exp(log_weight - log_weight.max())
    return Belief(found, weights / weights.sum())


@dataclass(frozen=True, eq=False)
class _Counts:
    """changes : (n, 3), each once. right, wrong : (n,) answers to it."""

    changes: FloatArray
    right: FloatArray
    wrong: FloatArray


def _counted(trials: Sequence[Trial]) -> _Counts:
    found: dict[Change, list[int]] = {}
    for change, correct in trials:
        found.setdefault(change, [0, 0])[not correct] += 1
    changes, answers = np.array(list(found), dtype=np.float64), np.array(list(found.values()), np.float64)
    return _Counts(changes, answers[:, 0], answers[:, 1])


@lru_cache(maxsize=4)
def _drawn(particles: int) -> tuple[FloatArray, FloatArray]:
    """Return standard normal numbers, (particles, PARAMETERS), and the scale that makes each row t."""
    from scipy.special import chdtri, ndtri
    from scipy.stats import qmc

    even = qmc.Sobol(PARAMETERS + 1, rng=SEED).random(particles)
    even = np.clip(even, 1e-9, 1.0 - 1e-9)
    return ndtri(even[:, :PARAMETERS]), np.sqrt(FREEDOM / chdtri(FREEDOM, even[:, PARAMETERS]))


def _log_normal(at: FloatArray, mean: FloatArray, root: FloatArray) -> FloatArray:
    apart = (at - mean) @ np.linalg.inv(root).T
    normal = np.log(np.diag(root)).sum() + 0.5 * PARAMETERS * math.log(2 * math.pi)
    return np.asarray(-0.5 * np.sum(apart**2, axis=1) - normal)


def _log_t(at: FloatArray, mean: FloatArray, root: FloatArray) -> FloatArray:
    apart = (at - mean) @ np.linalg.inv(root).T
    half = 0.5 * (FREEDOM + PARAMETERS)
    normal = math.lgamma(half) - math.lgamma(0.5 * FREEDOM) - 0.5 * PARAMETERS * math.log(FREEDOM * math.pi)
    spread = half * np.log1p(np.sum(apart**2, axis=1) / FREEDOM)
    return np.asarray(normal - np.log(np.diag(root)).sum() - spread)


def _most_likely(mean: FloatArray, precision: FloatArray, counts: _Counts) -> tuple[FloatArray, FloatArray]:
    """Return the mode of the posterior and its expected information, by Fisher scoring with halved steps."""
    at, answers = mean, counts.right + counts.wrong
    share, slope = share_and_slope(at, counts.changes)
    best = _log_posterior(at, share, mean, precision, counts)
    for _ in range(ROUNDS):
        gradient = slope.T @ (counts.right / share - counts.wrong / (1 - share)) - precision @ (at - mean)
        step = np.linalg.solve(_information(share, slope, answers) + precision, gradient)
        if gradient @ step < ENOUGH:
            break
        found = -math.inf
        while found < best and np.abs(step).max() > ENOUGH:
            tried = at + step
            share, slope = share_and_slope(tried, counts.changes)
            found, step = _log_posterior(tried, share, mean, precision, counts), 0.5 * step
        if found < best:
            share, slope = share_and_slope(at, counts.changes)
            break
        at, best = tried, found
    return at, _information(share, slope, answers) + precision


def _information(share: FloatArray, slope: FloatArray, answers: FloatArray) -> FloatArray:
    return np.asarray((slope.T * (answers / (share * (1 - share)))) @ slope)


def _log_posterior(
    at: FloatArray, share: FloatArray, mean: FloatArray, precision: FloatArray, counts: _Counts
) -> float:
    likely = counts.right @ np.log(share) + counts.wrong @ np.log1p(-share)
    return float(likely - 0.5 * (at - mean) @ precision @ (at - mean))


def share_and_slope(parameters: FloatArray, changes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return `share_correct` of one observer and its derivatives by its parameters, (changes, PARAMETERS)."""
    from scipy.special import expit, ndtr

    log_felt, logs, parts = summed(parameters, changes)
    logs = np.where(parts > 0, logs, 0.0)
    m, lapse = 1.0 + math.exp(parameters[SUMMATION]), float(expit(parameters[LAPSE]))
    by = np.zeros((PARAMETERS, len(changes)))
    by[JND] = -parts * np.exp(parameters[EXPONENT])[:, None]
    by[EXPONENT] = parts * logs
    by[SUMMATION] = (m - 1.0) / m * (np.sum(parts * logs, axis=0) - log_felt)
    felt = AT_JND * np.exp(log_felt)
    by *= (1.0 - lapse) * felt * np.exp(-0.5 * felt**2) / math.sqrt(2 * math.pi)
    by[LAPSE] = (0.5 - ndtr(felt)) * lapse * (1.0 - lapse)
    return np.asarray(0.5 * lapse + (1.0 - lapse) * ndtr(felt)), by.T
