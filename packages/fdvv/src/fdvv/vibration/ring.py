"""Ringing after the snap: modes that several presses share, or why they cannot be identified."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError
from fdvv.units import FloatArray
from fdvv.vibration.damped import DampedFit, DampedMode, duration_s
from fdvv.vibration.modes import BACKGROUND_DEGREE, MOST_DRIVES, drives, most_likely, overlaps
from fdvv.vibration.snap import HeardPress, NotFound, Snap

LONGEST_s = 0.025
"""A snap is over by then (the paper: below 25 ms)."""
DELAYS_s = (0.0, 0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.008)
"""A ring is free once its drive is over: of these delays after the onset the shortest that fits is kept."""
FITS_ratio = 1.1
"""What a free ring leaves is noise, up to this. Above it something keeps driving."""
SURE_ratio = 0.1
"""Standard error of the frequency above which it is not known."""
ENDING_ratio = 0.5
"""Standard error of the decay above which the end of a mode is not known."""
BACK_ratio = 3.0
"""An amplitude at the onset is at most this many times what was seen when the ring was free."""


@dataclass(frozen=True, eq=False)
class Ring:
    """The ring of a snap, shared by the presses it was found in; in the unit of the signal.

    Attributes
    ----------
    mode : the principal one, with the most kinetic energy once the ring is free.
    modes : all that are known at the onset, the principal one first.
    heard : these, and modes that sharpen a search but go into no model: they had faded too far by the time
        the ring was free, or are halves of a pair.
    amplitudes : (presses, modes) at the onset.
    delay_s : after the onset from which the ring was free and was fitted.
    noise_ratio : what the fit leaves over the noise of the sensor; well above 1 the drive goes on.
    """

    mode: DampedMode
    modes: tuple[DampedMode, ...]
    heard: tuple[DampedMode, ...]
    amplitudes: FloatArray
    delay_s: float
    noise_ratio: float

    @property
    def duration_s(self) -> float:
        """Time in which the principal mode's envelope falls to a tenth, at most the longest of a snap."""
        return min(duration_s(self.mode.decay_1_s), LONGEST_s)

    @property
    def duration_sd_s(self) -> float:
        """Standard error of the duration, from that of the decay."""
        return self.duration_s * self.mode.decay_sd_1_s / self.mode.decay_1_s


def fit_ring(presses: Sequence[HeardPress], snaps: Sequence[Snap], acceleration: bool) -> Ring | NotFound:
    """Fit the modes that ring after the snaps of presses of one velocity and stroke.

    presses, snaps : alike in number. Each ring has an amplitude and a phase of its own, for onsets are not
        known to a small part of a period; so frequencies are taken to lie below half the rate.
    acceleration : the signal is an acceleration, not a velocity (as a microphone's near a cap).

    The number of modes has the smallest BIC, down to none. Principal is the mode with the most kinetic energy
    once the ring is free, the integral of its squared velocity.
    """
    best = _best(presses, snaps)
    if best is None:
        return NotFound("the stop follows too soon: the snap leaves too few samples to fit")
    delay_s, fit, ratio = best
    if not fit.modes and ratio <= FITS_ratio:
        return NotFound(f"nothing rings above a noise of {fit.noise:.2g} per sample in {len(snaps)} presses")
    if ratio > FITS_ratio:
        return NotFound(
            f"no free ring: what modes leave is {ratio:.1f} times the noise, something keeps driving"
        )
    energies = [-_energy(mode, delay_s, acceleration) for mode in fit.modes]
    order = [int(k) for k in np.argsort(energies) if not drives(fit.modes[k])]
    if not order:
        return NotFound(f"nothing rings freely, only a drive fades in {len(snaps)} presses")
    reason = _explain_doubt(fit.modes[order[0]], delay_s)
    return NotFound(f"{reason} in {len(snaps)} presses") if reason else _ring(fit, order, delay_s, ratio)


def refit_ring(
    presses: Sequence[HeardPress], snaps: Sequence[Snap], known: tuple[float, float]
) -> Ring | None:
    """Fit a ring again with known frequency and decay of its principal mode, as early as it fits.

    Without any drive beside it if that ever leaves noise alone: a drive takes as much of the amplitude as it
    likes. None where neither does before too little of the ring is left.
    """
    for most_drives in (0, MOST_DRIVES):
        for delay in (delay for delay in DELAYS_s if known[1] * delay <= np.log(BACK_ratio)):
            times, signals, noise = _after(presses, snaps, delay)
            try:
                fit = most_likely(times, signals, presses[0].period_s, known, most_drives) if times else None
            except FitError:
                fit = None
            if fit is not None and fit.noise <= FITS_ratio * noise:
                first = next(k for k, mode in enumerate(fit.modes) if mode.frequency_Hz == known[0])
                order = [first, *(k for k in range(len(fit.modes)) if k != first)]
                return _ring(fit, order, delay, fit.noise / noise)
    return None


def _ring(fit: DampedFit, order: list[int], delay_s: float, ratio: float) -> Ring:
    """Return the ring of a fit, the principal mode first; drives and halves of pairs are none of it."""
    first, *side = order
    certain = [k for k in side if not drives(fit.modes[k]) and _explain_doubt(fit.modes[k], 0.0) is None]
    single = [k for k in certain if not overlaps(fit.modes[k], fit.modes)]
    kept = [first, *(k for k in single if _explain_doubt(fit.modes[k], delay_s) is None)]
    modes, heard = (tuple(fit.modes[k] for k in which) for which in (kept, [first, *certain]))
    return Ring(modes[0], modes, heard, fit.amplitudes[:, kept], delay_s, ratio)


def _explain_doubt(mode: DampedMode, delay_s: float) -> str | None:
    """Return why a mode is too uncertain to report; None if it is not."""
    if mode.frequency_sd_Hz > SURE_ratio * mode.frequency_Hz:
        return (
            f"the ring is too weak in its noise: {mode.frequency_Hz:.0f} Hz with a standard error of "
            f"{mode.frequency_sd_Hz:.0f} Hz"
        )
    if mode.decay_sd_1_s > ENDING_ratio * mode.decay_1_s:
        return (
            f"{mode.frequency_Hz:.0f} Hz is heard but its end is not: decay {mode.decay_1_s:.0f} 1/s with a "
            f"standard error of {mode.decay_sd_1_s:.0f}"
        )
    if mode.decay_1_s * delay_s > np.log(BACK_ratio):
        return (
            f"{mode.frequency_Hz:.0f} Hz is free only {1e3 * delay_s:.0f} ms after the onset, when less than "
            f"1/{BACK_ratio:g} of it is left"
        )
    return None


def _best(presses: Sequence[HeardPress], snaps: Sequence[Snap]) -> tuple[float, DampedFit, float] | None:
    """Return delay, fit and noise ratio of the shortest delay that leaves only noise, or of the best."""
    least = None
    for delay_s in DELAYS_s:
        times, signals, noise = _after(presses, snaps, delay_s)
        if times:
            fit = most_likely(times, signals, presses[0].period_s)
            if least is None or fit.noise / noise < least[2]:
                least = delay_s, fit, fit.noise / noise
        if least is not None and least[2] <= FITS_ratio:
            break
    return least


def _energy(mode: DampedMode, delay_s: float, acceleration: bool) -> float:
    """Return the integral of a mode's squared velocity from the delay on, but for a factor."""
    velocity = mode.amplitude / (mode.frequency_Hz if acceleration else 1.0)
    return velocity**2 * float(np.exp(-2 * mode.decay_1_s * delay_s)) / max(mode.decay_1_s, 1 / LONGEST_s)


def _after(
    presses: Sequence[HeardPress], snaps: Sequence[Snap], delay_s: float
) -> tuple[list[FloatArray], list[FloatArray], float]:
    """Cut out what is free from a delay after the onsets on: times after the onset, signals, noise."""
    times, signals, noises = [], [], []
    for press, snap in zip(presses, snaps, strict=True):
        ends_s = snap.onset_s + delay_s, min(snap.stop_s, snap.onset_s + LONGEST_s)
        low, high = np.searchsorted(press.t_s, ends_s)
        if high - low > BACKGROUND_DEGREE + 4:
            times.append(press.t_s[low:high] - snap.onset_s)
            signals.append(press.signal[low:high])
            noises.append(press.noise_rms)
    return times, signals, float(np.sqrt(np.mean(np.square(noises)))) if noises else 0.0
