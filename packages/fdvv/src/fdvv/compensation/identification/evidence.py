"""How large the unknown is: the spreads under which the presses are most probable (empirical Bayes).

Where a rig has no force of its own over displacement, its spread becomes as good as none, and the numbers
are those of the plain model.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from fdvv.compensation.identification.balance import COUNT
from fdvv.compensation.identification.estimation import RigEstimation, Unknown, WindowRun, whitened_runs
from fdvv.compensation.identification.own_force import LONG_cN, SHORT_cN
from fdvv.units import FloatArray

FORCES_cN, FORCES_s = (0.3, 0.6, 1.2, 2.4, 4.8), (0.006, 0.025)
"""Rms and correlation times of unmodelled force that are tried."""


@dataclass(frozen=True, eq=False)
class _Likelihood:
    """Of the presses alone: gradient, normal matrix, squared residuals and log determinant of their noise."""

    gradient: FloatArray
    matrix: FloatArray
    squares: float
    logarithm: float


def likeliest_unknown(problem: RigEstimation, numbers: FloatArray) -> Unknown:
    """Return the spreads with the most evidence, the problem linear around these numbers."""
    spans, presses = problem.spans(numbers), problem.slopes(numbers)
    longest = max(rows.size for _, rows in spans)
    best, found = -np.inf, problem.unknown
    for force_cN, force_s in product(FORCES_cN, FORCES_s):
        unknown = Unknown(force_cN=force_cN, force_s=force_s)
        runs = whitened_runs(spans, problem.autocovariance(numbers, longest, unknown))
        seen = _likelihood(runs, presses)
        for long_cN, short_cN in product(LONG_cN, SHORT_cN):
            tried = replace(unknown, long_cN=long_cN, short_cN=short_cN)
            evidence = _evidence(seen, problem.prior_root(tried), numbers - problem.mean)
            if evidence > best:
                best, found = evidence, tried
    return found


def _likelihood(runs: list[WindowRun], presses: list[tuple[FloatArray, FloatArray]]) -> _Likelihood:
    gradient, matrix, squares, logarithm = np.zeros(COUNT), np.zeros((COUNT, COUNT)), 0.0, 0.0
    for run in runs:
        residual, slope = (run.white @ column[run.rows] for column in presses[run.press])
        gradient += slope.T @ residual
        matrix += slope.T @ slope
        squares += float(residual @ residual)
        logarithm -= 2.0 * float(np.log(np.diag(run.white)).sum())
    return _Likelihood(gradient, matrix, squares, logarithm)


def _evidence(seen: _Likelihood, root: FloatArray, off: FloatArray) -> float:
    """Return the log evidence, but for a constant; off: the numbers less the prior's mean."""
    pull = root.T @ (seen.gradient + seen.matrix @ off)
    factor = np.linalg.cholesky(root.T @ seen.matrix @ root + np.eye(off.size))
    explained = float(np.sum(np.linalg.solve(factor, pull) ** 2))
    squares = seen.squares + 2.0 * float(off @ seen.gradient) + float(off @ seen.matrix @ off)
    return -0.5 * (seen.logarithm + squares - explained) - float(np.log(np.diag(factor)).sum())
