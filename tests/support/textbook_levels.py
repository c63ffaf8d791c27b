"""Distances, resampled intervals and staircases as textbooks define them: slow, and nothing of fdvv in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise, product

import numpy as np
import numpy.typing as npt
from scipy import stats
from scipy.optimize import brentq, minimize

Array = npt.NDArray[np.float64]
NODES = np.linspace(-6, 6, 81)
Z = float(stats.norm.ppf(0.975))
LIMIT = float(stats.chi2.ppf(0.95, 1))


def log_likelihood_2ac(counts: Array, d: float, tau: float, sd: float = 0.0) -> float:
    """Return that of counts (people, 3), people's own d' normal about d, summed on a fine grid."""
    own = d + sd * NODES
    first, second = stats.norm.cdf((-tau - own) / np.sqrt(2)), stats.norm.cdf((own - tau) / np.sqrt(2))
    logs = np.log(np.maximum([first, 1 - first - second, second], 1e-300))
    weight = stats.norm.pdf(NODES) * (NODES[1] - NODES[0])
    return float(np.sum(np.log(np.exp(counts @ logs) @ weight)))


def deviance_2ac(counts: Sequence[float], d: float) -> float:
    """Return twice how far the log-likelihood at d, at the best tau of a fine grid, is below its maximum."""
    found = np.array(counts, dtype=float)
    tau = np.concatenate([[0.0], np.geomspace(1e-4, abs(d) + 12, 20_000)]) if found[1] else np.zeros(1)
    first, second = stats.norm.cdf((-tau - d) / np.sqrt(2)), stats.norm.cdf((d - tau) / np.sqrt(2))
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log(np.array([first, np.maximum(1 - first - second, 0), second]))
        at = np.sum(np.where(found[:, None] > 0, found[:, None] * logs, 0.0), axis=0).max()
        best = np.sum(np.where(found > 0, found * np.log(found / found.sum()), 0.0))
    return float(2 * (best - at))


def best_2ac(counts: Array) -> tuple[float, float, float]:
    """Return d', tau and spread at the maximum that Nelder and Mead find."""
    lower, _, upper = counts.sum(axis=0) / counts.sum()
    a, b = np.sqrt(2) * stats.norm.ppf(lower), np.sqrt(2) * stats.norm.ppf(upper)

    def falling(at: Array) -> float:
        return -log_likelihood_2ac(counts, float(at[0]), abs(float(at[1])), abs(float(at[2])))

    begin = np.array([(b - a) / 2, -(a + b) / 2, 0.8])
    found = minimize(falling, begin, method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-8})
    return float(found.x[0]), abs(float(found.x[1])), abs(float(found.x[2]))


def error_2ac(counts: Array, d: float, tau: float, sd: float, step: float = 2e-3) -> float:
    """Return the standard error of d' from the curvature of the log-likelihood."""
    at, places = np.array([d, tau, sd]), np.eye(3) * step

    def f(x: Array) -> float:
        return log_likelihood_2ac(counts, *x.tolist())

    bend = [[f(at + a + b) - f(at + a - b) - f(at - a + b) + f(at - a - b) for b in places] for a in places]
    return float(np.sqrt(np.linalg.inv(-np.array(bend) / (4 * step**2))[0, 0]))


def effective(successes: Array, n: Array) -> float:
    """Return how many independent answers people's answers are worth (Korn and Graubard 1998)."""
    share, total = successes.sum() / n.sum(), n.sum()
    if share in (0.0, 1.0):
        return float(n.size)
    between = n.size / (n.size - 1) * np.sum((n / total) ** 2 * (successes / n - share) ** 2)
    if between == 0 or total == n.size:
        return float(total)
    t = stats.t.ppf(0.975, total - 1) / stats.t.ppf(0.975, n.size - 1)
    return float(min(total, share * (1 - share) / between * t**2))


def likeness(groups: Sequence[Sequence[float]]) -> float:
    """Return the intraclass correlation of one-way analysis of variance, groups of uneven size, 0 to 1."""
    every = np.concatenate([np.asarray(one, dtype=float) for one in groups])
    sizes, means = np.array([len(one) for one in groups]), np.array([np.mean(one) for one in groups])
    between = float(np.sum(sizes * (means - every.mean()) ** 2)) / (len(groups) - 1)
    within = float(sum(np.sum((np.asarray(one) - np.mean(one)) ** 2) for one in groups))
    within /= every.size - len(groups)
    typical = (every.size - float(np.sum(sizes**2)) / every.size) / (len(groups) - 1)
    below = between + (typical - 1) * within
    return min(1.0, max(0.0, (between - within) / below)) if below > 0 else 0.0


def exact_bca(statistic: Callable[[Array], Array], people: Array) -> tuple[Array, float, float]:
    """Return every resample's statistic, sorted, and the tails of the BCa interval (Efron 1987).

    people : (n, columns), of which all n^n resamples are listed. statistic : of (..., n, columns).
    """
    n = len(people)
    whole = float(statistic(people))
    places = np.array(list(product(range(n), repeat=n)))
    every = np.sort(statistic(people[places]))
    # of a tie one half counts as less
    z0 = stats.norm.ppf((np.mean(every < whole) + np.mean(every <= whole)) / 2)
    left = np.array([float(statistic(np.delete(people, i, axis=0))) for i in range(n)])
    apart = left.mean() - left
    a = np.sum(apart**3) / (6 * np.sum(apart**2) ** 1.5)
    low, high = (float(stats.norm.cdf(z0 + (z0 + z) / (1 - a * (z0 + z)))) for z in (-Z, Z))
    return every, low, high


def turns_of(ratios: Array, correct: npt.NDArray[np.bool_], down: int) -> list[float]:
    """List the ratios at which a transformed up-down rule turned round: its steps, one after the other."""
    steps: list[tuple[float, int]] = []
    row = 0
    for ratio, right in zip(ratios.tolist(), correct.tolist(), strict=True):
        row = row + 1 if right else 0
        if not right:
            steps.append((ratio, 1))
        elif row == down:
            steps.append((ratio, -1))
            row = 0
    return [after[0] for before, after in pairwise(steps) if before[1] != after[1]]


def threshold_bounds(ratios: Array, correct: Array, share: float, lapse: float = 0.02) -> tuple[float, float]:
    """Integrate a cumulative normal over the logarithm, its threshold flat and its spread about 0.75."""
    places, spreads = np.log(np.geomspace(0.002, 3.0, 1001)), np.geomspace(0.15, 2.4, 11)
    belief = np.zeros(places.size)
    for spread in spreads:
        middle = places - spread * stats.norm.ppf((share - 0.5) / (0.5 - lapse))
        p = 0.5 + (0.5 - lapse) * stats.norm.cdf((np.log(ratios) - middle[:, None]) / spread)
        logs = np.log(np.where(correct, p, 1 - p)).sum(axis=1)
        belief += np.exp(logs + stats.norm.logpdf(np.log(spread / 0.75), scale=0.6) + 40)
    passed = np.cumsum(belief) / belief.sum()
    low, high = np.exp(np.interp([0.025, 0.975], passed, places))
    return float(low), float(high)


def abx(d: float) -> float:
    """Return the share correct of ABX by differencing (Macmillan and Creelman)."""
    return _alike(d / np.sqrt(2), d / np.sqrt(6))


def abx_independent(d: float) -> float:
    """Return that of ABX where all three are judged for themselves."""
    return _alike(d / np.sqrt(2), d / 2)


def _alike(a: float, b: float) -> float:
    phi = stats.norm.cdf
    return float(phi(a) * phi(b) + phi(-a) * phi(-b))


def distance(share: float, rule: Callable[[float], float], signed: bool) -> float:
    """Return the d' at which a rule has a share of correct answers."""
    if share < 0.5:
        return -distance(1 - share, rule, signed) if signed else 0.0
    return np.inf if share >= rule(12.0) else float(brentq(lambda d: rule(d) - share, 0, 12))


def greenhouse_geisser(values: Array) -> float:
    """Return epsilon of (people, levels) from the double-centred covariance (Greenhouse and Geisser 1959)."""
    covariance = np.cov(values, rowvar=False)
    k = len(covariance)
    top = k**2 * (np.trace(covariance) / k - covariance.mean()) ** 2
    rows = covariance.mean(axis=1)
    below = np.sum(covariance**2) - 2 * k * np.sum(rows**2) + k**2 * covariance.mean() ** 2
    return float(top / ((k - 1) * below))
