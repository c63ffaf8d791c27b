"""What a finger could feel of a button, in units of just noticeable differences: the proxy's senses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import (
    LITERATURE,
    BEST_Hz,
    HEARD_s,
    THRESHOLD_um,
    vibration_threshold_um,
    weber_steps,
)
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray

BINS = 80
"""Places along the travel at which force is felt."""
PACES = 5
"""Speeds that represent all: the medians of fifths of the presses."""


@dataclass(frozen=True)
class Senses:
    """Constants of feeling, of nobody in particular; docs/explanation/simulated-participants.md sweeps them.

    Those of force and vibration are the literature's (fdvv.model.noticeable), whatever a project measured.

    Attributes
    ----------
    weber_ratio : of force. 0.07: 2.5 to 10 N at 25 to 160 mm/s (Pang, Tan and Durlach 1991).
    floor_cN : force added before the ratio is taken, so that 60 and 66 cN are discriminated: below a
        newton the ratio grows to 0.10 to 0.15. Assumed, within that range.
    threshold_um : faintest vibration at 250 Hz under a flat fingertip, amplitude; 0.1 to 0.3 are reported.
    best_Hz : where the threshold is lowest; twelve dB per octave away from it (Verrillo 1963).
    vibration_ratio : just noticeable part of an amplitude well above threshold, 1 to 2 dB.
    pace_mm_s, pace_spread_ratio : middle speed of presses, and its spread, of the logarithm. Assumed: paces
        of 50 to 150 mm/s are what people were seen to choose.
    speed_weight : of how force changes with speed, beside how it is on average; 1: felt as well as that.
    release_weight : of the release beside the press.
    pooling : exponent by which places add up; 2: root of the mean square, large: the largest alone.
    """

    weber_ratio: float = LITERATURE.force_ratio
    floor_cN: float = LITERATURE.force_floor_cN
    threshold_um: float = THRESHOLD_um
    best_Hz: float = BEST_Hz
    vibration_ratio: float = LITERATURE.vibration_ratio
    pace_mm_s: float = 80.0
    pace_spread_ratio: float = 0.45
    speed_weight: float = 1.0
    release_weight: float = 1.0
    pooling: float = 2.0

    def __post_init__(self) -> None:
        weights = (self.speed_weight, self.release_weight, self.pace_spread_ratio)
        sizes = (self.weber_ratio, self.floor_cN, self.threshold_um, self.best_Hz, self.vibration_ratio)
        fine = all(0 <= one < math.inf for one in weights) and self.pooling >= 1
        if not fine or not all(0 < one < math.inf for one in (*sizes, self.pace_mm_s)):
            raise ModelError(f"no finger feels like that: {self}")

    @property
    def paces_mm_s(self) -> FloatArray:
        """The speeds at which a button is felt, (PACES,), rising."""
        middles = [NormalDist().inv_cdf((one + 0.5) / PACES) for one in range(PACES)]
        return np.asarray(self.pace_mm_s * np.exp(self.pace_spread_ratio * np.asarray(middles)))

    def vibration_steps(self, above: FloatArray) -> FloatArray:
        """Return the JNDs from nothing to vibrations, about one at threshold; above : times the faintest."""
        return weber_steps(above, self.vibration_ratio, 1 / self.vibration_ratio)


@dataclass(frozen=True, eq=False)
class HapticFeatures:
    """A button as the senses have it.

    Attributes
    ----------
    force_JND : (strokes, paces, BINS) steps of just noticeable force above none, press then release.
    vibration : (strokes,) amplitude above the faintest that is felt, 1 at threshold, 0 without vibration.
    """

    force_JND: FloatArray
    vibration: FloatArray


@dataclass(frozen=True)
class PerceivedDifference:
    """How far two buttons are apart for the middle person, in just noticeable differences.

    Attributes
    ----------
    force_JND : of force on average over speeds. speed_JND : of how force changes with speed.
    vibration : amplitudes of both above threshold, by stroke: ((press, press), (release, release)).
    vibration_JND : between these.
    """

    force_JND: float
    speed_JND: float
    vibration: tuple[tuple[float, float], ...]
    vibration_JND: float

    @property
    def total_JND(self) -> float:
        """The whole difference: the parts are taken to add up by their squares."""
        return math.sqrt(self.force_JND**2 + self.speed_JND**2 + self.vibration_JND**2)


def haptic_features(
    model: FDVVModel, senses: Senses | None = None, force_ratio: float = 1.0
) -> HapticFeatures:
    """Return what could be felt of a model that is rendered ideally, all its forces multiplied by a ratio.

    A force F becomes ln(1 + F / floor) / ratio: steps of the generalised Weber law dF = ratio (F + floor).
    The place is the part of the travel. A stroke that the model lacks is replaced by the other one.
    """
    senses = senses or Senses()
    place_mm = (np.arange(BINS) + 0.5) / BINS * model.travel_mm
    opposite = {Stroke.PRESS: Stroke.RELEASE, Stroke.RELEASE: Stroke.PRESS}
    served = [stroke if model.of(stroke) else opposite[stroke] for stroke in Stroke]
    rows = [model.force_cN(place_mm[None, :], senses.paces_mm_s[:, None], stroke) for stroke in served]
    force_cN = force_ratio * np.clip(np.stack(rows), 0.0, None)
    vibrations = [model.vibration(stroke, senses.pace_mm_s) for stroke in Stroke]
    above = np.asarray([vibration_above_threshold(one, senses) for one in vibrations])
    return HapticFeatures(weber_steps(force_cN, senses.weber_ratio, senses.floor_cN), above)


def perceived_difference(
    first: HapticFeatures, second: HapticFeatures, senses: Senses | None = None
) -> PerceivedDifference:
    """Return how far two buttons are apart, place by place along their travels."""
    senses = senses or Senses()
    apart = first.force_JND - second.force_JND  # (strokes, paces, BINS)
    mean = apart.mean(axis=1)
    changing = np.sqrt(np.mean((apart - mean[:, None, :]) ** 2, axis=1))
    pairs = tuple(zip(first.vibration.tolist(), second.vibration.tolist(), strict=True))
    steps = np.subtract(*(senses.vibration_steps(one.vibration) for one in (first, second)))
    return PerceivedDifference(
        _pooled(mean, senses),
        senses.speed_weight * _pooled(changing, senses),
        pairs,
        _both_strokes(np.abs(steps), senses),
    )


def vibration_above_threshold(vibration: Vibration | None, senses: Senses) -> float:
    """Return the amplitude of a vibration above the faintest of its frequencies, 0 for none.

    The displacement of each mode is divided by the threshold at its frequency; energy adds up over 0.2 s.
    """
    if vibration is None:
        return 0.0
    energy = 0.0
    for mode in vibration.modes:
        amplitude_um = 1e6 * mode.amplitude_m_s2 / (2 * math.pi * mode.frequency_Hz) ** 2
        least_um = vibration_threshold_um(mode.frequency_Hz, senses.threshold_um, senses.best_Hz)
        above = amplitude_um / float(least_um)
        energy += above**2 * _lasting_s(mode.decay_1_s, vibration.duration_s) / HEARD_s
    return math.sqrt(energy)


def _lasting_s(decay_1_s: float, duration_s: float) -> float:
    if decay_1_s == 0.0:
        return duration_s
    return -math.expm1(-2 * decay_1_s * duration_s) / (2 * decay_1_s)


def _pooled(apart: FloatArray, senses: Senses) -> float:
    """Pool differences, (strokes, BINS), over places and then both strokes."""
    largest = np.abs(apart).max(axis=1, keepdims=True)
    scaled = np.divide(np.abs(apart), largest, out=np.zeros_like(apart), where=largest > 0)
    by_stroke = largest[:, 0] * np.mean(scaled**senses.pooling, axis=1) ** (1 / senses.pooling)
    return _both_strokes(by_stroke, senses)


def _both_strokes(by_stroke: FloatArray, senses: Senses) -> float:
    weights = np.asarray([1.0, senses.release_weight])
    return float(np.sqrt(np.average(by_stroke**2, weights=weights)))
