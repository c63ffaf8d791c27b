"""Find the numbers of a rig from a few presses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.compensate._balance import (
    BACK_EMF,
    DELAY,
    ELECTRIC,
    FRICTION,
    GAIN,
    LAG,
    MASS,
    NUMBERS,
    PLAY,
    VISCOUS,
    WEIGHT,
)
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._prior import Prior
from fdvv.compensate._problem import Problem, Run
from fdvv.compensate._ticks import ticks_of
from fdvv.errors import FitError
from fdvv.model import Press
from fdvv.units import FloatArray

ROUNDS = 5
"""Windows and their weights depend on the numbers; they are found anew this often at most."""
SETTLED_ratio = 0.02
"""Of the prior's spread."""
RESIDUAL_s = 8e-3


def identify(presses: Sequence[Press], travel_mm: float, prior: Prior | None = None) -> KnownRig:
    """Find the numbers of a rig from a few whole presses at different speeds, of the rig's own columns alone.

    travel_mm : where the bottom stop was set. FitError, one line, on presses that do not tell enough.
    """
    prior = prior or Prior()
    if not presses:
        raise FitError("a rig cannot be known from no presses; make one at each of a few speeds")
    ticks = [ticks_of(press, f"press {i + 1}", prior.tick_s) for i, press in enumerate(presses)]
    problem = Problem(ticks, travel_mm, prior)
    numbers = problem.mean
    for made in range(ROUNDS):
        before, numbers = numbers, problem.improve(numbers, problem.runs(numbers))
        if made and np.all(np.abs(numbers - before) < SETTLED_ratio * problem.spread):
            break
    return _known(problem, numbers)


def _known(problem: Problem, numbers: FloatArray) -> KnownRig:
    runs = problem.runs(numbers)
    _, matrix = problem.normal(numbers, runs)
    misses = problem.misses(numbers)
    white = np.concatenate([run.white @ misses[run.press][run.rows] for run in runs])
    inflated = max(1.0, float(np.mean(white**2)))
    spread = problem.spread
    covariance = inflated * spread[:, np.newaxis] * np.linalg.inv(matrix) * spread
    middle = 0.5 * problem.travel_mm
    gain, error = _combined(covariance, middle)
    return KnownRig(
        gain=(float(numbers[0]), float(numbers[1]), float(numbers[2])),
        delay_s=float(numbers[DELAY] + numbers[ELECTRIC]),
        electric_lag_s=float(numbers[ELECTRIC]),
        position_lag_s=float(numbers[LAG]),
        drag_N_s_m=float(numbers[VISCOUS] + numbers[BACK_EMF]),
        back_emf_N_s_m=float(numbers[BACK_EMF]),
        friction_cN=float(numbers[FRICTION]),
        weight_cN=float(numbers[WEIGHT]),
        mass_g=float(numbers[MASS]),
        play_cN=2.0 * float(numbers[PLAY]),
        position_noise_mm=problem.position_noise_mm,
        force_noise_cN=problem.force_noise_cN,
        residual_cN=residual_cN(problem, numbers, runs),
        presses=len(problem.ticks),
        error={"gain": gain, **error},
    )


def _combined(covariance: FloatArray, middle_mm: float) -> tuple[float, dict[str, float]]:
    """Give standard errors of what a KnownRig holds, the gain's at middle_mm."""

    def of(*parts: tuple[int, float]) -> float:
        row = np.zeros(len(NUMBERS))
        for place, share in parts:
            row[place] = share
        return float(np.sqrt(row @ covariance @ row))

    return of((0, 1.0), (1, middle_mm), (2, middle_mm**2)), {
        "delay_s": of((DELAY, 1.0), (ELECTRIC, 1.0)),
        "electric_lag_s": of((ELECTRIC, 1.0)),
        "position_lag_s": of((LAG, 1.0)),
        "drag_N_s_m": of((VISCOUS, 1.0), (BACK_EMF, 1.0)),
        "back_emf_N_s_m": of((BACK_EMF, 1.0)),
        "friction_cN": of((FRICTION, 1.0)),
        "weight_cN": of((WEIGHT, 1.0)),
        "mass_g": of((MASS, 1.0)),
        "play_cN": of((PLAY, 2.0)),
    }


def residual_cN(problem: Problem, numbers: FloatArray, runs: list[Run]) -> float:
    """Give the rms of what is not explained, each a mean of RESIDUAL_s."""
    misses = problem.misses(numbers)
    count = max(1, round(RESIDUAL_s / (problem.stride * problem.tick_s)))
    box = np.full(count, 1.0 / count)
    even = [np.convolve(misses[run.press][run.rows], box, "same") for run in runs]
    return float(np.sqrt(np.mean(np.concatenate(even) ** 2)))


def numbers_of(known: KnownRig) -> FloatArray:
    """Give a known rig as the vector of NUMBERS."""
    found = np.zeros(len(NUMBERS))
    found[GAIN] = known.gain
    found[VISCOUS], found[BACK_EMF] = known.drag_N_s_m - known.back_emf_N_s_m, known.back_emf_N_s_m
    found[FRICTION], found[WEIGHT], found[MASS] = known.friction_cN, known.weight_cN, known.mass_g
    found[PLAY], found[LAG] = 0.5 * known.play_cN, known.position_lag_s
    found[DELAY], found[ELECTRIC] = known.delay_s - known.electric_lag_s, known.electric_lag_s
    return found
