"""Synthetic vibrations of a snap whose modes are known."""

from __future__ import annotations

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.vibration.pool import SnapEnergy
from fdvv.vibration.snap import HeardPress

STARTS_s, LASTS_s, TRAVEL_mm = 0.03, 0.08, 4.0
NOISE, RATE_Hz = 0.03, 10_000.0

ENERGY = SnapEnergy(drop_cN=20.0, energy_mJ=0.1, peak_mm=1.4, valley_mm=2.0)


SNAP_mm, DECAY_1_s, FREQUENCY_Hz = 2.15, 150.0, 239.0


def made_press(seed: int, amplitude: float = 1.0, stroke: Stroke = Stroke.PRESS) -> tuple[HeardPress, float]:
    """Make an acceleration: the cap's smooth way, a ring from SNAP_mm on, a loud stop; and the onset."""
    random = np.random.default_rng(seed)
    t = np.asarray((np.arange(round(0.2 * RATE_Hz)) + random.uniform()) / RATE_Hz, dtype=np.float64)
    u = np.clip((t - STARTS_s) / LASTS_s, 0, 1)
    gone_mm = TRAVEL_mm * (10 * u**3 - 15 * u**4 + 6 * u**5)
    place_mm = gone_mm if stroke is Stroke.PRESS else TRAVEL_mm - gone_mm
    at_mm = SNAP_mm if stroke is Stroke.PRESS else TRAVEL_mm - SNAP_mm
    onset_s = float(np.interp(at_mm, gone_mm, t))
    signal = 0.5 * np.sin(2 * np.pi * 8 * t) + NOISE * random.standard_normal(t.size)
    for start_s, size, f, d in (
        (onset_s, amplitude, FREQUENCY_Hz, DECAY_1_s),
        (STARTS_s + LASTS_s, 50.0, 600.0, 300.0),
    ):
        after = np.maximum(t - start_s, 0.0)
        signal += size * np.exp(-d * after) * np.sin(2 * np.pi * f * after)
    if stroke is Stroke.RELEASE:
        # a press before it, so that the turn is known
        place_mm = np.where(t < STARTS_s / 2, TRAVEL_mm * t / (STARTS_s / 2), place_mm)
    return HeardPress(t, signal, t, np.asarray(place_mm), stroke, NOISE), onset_s
