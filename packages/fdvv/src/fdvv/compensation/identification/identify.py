"""Identification of a rig from a few presses: generalised least squares on the force balance.

The noise of force and position is known, so every run of windows is whitened. Position noise in the
regressors of drag and mass would bias them towards zero (errors in variables): its mean effect is removed
from the normal equations. Priors hold parameters that the presses do not show near typical values; the
spreads of what no number describes are those with the most evidence (empirical Bayes). Where a rig has no
force of its own over displacement, its spread becomes as good as none, and the numbers are those of the plain
model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from fdvv.compensation.identification.balance import (
    BACK_EMF,
    COUNT,
    DELAY,
    ELECTRIC,
    FRICTION,
    GAIN,
    LAG,
    MASS,
    OWN,
    PLAY,
    SIDE,
    STICK,
    VISCOUS,
    WEIGHT,
    ticks_of,
)
from fdvv.compensation.identification.estimation import RigEstimation, Unknown, WindowRun, whiten_runs
from fdvv.compensation.identification.own_force import NODES, LONG_cN, SHORT_cN
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.compensation.identification.whiteness import whiteness_of
from fdvv.errors import FitError
from fdvv.model.press import Press
from fdvv.units import FloatArray

NUMBERS: dict[str, tuple[tuple[int, float], ...]] = {
    "delay_s": ((DELAY, 1.0), (ELECTRIC, 1.0)),
    "electric_lag_s": ((ELECTRIC, 1.0),),
    "position_lag_s": ((LAG, 1.0),),
    "drag_N_s_m": ((VISCOUS, 1.0), (BACK_EMF, 1.0)),
    "back_emf_N_s_m": ((BACK_EMF, 1.0),),
    "friction_cN": ((FRICTION, 1.0),),
    "weight_cN": ((WEIGHT, 1.0),),
    "mass_g": ((MASS, 1.0),),
    "play_cN": ((PLAY, 2.0),),
    "stick_cN": ((STICK, 1.0),),
    "side_ratio": ((SIDE, 1.0),),
}
"""Numbers of a RigModel as sums of PARAMETERS."""
ROUNDS = 5
"""Windows and their weights depend on the parameters; they are recomputed at most this often."""
SETTLED_ratio = 0.02
"""Of the prior's spread."""
RESIDUAL_s = 8e-3  # assumed: a little over a window's 6 ms, within which neighbours share noise


def identify(presses: Sequence[Press], travel_mm: float, prior: Prior | None = None) -> RigModel:
    """Estimate the model of a rig from a few whole presses at different speeds, from the rig's own columns.

    travel_mm : position of the bottom stop. Raises FitError if the presses are not informative enough.
    """
    prior = prior or Prior()
    if not presses:
        raise FitError("identification needs presses; make one at each of a few speeds")
    ticks = [ticks_of(press, f"press {i + 1}", prior.tick_s) for i, press in enumerate(presses)]
    problem = RigEstimation(ticks, travel_mm, prior)
    numbers = problem.mean
    for made in range(ROUNDS):
        before, numbers = numbers, problem.improve(numbers, problem.runs(numbers))
        problem.expect(likeliest_unknown(problem, numbers))
        change = np.abs(numbers - before)[: problem.spread.size]
        if made and np.all(change < SETTLED_ratio * problem.spread):
            break
    return _rig_model(problem, numbers)


def _rig_model(problem: RigEstimation, numbers: FloatArray) -> RigModel:
    runs = problem.runs(numbers)
    white = whiteness_of(problem, numbers)
    covariance = _covariance(problem, numbers, runs) * white.widening
    middle_mm = 0.5 * problem.travel_mm
    # the gain's standard error is that at mid travel
    middle = (0, 1.0), (1, middle_mm), (2, middle_mm**2)
    rows = {name: along(*parts) for name, parts in {"gain": middle, **NUMBERS}.items()}
    # the level of the own force belongs to the weight
    rows["weight_cN"][OWN] = -1.0 / NODES
    own, level = numbers[OWN], float(numbers[OWN].mean())
    values = {name: float(row @ numbers) for name, row in rows.items() if name != "gain"}
    apart = np.eye(NODES) - 1.0 / NODES
    own_variance = float(np.trace(apart @ covariance[OWN, OWN] @ apart)) / NODES
    return RigModel(
        gain=(float(numbers[0]), float(numbers[1]), float(numbers[2])),
        **values,
        own_cN=tuple((own - level).tolist()),
        own_step_mm=problem.own_step_mm,
        position_noise_mm=problem.position_noise_mm,
        force_noise_cN=problem.force_noise_cN,
        residual_cN=residual_cN(problem, numbers, runs),
        presses=len(problem.ticks),
        error={
            **{name: float(np.sqrt(row @ covariance @ row)) for name, row in rows.items()},
            "own_cN": own_variance**0.5,
        },
        at_bound=_at_bound(problem, numbers),
        misfit=white.misfit,
    )


def _covariance(problem: RigEstimation, numbers: FloatArray, runs: list[WindowRun]) -> FloatArray:
    """Return the posterior covariance, wider where the whitened residuals exceed their expected size."""
    _, matrix = problem.normal(numbers, runs)
    residuals = problem.residuals(numbers)
    white = np.concatenate([run.white @ residuals[run.press][run.rows] for run in runs])
    inflated = max(1.0, float(np.mean(white**2)))
    return np.asarray(inflated * problem.root @ np.linalg.inv(matrix) @ problem.root.T)


def _at_bound(problem: RigEstimation, numbers: FloatArray) -> tuple[str, ...]:
    """Return the numbers whose parameters all rest on a bound."""
    near = 1e-3 * problem.spread
    low, high = (bound[: near.size] for bound in (problem.low, problem.high))
    resting = np.abs(numbers[: near.size, np.newaxis] - np.stack([low, high], axis=1)).min(axis=1) < near
    return tuple(name for name, parts in NUMBERS.items() if all(resting[place] for place, _ in parts))


def along(*parts: tuple[int | slice, FloatArray | float]) -> FloatArray:
    """Return a direction in the space of PARAMETERS."""
    row = np.zeros(COUNT)
    for place, share in parts:
        row[place] = share
    return row


def residual_cN(problem: RigEstimation, numbers: FloatArray, runs: list[WindowRun]) -> float:
    """Return the rms of the residuals, averaged over RESIDUAL_s."""
    residuals = problem.residuals(numbers)
    count = max(1, round(RESIDUAL_s / (problem.stride * problem.tick_s)))
    box = np.full(count, 1.0 / count)
    even = [np.convolve(residuals[run.press][run.rows], box, "same") for run in runs]
    return float(np.sqrt(np.mean(np.concatenate(even) ** 2)))


def parameter_vector(rig: RigModel, own_step_mm: float) -> FloatArray:
    """Return a rig as the vector of parameters, its own force at steps of own_step_mm."""
    numbers = np.zeros(COUNT)
    numbers[GAIN] = rig.gain
    numbers[VISCOUS], numbers[BACK_EMF] = rig.drag_N_s_m - rig.back_emf_N_s_m, rig.back_emf_N_s_m
    numbers[FRICTION], numbers[WEIGHT], numbers[MASS] = rig.friction_cN, rig.weight_cN, rig.mass_g
    numbers[PLAY], numbers[LAG] = 0.5 * rig.play_cN, rig.position_lag_s
    numbers[STICK], numbers[SIDE] = rig.stick_cN, rig.side_ratio
    numbers[OWN] = rig.own_at(np.arange(NODES, dtype=np.float64) * own_step_mm) + rig.weight_cN
    numbers[DELAY], numbers[ELECTRIC] = rig.delay_s - rig.electric_lag_s, rig.electric_lag_s
    return numbers


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
    best, likeliest = -np.inf, problem.unknown
    for force_cN, force_s in product(FORCES_cN, FORCES_s):
        unknown = Unknown(force_cN=force_cN, force_s=force_s)
        runs = whiten_runs(spans, problem.autocovariance(numbers, longest, unknown))
        seen = _likelihood(runs, presses)
        for long_cN, short_cN in product(LONG_cN, SHORT_cN):
            tried = replace(unknown, long_cN=long_cN, short_cN=short_cN)
            evidence = _evidence(seen, problem.prior_root(tried), numbers - problem.mean)
            if evidence > best:
                best, likeliest = evidence, tried
    return likeliest


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
