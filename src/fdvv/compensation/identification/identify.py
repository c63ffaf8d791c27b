"""Identification of a rig from a few presses: generalised least squares on the force balance.

The noise of force and position is known, so every run of windows is whitened. Position noise in the
regressors of drag and mass would bias them towards zero (errors in variables): its mean effect is removed
from the normal equations. Priors hold parameters that the presses do not show near typical values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.balance import (
    BACK_EMF,
    DELAY,
    ELECTRIC,
    FRICTION,
    GAIN,
    LAG,
    MASS,
    MOVING,
    PARAMETERS,
    PLAY,
    VISCOUS,
    WEIGHT,
    Ticks,
    noise,
    noise_windows,
    play_stretch,
    predicted,
    rendered_cN,
    slopes,
    ticks_of,
    true_runs,
    usable_windows,
    windows,
)
from fdvv.compensation.identification.rig_model import Prior, RigModel
from fdvv.compensation.presses import HOME_mm
from fdvv.compensation.tables import smooth
from fdvv.errors import FitError, ModelError
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

STEPS, DAMPINGS = 4, 6
SETTLED = 1e-3
"""Iterations end when a step lowers the cost, in squared standard deviations, by less."""
FEWEST_windows = 12
SPACING_s = 7.5e-4
"""Spacing of the windows used; closer ones are redundant."""
LEAST_NOISE_cN = 0.2
FASTEST_Hz = 25.0
"""Above it the weight of windows falls: position noise, which the controller passes
into its command, would be mistaken for a response of the rig."""
UNMODELLED_cN, UNMODELLED_s = 0.3, 0.006
"""Rms and correlation time of unmodelled force."""


@dataclass(frozen=True, eq=False)
class WindowRun:
    """A contiguous run of windows: its rows in the press, and its whitening matrix."""

    press: int
    rows: npt.NDArray[np.intp]
    white: FloatArray
    diagonals: FloatArray


class RigEstimation:
    """The least-squares problem: the presses and the prior."""

    def __init__(self, ticks: list[Ticks], travel_mm: float, prior: Prior) -> None:
        self.ticks, self.travel_mm, self.sensor = ticks, travel_mm, prior.sensor
        self.tick_s = ticks[0].tick_s
        self.mean, self.spread, self.low, self.high = prior.vectors(self.tick_s)
        self.rendered = [rendered_cN(t, self.sensor) for t in ticks]
        self.stretches = [play_stretch(t) for t in ticks]
        self.position_noise_mm = noise([t.sensed_mm for t in ticks])
        self.force_noise_cN = noise([t.force_cN for t in ticks])
        self.quiet_cN = max(self.force_noise_cN, LEAST_NOISE_cN)
        self.stride = max(1, round(SPACING_s / self.tick_s))

    def runs(self, numbers: FloatArray) -> list[WindowRun]:
        """Return the runs of windows, each with the whitening matrix for these parameters."""
        force, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        found = []
        for i, t in enumerate(self.ticks):
            for a, b in true_runs(usable_windows(t, numbers[LAG], self.travel_mm)):
                rows = np.arange(a, b, self.stride)
                if rows.size > 2:
                    found.append(self._run(i, rows, force, position))
        if sum(run.rows.size for run in found) < FEWEST_windows:
            raise FitError(
                "the presses hold too few rows between the stops to identify a rig; "
                "press all the way down and back, with the cap held up at rest"
            )
        return found

    def _run(
        self, press: int, rows: npt.NDArray[np.intp], force: FloatArray, position: FloatArray
    ) -> WindowRun:
        from scipy.linalg import cholesky, solve_triangular, toeplitz

        n = rows.size
        row = self.quiet_cN**2 * self.covariance(force, force, n)
        row += self.position_noise_mm**2 * self.covariance(position, position, n)
        fast = windows(self.tick_s)[3]
        row += (self.quiet_cN / (2 * np.pi * FASTEST_Hz) ** 3) ** 2 * self.covariance(fast, fast, n)
        row += UNMODELLED_cN**2 * np.exp(-np.arange(n) * self.stride * self.tick_s / UNMODELLED_s)
        root = cholesky(toeplitz(row), lower=True)
        white = solve_triangular(root, np.eye(n), lower=True)
        inverse = white.T @ white
        diagonals = np.array([np.trace(inverse, k) * (1.0 if k == 0 else 2.0) for k in range(n)])
        return WindowRun(press, rows, white, diagonals)

    def covariance(self, one: FloatArray, other: FloatArray, n: int) -> FloatArray:
        """Return the cross-covariance of white noise after two windows, for lags of 0 to n - 1 rows, (n,)."""
        full = np.correlate(one, other, "full")
        even = 0.5 * (full + full[::-1])[one.size - 1 :: self.stride]
        return np.pad(even, (0, max(0, n - even.size)))[:n]

    def noise_bias(self, numbers: FloatArray, runs: list[WindowRun]) -> tuple[FloatArray, FloatArray]:
        """Return the bias of gradient, (12,), and normal matrix, (12, 12), by position noise."""
        _, position, into = noise_windows(self.tick_s, numbers, self.sensor)
        gradient, matrix = np.zeros(len(PARAMETERS)), np.zeros((len(PARAMETERS), len(PARAMETERS)))
        longest = max(run.rows.size for run in runs)
        diagonals = sum(np.pad(run.diagonals, (0, longest - run.rows.size)) for run in runs)
        variance = self.position_noise_mm**2
        for i, place in enumerate(MOVING):
            gradient[place] = -variance * diagonals @ self.covariance(into[i], position, longest)
            for j, other in enumerate(MOVING):
                matrix[place, other] = variance * diagonals @ self.covariance(into[i], into[j], longest)
        return gradient, matrix

    def cost(self, numbers: FloatArray, runs: list[WindowRun]) -> float:
        """Return the squared whitened residuals plus those of the prior, minus the bias by position noise."""
        residuals = self.residuals(numbers)
        total = float(np.sum(((numbers - self.mean) / self.spread) ** 2))
        _, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        for run in runs:
            total += float(np.sum((run.white @ residuals[run.press][run.rows]) ** 2))
            added = self.covariance(position, position, run.rows.size)
            total -= self.position_noise_mm**2 * float(run.diagonals @ added)
        return total

    def residuals(self, numbers: FloatArray) -> list[FloatArray]:
        each = zip(self.rendered, self.ticks, self.stretches, strict=True)
        return [rendered - predicted(t, numbers, s, self.sensor) for rendered, t, s in each]

    def normal(self, numbers: FloatArray, runs: list[WindowRun]) -> tuple[FloatArray, FloatArray]:
        """Return the negative gradient, (12,), and normal matrix, (12, 12), both in spreads of the prior."""
        gradient, matrix = (-part for part in self.noise_bias(numbers, runs))
        each = zip(self.ticks, self.stretches, strict=True)
        predictions = [slopes(t, numbers, s, self.sensor) for t, s in each]
        for run in runs:
            force, slope = predictions[run.press]
            white = run.white @ slope[run.rows]
            gradient += white.T @ (run.white @ (self.rendered[run.press] - force)[run.rows])
            matrix += white.T @ white
        gradient = self.spread * gradient - (numbers - self.mean) / self.spread
        # less the noise's mean effect the matrix may bend the wrong way along what no press shows
        size, axes = np.linalg.eigh(self.spread[:, np.newaxis] * matrix * self.spread)
        return gradient, (axes * np.maximum(size, 0.0)) @ axes.T + np.eye(numbers.size)

    def improve(self, numbers: FloatArray, runs: list[WindowRun]) -> FloatArray:
        """Take a few damped Gauss-Newton steps."""
        cost, damping = self.cost(numbers, runs), 1e-3
        for _ in range(STEPS):
            gradient, matrix = self.normal(numbers, runs)
            for _ in range(DAMPINGS):
                step = np.linalg.solve(matrix + damping * np.diag(np.diag(matrix)), gradient)
                tried = np.clip(numbers + self.spread * step, self.low, self.high)
                new = self.cost(tried, runs)
                if new < cost:
                    break
                damping *= 10.0
            else:
                return numbers
            settled = cost - new < SETTLED
            numbers, cost, damping = tried, new, 0.1 * damping
            if settled:
                break
        return numbers


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
}
"""Numbers of a RigModel as sums of PARAMETERS."""
ROUNDS = 5
"""Windows and their weights depend on the parameters; they are recomputed at most this often."""
SETTLED_ratio = 0.02
"""Of the prior's spread."""
RESIDUAL_s = 8e-3


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
        if made and np.all(np.abs(numbers - before) < SETTLED_ratio * problem.spread):
            break
    return _rig_model(problem, numbers)


def _rig_model(problem: RigEstimation, numbers: FloatArray) -> RigModel:
    runs = problem.runs(numbers)
    _, matrix = problem.normal(numbers, runs)
    residuals = problem.residuals(numbers)
    white = np.concatenate([run.white @ residuals[run.press][run.rows] for run in runs])
    inflated = max(1.0, float(np.mean(white**2)))
    spread = problem.spread
    covariance = inflated * spread[:, np.newaxis] * np.linalg.inv(matrix) * spread
    middle_mm = 0.5 * problem.travel_mm
    # the gain's standard error is that at mid travel
    middle = (0, 1.0), (1, middle_mm), (2, middle_mm**2)
    rows = {name: along(*parts) for name, parts in {"gain": middle, **NUMBERS}.items()}
    return RigModel(
        gain=(float(numbers[0]), float(numbers[1]), float(numbers[2])),
        **{name: sum(share * float(numbers[at]) for at, share in parts) for name, parts in NUMBERS.items()},
        position_noise_mm=problem.position_noise_mm,
        force_noise_cN=problem.force_noise_cN,
        residual_cN=residual_cN(problem, numbers, runs),
        presses=len(problem.ticks),
        error={name: float(np.sqrt(row @ covariance @ row)) for name, row in rows.items()},
    )


def along(*parts: tuple[int | slice, FloatArray | float]) -> FloatArray:
    """Return a direction in the space of PARAMETERS."""
    row = np.zeros(len(PARAMETERS))
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


def parameter_vector(rig: RigModel) -> FloatArray:
    """Return a rig as the vector of PARAMETERS."""
    found = np.zeros(len(PARAMETERS))
    found[GAIN] = rig.gain
    found[VISCOUS], found[BACK_EMF] = rig.drag_N_s_m - rig.back_emf_N_s_m, rig.back_emf_N_s_m
    found[FRICTION], found[WEIGHT], found[MASS] = rig.friction_cN, rig.weight_cN, rig.mass_g
    found[PLAY], found[LAG] = 0.5 * rig.play_cN, rig.position_lag_s
    found[DELAY], found[ELECTRIC] = rig.delay_s - rig.electric_lag_s, rig.electric_lag_s
    return found


HOLD_cN = 80.0
"""Twice the heaviest mover of the class: the weight to hold up is not known yet."""
FADE_mm = 0.3
RIPPLES_mm = ((0.9, 0.55), (0.75, 0.6))
"""Wavelengths of the ripples over displacement, press and release."""
PHASES_rad = ((0.0, 1.0), (2.0, 0.0))
SMALLER_ratio = 0.7


def identification_surface(
    target: ForceSurface, weight_cN: float = 20.0, ripple_cN: float = 8.0, limit_cN: float = 440.0
) -> ForceSurface:
    """Return commands that excite every parameter and still feel like a rough button.

    The target plus about the mover's weight, with ripples over displacement that differ between press and
    release: this decorrelates command and motion. They fade at the ends. The first 0.1 mm commands at least
    80 cN, else the cap sinks under a resting finger.

    target : the button's own force; weight_cN : a guess; ripple_cN : amplitude of the longer ripple;
    limit_cN : the largest command of the device.
    """
    if not (ripple_cN >= 0 and limit_cN > HOLD_cN):
        raise ModelError(
            f"ripples need 0 cN or more within a limit above {HOLD_cN:g} cN, got {ripple_cN}, {limit_cN}"
        )
    x = target.displacement_mm
    press, release = (
        np.stack([_held(x, row + weight_cN + ripple_cN * _ripple(x, stroke), limit_cN) for row in table])
        for stroke, table in enumerate((target.press_cN, target.release_cN))
    )
    return ForceSurface(x, target.velocity_mm_s, press, release)


def _ripple(x_mm: FloatArray, stroke: int) -> FloatArray:
    long, short = (
        np.sin(2 * np.pi * x_mm / length + phase)
        for length, phase in zip(RIPPLES_mm[stroke], PHASES_rad[stroke], strict=True)
    )
    waves = long + SMALLER_ratio * short
    depth = np.minimum(x_mm - x_mm[0] - HOME_mm, x_mm[-1] - x_mm)
    return np.asarray(np.clip(depth / FADE_mm, 0.0, 1.0) * waves)


def _held(x_mm: FloatArray, command_cN: FloatArray, limit_cN: float) -> FloatArray:
    """Apply the minimum command at rest, faded out without a step, and the limit."""
    least = HOLD_cN * np.clip(1.0 - (x_mm - HOME_mm) / FADE_mm, 0.0, 1.0)
    step_mm = float(x_mm[1] - x_mm[0])
    held = smooth(np.maximum(command_cN, least), 0.5 * step_mm, step_mm)
    return np.clip(np.where(x_mm <= HOME_mm, np.maximum(held, HOLD_cN), held), -limit_cN, limit_cN)
