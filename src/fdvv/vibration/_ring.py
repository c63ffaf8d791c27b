"""How the snap rings on: modes that several presses share, or why they cannot be told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError
from fdvv.units import FloatArray
from fdvv.vibration._damped import DampedFit, DampedMode, duration_s, fit_damped, polynomial, shapes
from fdvv.vibration._modes import pencil_poles
from fdvv.vibration._snap import HeardPress, NotFound, Snap

LONGEST_s = 0.025
"""A snap is over by then (the paper: below 25 ms)."""

MOST_MODES = 4
BACKGROUND_DEGREE = 2
"""The cap's own motion after the snap, a polynomial of each press."""

DELAYS_s = (0.0, 0.001, 0.002, 0.003, 0.004, 0.006)
"""A ring is free once its drive is over: of these delays after the onset the shortest that fits is kept."""

FITS_ratio = 1.2
"""What a free ring leaves is noise, up to this."""

DRIVEN_ratio = 3.0
"""Where the best fit leaves more than this many times the noise, something keeps driving: no ring is free."""

SURE_ratio = 0.1
"""Standard error of the frequency above which it is not known."""

FEWEST_PER_PERIOD = 8.0
"""Samples per period of 250 Hz from which the pencil can start; below it a grid of frequencies does."""

GRID_Hz, GRID_1_s = np.arange(60.0, 460.0, 20.0), (60.0, 150.0, 350.0)


@dataclass(frozen=True, eq=False)
class Ring:
    """The ring of a snap, shared by the presses it was found in; in the unit of the signal.

    Attributes
    ----------
    mode : the principal one, with the most kinetic energy once the ring is free.
    modes : all of them, the principal one first.
    amplitudes : (presses,) of the principal mode at the onset.
    delay_s : after the onset from which the ring was free and was fitted.
    noise_ratio : what the fit leaves over the noise of the sensor; well above 1 the drive goes on.
    """

    mode: DampedMode
    modes: tuple[DampedMode, ...]
    amplitudes: FloatArray
    delay_s: float
    noise_ratio: float

    @property
    def duration_sd_s(self) -> float:
        """Standard error of the duration, from that of the decay."""
        return duration_s(self.mode.decay_1_s) * self.mode.decay_sd_1_s / self.mode.decay_1_s


def fit_ring(presses: Sequence[HeardPress], snaps: Sequence[Snap], acceleration: bool) -> Ring | NotFound:
    """Fit the modes that ring after the snaps of presses of one velocity and stroke.

    presses, snaps : alike in number. Each ring has an amplitude and a phase of its own, for onsets are not
        known to a small part of a period; so frequencies are taken to lie below half the rate.
    acceleration : the signal is an acceleration, not a velocity (as a microphone's near a cap).

    The number of modes has the smallest BIC, down to none. Principal is the mode with the most kinetic energy
    once the ring is free, the integral of its squared velocity.
    """
    found = _best(presses, snaps)
    if found is None:
        return NotFound("the stop follows too soon: the snap leaves too few samples to fit")
    delay, fit, ratio = found
    if not fit.modes:
        return NotFound(f"nothing rings above a noise of {fit.noise:.2g} per sample in {len(snaps)} presses")
    if ratio > DRIVEN_ratio:
        return NotFound(
            f"no free ring: what modes leave is {ratio:.0f} times the noise, something keeps driving"
        )
    order = _order(fit, delay, acceleration)
    modes = tuple(fit.modes[k] for k in order)
    first = modes[0]
    if first.frequency_sd_Hz > SURE_ratio * first.frequency_Hz:
        return NotFound(
            f"the ring is too weak in its noise: {first.frequency_Hz:.0f} Hz with a standard error of "
            f"{first.frequency_sd_Hz:.0f} Hz in {len(snaps)} presses"
        )
    if first.decay_sd_1_s > 0.5 * first.decay_1_s:
        return NotFound(
            f"{first.frequency_Hz:.0f} Hz is heard but its end is not: decay {first.decay_1_s:.0f} 1/s with "
            f"a standard error of {first.decay_sd_1_s:.0f}"
        )
    return Ring(first, modes, fit.amplitudes[:, order[0]], delay, ratio)


def _best(presses: Sequence[HeardPress], snaps: Sequence[Snap]) -> tuple[float, DampedFit, float] | None:
    """Give delay, fit and its noise ratio: of the shortest delay that leaves noise, or of the least left."""
    least = None
    for delay in DELAYS_s:
        found = _fit_after(presses, snaps, delay)
        if found is not None and (least is None or found[2] < least[2]):
            least = found
        if least is not None and least[2] <= FITS_ratio:
            break
    return least


def _order(fit: DampedFit, delay_s: float, acceleration: bool) -> list[int]:
    energies = [-_energy(mode, delay_s, acceleration) for mode in fit.modes]
    return [int(k) for k in np.argsort(energies)]


def _energy(mode: DampedMode, delay_s: float, acceleration: bool) -> float:
    """Give the integral of a mode's squared velocity from the delay on, but for a factor."""
    velocity = mode.amplitude / (mode.frequency_Hz if acceleration else 1.0)
    return velocity**2 * float(np.exp(-2 * mode.decay_1_s * delay_s)) / max(mode.decay_1_s, 1 / LONGEST_s)


def _fit_after(
    presses: Sequence[HeardPress], snaps: Sequence[Snap], delay_s: float
) -> tuple[float, DampedFit, float] | None:
    """Fit from a delay after the onsets on; give delay, fit and its noise over the sensor's."""
    times, signals, noises = [], [], []
    for press, snap in zip(presses, snaps, strict=True):
        low, high = np.searchsorted(
            press.t_s, [snap.onset_s + delay_s, min(snap.stop_s, snap.onset_s + LONGEST_s)]
        )
        if high - low > BACKGROUND_DEGREE + 4:
            times.append(press.t_s[low:high] - snap.onset_s)
            signals.append(press.signal[low:high])
            noises.append(press.noise_or_own())
    if not times:
        return None
    fits = [_background(times, signals)]
    for count in range(1, MOST_MODES + 1):
        try:
            start = _starts(times, signals, count, presses[0].period_s)
            fits.append(fit_damped(times, signals, *start, degree=BACKGROUND_DEGREE))
        except (FitError, np.linalg.LinAlgError):
            break
    # less than a period is motion of the cap, not a ring
    lowest_Hz = 1 / max(float(t[-1] - t[0]) for t in times)
    ringing = [fit for fit in fits if all(mode.frequency_Hz > lowest_Hz for mode in fit.modes)]
    best = min(ringing, key=lambda fit: fit.bic)
    return delay_s, best, best.noise / float(np.sqrt(np.mean(np.square(noises))))


def _background(times: list[FloatArray], signals: list[FloatArray]) -> DampedFit:
    """Fit without any mode."""
    left = [
        y - np.polyval(np.polyfit(t, y, BACKGROUND_DEGREE), t) for t, y in zip(times, signals, strict=True)
    ]
    total, samples = float(sum(r @ r for r in left)), sum(r.size for r in left)
    needed = len(times) * (BACKGROUND_DEGREE + 1)
    bic = samples * np.log(max(total / samples, 1e-300)) + needed * np.log(samples)
    noise = float(np.sqrt(total / max(samples - needed, 1)))
    return DampedFit((), np.empty((len(times), 0)), noise, samples, float(bic))


def _starts(
    times: list[FloatArray], signals: list[FloatArray], count: int, period_s: float
) -> tuple[list[float], list[float]]:
    """Guess frequencies and decays: from the pencil where samples are dense, else from a grid."""
    if 1 / period_s < FEWEST_PER_PERIOD * 250.0:
        return _from_grid(times, signals, count)
    length = min(t.size for t in times)
    rows = np.array([y[:length] - y[:length].mean() for y in signals])
    poles = pencil_poles(rows, min(2 * count + BACKGROUND_DEGREE, length // 3))
    logs = np.log(poles[poles.imag > 1e-6]) / period_s
    logs = logs[np.argsort(-logs.real)][:count]
    if logs.size < count:
        raise FitError(f"the records hold fewer than {count} rings")
    return list(logs.imag / (2 * np.pi)), list(np.maximum(-logs.real, 10.0))


def _from_grid(
    times: list[FloatArray], signals: list[FloatArray], count: int
) -> tuple[list[float], list[float]]:
    if count > 1:
        raise FitError("samples this sparse are searched for one ring only")
    best, power = (0.0, 0.0), np.inf
    for f in GRID_Hz:
        for d in GRID_1_s:
            left = _left(times, signals, float(f), d)
            if left < power:
                best, power = (float(f), d), left
    return [best[0]], [best[1]]


def _left(times: list[FloatArray], signals: list[FloatArray], frequency_Hz: float, decay_1_s: float) -> float:
    """Give the power that one mode and the background leave."""
    total = 0.0
    for t, y in zip(times, signals, strict=True):
        matrix = np.hstack(
            [shapes(t, np.array([frequency_Hz]), np.array([decay_1_s])), polynomial(t, BACKGROUND_DEGREE)]
        )
        left = y - matrix @ np.linalg.lstsq(matrix, y, rcond=None)[0]
        total += float(left @ left)
    return total
