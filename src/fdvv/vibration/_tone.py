"""The amplitude of a steady tone in what a slow sensor told of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError
from fdvv.units import FloatArray

DRIFT = 3
"""The rest is a parabola: the cap creeps a little while it hums."""
LEAST = 20
"""Samples beyond what the fit takes, without which nothing can be said of its error."""


@dataclass(frozen=True)
class Tone:
    """How strongly a sensor answered to one frequency.

    Attributes
    ----------
    frequency_Hz : that was played; it may lie above half the sensor's rate.
    amplitude : of the sine that fits best, in the sensor's unit.
    error : standard error of each of its two parts.
    """

    frequency_Hz: float
    amplitude: float
    error: float


def measure_tone(t_s: FloatArray, samples: FloatArray, frequency_Hz: float) -> Tone:
    """Fit a sine of known frequency and a slow drift by least squares.

    t_s, samples : (n,) in any steps. The frequency need not lie below half the rate: it is known, so its
    alias tells its size, if nothing else sounds there. Raises FitError on too few samples, or at a frequency
    that the sampling cannot tell from the drift, a multiple of the rate, or from one phase, of half of it.
    """
    free = t_s.size - 2 - DRIFT
    if free < LEAST:
        raise FitError(f"a tone needs {LEAST + 2 + DRIFT} samples, got {t_s.size}")
    turns = 2 * np.pi * frequency_Hz * t_s
    middle = (t_s - t_s.mean()) / np.ptp(t_s)
    columns = np.column_stack([np.cos(turns), np.sin(turns), *(middle**n for n in range(DRIFT))])
    solved, _, _, sizes = np.linalg.lstsq(columns, samples)
    if sizes[-1] < 0.02 * sizes[0]:
        raise FitError(f"{frequency_Hz:g} Hz cannot be told at this rate; play another frequency")
    rest = samples - columns @ solved
    error = float(np.sqrt(np.sum(rest**2) / free * 2 / t_s.size))
    return Tone(frequency_Hz, float(np.hypot(solved[0], solved[1])), error)


def clock_ratio(
    records: Sequence[tuple[FloatArray, FloatArray]], frequency_Hz: Sequence[float], most: float = 0.01
) -> float:
    """Give how much faster than nominal the tones sound: the player's clock over the sensor's.

    records : times (s) and samples of each tone. A ceramic resonator is off by half a percent, enough to lose
    a tone of seconds. The ratio within 1 ± most at which all tones together are strongest, to an eighth of a
    turn over the longest.
    """
    pairs = list(zip(records, frequency_Hz, strict=True))
    turns = max(float(np.ptp(t)) * f for (t, _), f in pairs)
    count = int(np.ceil(8 * turns * most))
    ratios = 1 + most * np.arange(-count, count + 1) / max(count, 1)
    power = np.zeros(ratios.size)
    for (t_s, samples), f in pairs:
        middle = (t_s - t_s.mean()) / np.ptp(t_s)
        drift = np.polynomial.polynomial.polyfit(middle, samples, DRIFT - 1)
        rest = samples - np.polynomial.polynomial.polyval(middle, drift)
        power += [abs(np.sum(rest * np.exp(-2j * np.pi * f * ratio * t_s))) ** 2 for ratio in ratios]
    return float(ratios[np.argmax(power)])


def clear_frequencies_Hz(wanted_Hz: FloatArray, rate_Hz: float, apart_Hz: float) -> FloatArray:
    """Give those of wanted_Hz whose alias at rate_Hz lies apart_Hz or more from 0 and from half the rate.

    Near 0 the rig's own loop follows the alias and adds to it; near half the rate one phase alone is seen.
    """
    alias_Hz = np.abs(wanted_Hz - rate_Hz * np.round(wanted_Hz / rate_Hz))
    return wanted_Hz[(alias_Hz >= apart_Hz) & (np.abs(alias_Hz - rate_Hz / 2) >= apart_Hz / 5)]
