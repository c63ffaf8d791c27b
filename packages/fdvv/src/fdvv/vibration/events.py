"""Click, bottom-out and release in a recording of one keystroke, from its sound alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration.snap import NotFound

LOW_CUT_Hz = 300.0
"""Hum, handling and the room below this carry no burst of a key."""
SHORT_s, LONG_s = 0.0007, 0.004
"""A burst begins where the mean power of the first, ahead, exceeds that of the second, behind."""
RISE_ratio = 8.0
"""By so much, 9 dB: far more than two stretches of one noise differ, 30 and 180 samples at 44.1 kHz."""
QUIET_ratio = 1e-3
"""Bursts 30 dB below the loudest of the stroke are of the room or of a lossy codec."""
GROUP_s = 0.045
"""Contact, click and bottom-out of a stroke follow one another closer than this, a release comes later: typed
keys take 5 to 20 ms to go down and are held for 80 or more."""
BESIDE_ratio, CLICK_ratio = 10**-1.5, 10**-2.0
"""Click and bottom are heard beside each other: what ends a press is at most 15 dB below the loudest of it, a
click at most 20 dB below the bottom; a finger's contact is fainter."""
CLICK_LEAD_s = (0.003, 0.020)
"""How long before the bottom a click can be: half of 4 mm at 640 and at 100 mm/s, as typed keys and
calm presses go. Earlier is the finger's contact, later the bottom's own."""


@dataclass(frozen=True)
class Burst:
    """One sudden sound.

    Attributes
    ----------
    onset_s : where it begins. peak_power : highest mean power over 1 ms, in the signal's unit squared.
    """

    onset_s: float
    peak_power: float


@dataclass(frozen=True)
class KeyEvents:
    """Events in the recording of one keystroke.

    Attributes
    ----------
    click_s, bottom_s, release_s : onsets in seconds from the start of the recording, or why there is none.
    bursts : all of them, in order of time.
    """

    click_s: float | NotFound
    bottom_s: float | NotFound
    release_s: float | NotFound
    bursts: tuple[Burst, ...]


def key_events(sound: npt.ArrayLike, rate_Hz: float, release_alone: bool = False) -> KeyEvents:
    """Find click, bottom-out and release in the recording of one stroke.

    sound : (n,) a single stroke, with or without its release, in any unit.
    rate_Hz : at least 8000.
    release_alone : the recording holds no press; then its loudest burst is the release.

    The press is 45 ms from the first burst on that is within 15 dB of the loudest. The last such burst in
    them is the bottom. A burst 3 to 20 ms before it, no more than 20 dB below, is the click, the loudest if
    there are several. The release is the loudest burst later than 45 ms after the bottom. Raises ModelError
    for other rates or no samples.
    """
    signal = np.asarray(sound, dtype=np.float64)
    if signal.ndim != 1 or signal.size < 64 or not np.isfinite(signal).all():
        raise ModelError(f"a recording needs 64 or more finite samples of one channel, got {signal.shape}")
    if not rate_Hz >= 8000:
        raise ModelError(f"bursts need a rate of at least 8000 Hz, got {rate_Hz}")
    rises = bursts(signal, rate_Hz)
    if not rises:
        nothing = NotFound("no burst rises 9 dB above what is before it")
        return KeyEvents(nothing, nothing, nothing, ())
    loudest = max(burst.peak_power for burst in rises)
    if release_alone:
        nothing = NotFound("the recording holds a release alone")
        return KeyEvents(nothing, nothing, _release(rises), tuple(rises))
    strong = [burst for burst in rises if burst.peak_power >= BESIDE_ratio * loudest]
    group = [b for b in strong if b.onset_s - strong[0].onset_s <= GROUP_s]
    bottom = group[-1]
    earliest, latest = bottom.onset_s - CLICK_LEAD_s[1], bottom.onset_s - CLICK_LEAD_s[0]
    before = [b for b in rises if earliest <= b.onset_s <= latest]
    after = [b for b in rises if b.onset_s - bottom.onset_s > GROUP_s]
    return KeyEvents(_click(before, bottom), bottom.onset_s, _release(after), tuple(rises))


def _click(before: list[Burst], bottom: Burst) -> float | NotFound:
    if not before:
        low, high = (1e3 * lead for lead in CLICK_LEAD_s)
        return NotFound(f"nothing is heard {low:.0f} to {high:.0f} ms before the bottom")
    loudest = max(before, key=lambda burst: burst.peak_power)
    below_dB = 10 * math.log10(loudest.peak_power / bottom.peak_power)
    if loudest.peak_power < CLICK_ratio * bottom.peak_power:
        return NotFound(
            f"what is heard before the bottom is {-below_dB:.0f} dB fainter, a contact rather than a click"
        )
    return loudest.onset_s


def _release(after: list[Burst]) -> float | NotFound:
    if not after:
        return NotFound(f"nothing is heard later than {1e3 * GROUP_s:.0f} ms after the bottom")
    return max(after, key=lambda burst: burst.peak_power).onset_s


def bursts(signal: FloatArray, rate_Hz: float) -> list[Burst]:
    """Find sudden rises of power, in order of time; see RISE_ratio and QUIET_ratio."""
    from scipy.signal import butter, sosfiltfilt

    clean = sosfiltfilt(butter(2, LOW_CUT_Hz, "highpass", fs=rate_Hz, output="sos"), signal)
    power = np.asarray(clean**2)
    short, long = max(2, round(SHORT_s * rate_Hz)), max(8, round(LONG_s * rate_Hz))
    sums = np.append(0.0, np.cumsum(power))
    k = np.arange(power.size)
    ahead = (sums[np.minimum(k + short, power.size)] - sums[k]) / short
    behind = (sums[k] - sums[np.maximum(k - long, 0)]) / np.maximum(np.minimum(k, long), 1)
    floor = max(float(np.percentile(ahead, 10)), QUIET_ratio * float(ahead.max()), 1e-300)
    rising = (ahead > RISE_ratio * np.maximum(behind, floor / RISE_ratio)) & (ahead > floor)
    # a file that begins inside a sound has nothing before it
    rising[:short] = False
    edges = np.flatnonzero(np.diff(np.append(False, rising).astype(int)) == 1).tolist()
    rises: list[Burst] = []
    for edge, after in pairwise([*edges, power.size]):
        peak = float(ahead[edge : min(edge + long, after)].max())
        onset = _first_loud(power, edge, min(edge + 2 * short, power.size), peak) / rate_Hz
        since = onset - rises[-1].onset_s if rises else np.inf
        if since <= LONG_s and peak > RISE_ratio * rises[-1].peak_power:
            # what just leads up to a louder burst is part of it, or a lossy codec's echo ahead of it
            rises[-1] = Burst(onset, peak)
        elif since <= 2 * SHORT_s:
            rises[-1] = Burst(rises[-1].onset_s, max(peak, rises[-1].peak_power))
        else:
            rises.append(Burst(onset, peak))
    return rises


def _first_loud(power: FloatArray, start: int, end: int, peak: float) -> int:
    """Find the first sample, from where the rise is seen on, that has the power of the burst."""
    loud = power[start:end] >= 0.25 * peak
    return start + (int(np.argmax(loud)) if loud.any() else 0)
