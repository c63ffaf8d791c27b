"""Modes that a housing rings in at every pace, rings fitted again with them, and how they scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import FitError
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray
from fdvv.vibration.pool import MeasuredVibration, SAME_ratio, SnapEnergy, measure_vibration, reliable_rings
from fdvv.vibration.ring import Ring, refit_ring
from fdvv.vibration.snap import HeardPress, NotFound

FLOOR_ratio = (0.005, 0.02)
"""No frequency and no decay of one pace is weighed as known better: drives are in no standard error."""
Known = tuple[tuple[float, float], ...]
REFERENCE_mm_s = 100.0
USUAL_EXPONENT = 1.0
"""Amplitude in proportion to the velocity of the impact (Fiene and Kuchenbecker 2007)."""


@dataclass(frozen=True)
class SharedMode:
    """A mode of the housing estimated from several paces: weighted medians and their standard errors."""

    frequency_Hz: float
    decay_1_s: float
    frequency_sd_Hz: float
    decay_sd_1_s: float
    paces: int


def common_mode(rings: Sequence[Ring]) -> SharedMode | None:
    """Return the principal mode that rings of one housing share; None if fewer than two agree.

    What frequency and decay a plate rings at does not depend on how fast a finger presses; what a drive that
    goes on does to them does. The weighted median over paces is not moved by one of them.
    """
    modes = [ring.mode for ring in rings]
    if len(modes) < 2:
        return None
    middle, _ = _middle([(m.frequency_Hz, m.frequency_sd_Hz) for m in modes], FLOOR_ratio[0])
    modes = [m for m in modes if abs(m.frequency_Hz / middle - 1) <= SAME_ratio]
    if len(modes) < 2:
        return None
    f, f_sd = _middle([(m.frequency_Hz, m.frequency_sd_Hz) for m in modes], FLOOR_ratio[0])
    d, d_sd = _middle([(m.decay_1_s, m.decay_sd_1_s) for m in modes], FLOOR_ratio[1])
    return SharedMode(f, d, f_sd, d_sd, len(modes))


def common_rings(rings: Sequence[Ring]) -> tuple[tuple[float, float], ...]:
    """Return frequency and decay of two modes at most that searches of all paces can build on.

    The principal one that is known best, and the one of the others that most rings have.
    """
    known = [(ring.mode.frequency_sd_Hz / ring.mode.frequency_Hz, reliable_rings(ring)) for ring in rings]
    first = [(doubt, modes[0]) for doubt, modes in known if modes]
    if not first:
        return ()
    others = [mode for _, modes in known for mode in modes[1:]]
    votes = [sum(abs(other[0] / mode[0] - 1) <= SAME_ratio for other in others) for mode in others]
    second = [others[int(np.argmax(votes))]] if others else []
    return (min(first)[1], *second)


def refit_shared(result: MeasuredVibration, mode: SharedMode) -> MeasuredVibration:
    """Fit a ring again with the principal mode that the paces share: its amplitudes, and the other modes.

    As it was where its own is another mode, or where what the shared one leaves is no longer noise.
    """
    ring = result.ring
    if isinstance(ring, NotFound) or abs(ring.mode.frequency_Hz / mode.frequency_Hz - 1) > SAME_ratio:
        return result
    again = refit_ring(result.heard, result.snaps, (mode.frequency_Hz, mode.decay_1_s))
    if again is None:
        return result
    first = replace(
        again.mode,
        frequency_sd_Hz=mode.frequency_sd_Hz,
        decay_sd_1_s=mode.decay_sd_1_s,
        frequency_spread_Hz=ring.mode.frequency_spread_Hz,
        decay_spread_1_s=ring.mode.decay_spread_1_s,
    )
    return replace(result, ring=replace(again, mode=first, modes=(first, *again.modes[1:])))


def _middle(values: Sequence[tuple[float, float]], floor_ratio: float) -> tuple[float, float]:
    """Return the weighted median of values with errors, and its standard error, from these or the scatter."""
    value, sd = np.array(values)[np.argsort([each for each, _ in values])].T
    sd = np.maximum(sd, floor_ratio * np.median(value))
    weight = 1 / sd**2
    share = (np.cumsum(weight) - 0.5 * weight) / weight.sum()
    middle = float(np.interp(0.5, share, value))
    scatter = float(np.sqrt(np.sum(weight * (value - middle) ** 2) / weight.sum() / (value.size - 1)))
    return middle, max(scatter, float(weight.sum() ** -0.5))


@dataclass(frozen=True, eq=False)
class PacePresses:
    """The presses of one stroke at one pace, and the fall of force that drives their snap, if any."""

    stroke: Stroke
    velocity_mm_s: float
    presses: tuple[HeardPress, ...]
    energy: SnapEnergy | None


def measure_paces(
    paces: Sequence[PacePresses], acceleration: bool
) -> tuple[list[MeasuredVibration | NotFound], SharedMode | None]:
    """Measure the vibration of every stroke and pace of one button, and the mode that they share.

    acceleration : the signal is an acceleration, not a velocity.

    Presses are measured by themselves first, then again where others of them have modes that they lack;
    releases with the modes of the presses. Rings are fitted again with the principal mode that they share.
    """
    first = [_measure(pace, acceleration, ()) for pace in paces if pace.stroke is Stroke.PRESS]
    known, results = common_rings(_rings(first)), iter(first)
    again = [
        _sharper(next(results), pace, acceleration, known)
        if pace.stroke is Stroke.PRESS
        else _measure(pace, acceleration, known)
        for pace in paces
    ]
    mode = common_mode(_rings(again))
    if mode is not None:
        again = [result if isinstance(result, NotFound) else refit_shared(result, mode) for result in again]
    return again, mode


def _measure(pace: PacePresses, acceleration: bool, known: Known) -> MeasuredVibration | NotFound:
    if not pace.presses:
        return NotFound("no press of it was heard")
    return measure_vibration(pace.presses, pace.velocity_mm_s, pace.energy, acceleration, known)


def _sharper(
    was: MeasuredVibration | NotFound, pace: PacePresses, acceleration: bool, known: Known
) -> MeasuredVibration | NotFound:
    """Measure again where a known mode is missing; kept if as many presses show it."""
    if not known or (isinstance(was, MeasuredVibration) and all(was.rings_in(f) for f, _ in known)):
        return was
    again = _measure(pace, acceleration, known)
    if isinstance(was, MeasuredVibration) and (isinstance(again, NotFound) or again.shown < was.shown):
        return was
    return again


def _rings(results: Sequence[MeasuredVibration | NotFound]) -> list[Ring]:
    return [r.ring for r in results if isinstance(r, MeasuredVibration) and isinstance(r.ring, Ring)]


@dataclass(frozen=True)
class Scaling:
    """Amplitude = amplitude_at_100 (v / 100 mm/s)^exponent (E / energy_mJ)^(1/2).

    Attributes
    ----------
    amplitude_at_100 : at 100 mm/s and energy_mJ, in the unit of what was fitted.
    exponent, exponent_sd : and its standard error; infinite where the exponent was assumed, not measured.
    log_sd : spread of the measured amplitudes about the law, as a natural logarithm; 0 for one amplitude.
    energy_mJ : geometric mean of the energies; None if none were given and the last factor is 1.
    velocities_mm_s : at which amplitudes were measured.
    """

    amplitude_at_100: float
    exponent: float
    exponent_sd: float
    log_sd: float
    energy_mJ: float | None
    velocities_mm_s: tuple[float, ...]

    def amplitude(self, velocity_mm_s: float, energy_mJ: float | None = None) -> float:
        """Predict the amplitude at a velocity, and at an energy if the law has one."""
        drive = 1.0 if self.energy_mJ is None or energy_mJ is None else math.sqrt(energy_mJ / self.energy_mJ)
        return float(self.amplitude_at_100 * (velocity_mm_s / REFERENCE_mm_s) ** self.exponent * drive)


def fit_scaling(
    velocity_mm_s: Sequence[float], amplitude: Sequence[float], energy_mJ: Sequence[float] | None = None
) -> Scaling:
    """Fit the power law of amplitude over velocity, by least squares of logarithms.

    velocity_mm_s, amplitude : one each per velocity at which the snap was found.
    energy_mJ : of the fall of force at each; a vibration's energy goes with the square of its amplitude, so
        its exponent is a half and is not fitted.

    With fewer than two velocities the exponent is 1, assumed, and its standard error infinite. Raises
    FitError if there is nothing to fit.
    """
    v, a = np.asarray(velocity_mm_s, dtype=np.float64), np.asarray(amplitude, dtype=np.float64)
    if v.size == 0 or v.shape != a.shape or np.any(v <= 0) or np.any(a <= 0):
        raise FitError(
            f"a scaling needs amplitudes above 0, one per velocity, got {a.tolist()} at {v.tolist()}"
        )
    energy = None if energy_mJ is None else np.asarray(energy_mJ, dtype=np.float64)
    if energy is not None and (energy.shape != v.shape or np.any(energy <= 0)):
        raise FitError(f"a scaling needs energies above 0, one per velocity, got {energy.tolist()}")
    mean = None if energy is None else float(np.exp(np.mean(np.log(energy))))
    x, y = np.log(v / REFERENCE_mm_s), np.log(a)
    if energy is not None and mean is not None:
        y = y - 0.5 * np.log(energy / mean)
    exponent, sd, log_sd = _slope(x, y)
    level = math.exp(float(np.mean(y - exponent * x)))
    return Scaling(level, exponent, sd, log_sd, mean, tuple(v.tolist()))


def _slope(x: FloatArray, y: FloatArray) -> tuple[float, float, float]:
    """Return the exponent, its standard error and the spread about the law."""
    across = float(np.sum((x - x.mean()) ** 2))
    if across < 1e-12:
        return USUAL_EXPONENT, math.inf, float(np.std(y))
    slope = float(np.sum((x - x.mean()) * (y - y.mean())) / across)
    left = y - y.mean() - slope * (x - x.mean())
    if x.size < 3:
        return slope, math.inf, 0.0
    spread = math.sqrt(float(left @ left) / (x.size - 2))
    return slope, spread / math.sqrt(across), spread
