"""How buttons differ: landmarks side by side, and force between their curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.landmarks import LandmarkError, Landmarks, landmark_errors, landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.spread import ModeSpread
from fdvv.model.vibration import Vibration

STEP_mm = 0.01  # a fifth of the 50 um over which a bump is averaged (decision 4)


@dataclass(frozen=True)
class Difference:
    """Force of one button less that of the reference, over the displacement that both have.

    Attributes
    ----------
    index, name, stroke : which curve is compared with the reference's; index counts the buttons from 0.
    rms_cN, mean_cN, max_cN : of the difference; max is its greatest absolute value, at max_mm.
    from_mm, to_mm : the common range, each button's contact at 0.
    """

    index: int
    name: str
    stroke: Stroke
    rms_cN: float
    mean_cN: float
    max_cN: float
    max_mm: float
    from_mm: float
    to_mm: float


@dataclass(frozen=True)
class Comparison:
    """Buttons side by side; the first is the reference of the differences.

    Attributes
    ----------
    names, landmarks : of each button.
    errors : standard errors of its landmarks, by name, where presses were measured.
    differences : of the others against the first.
    """

    names: tuple[str, ...]
    landmarks: tuple[Landmarks, ...]
    errors: tuple[dict[str, LandmarkError], ...]
    differences: tuple[Difference, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the report of ``fdvv compare --json``."""
        buttons = [
            {"name": name, **marks.to_dict(), "landmark_errors": {k: vars(e) for k, e in errors.items()}}
            for name, marks, errors in zip(self.names, self.landmarks, self.errors, strict=True)
        ]
        differences = [{**vars(d), "stroke": str(d.stroke)} for d in self.differences]
        return {"reference": self.names[0], "buttons": buttons, "differences": differences}


def compare(models: Sequence[FDVVModel], velocity_mm_s: float | None = None) -> Comparison:
    """Compare buttons at one velocity (the slowest of each by default).

    Raises ModelError if a button has no press curve.
    """
    reference = models[0]
    differences = [
        found
        for index, model in enumerate(models[1:], start=1)
        for stroke in Stroke
        if (found := _difference(reference, index, model, stroke, velocity_mm_s)) is not None
    ]
    names = tuple(model.name for model in models)
    marks = tuple(landmarks(m, velocity_mm_s) for m in models)
    errors = tuple(landmark_errors(m, velocity_mm_s) for m in models)
    return Comparison(names, marks, errors, tuple(differences))


def _difference(
    reference: FDVVModel, index: int, model: FDVVModel, stroke: Stroke, velocity_mm_s: float | None
) -> Difference | None:
    """Subtract the curves of one stroke over their common range; None if either button lacks it."""
    mine, theirs = reference.nearest(stroke, velocity_mm_s), model.nearest(stroke, velocity_mm_s)
    if mine is None or theirs is None:
        return None
    low, high = max(mine.start_mm, theirs.start_mm), min(mine.end_mm, theirs.end_mm)
    if high <= low:
        return None
    x = np.linspace(low, high, max(2, round((high - low) / STEP_mm) + 1))
    base, other = (
        m.force_cN(x, velocity_mm_s or c.velocity_mm_s or 1.0, stroke)
        for m, c in ((reference, mine), (model, theirs))
    )
    delta = other - base
    at = int(np.argmax(np.abs(delta)))
    return Difference(
        index=index,
        name=model.name,
        stroke=stroke,
        rms_cN=float(np.sqrt(np.mean(delta**2))),
        mean_cN=float(delta.mean()),
        max_cN=float(abs(delta[at])),
        max_mm=float(x[at]),
        from_mm=low,
        to_mm=high,
    )


def spread_reports(model: FDVVModel) -> dict[str, Any]:
    points = {name: getattr(model, f"{name}_spread") for name in ("travel", "actuation", "reset")}
    return {
        "curves": [curve_spread(curve) for curve in model.curves],
        "points": {name: vars(spread) for name, spread in points.items() if spread},
        "vibrations": [vibration_spread(v) for v in model.vibrations],
    }


def curve_spread(curve: ForceCurve) -> dict[str, Any]:
    """Return the figures of a curve's spread between presses; null where it was not measured."""
    spread = curve.spread
    return {
        "stroke": str(curve.stroke),
        "velocity_mm_s": curve.velocity_mm_s,
        **{key: getattr(spread, key, None) for key in ("achieved_mm_s", "achieved_spread_mm_s", "presses")},
        "median_spread_cN": float(np.median(spread.spread_cN)) if spread else None,
        "largest_spread_cN": float(spread.spread_cN.max()) if spread else None,
    }


def vibration_spread(vibration: Vibration) -> dict[str, Any]:
    """Return a vibration's principal mode and its spread between presses; null where not measured."""
    spread, first = vibration.spread, vibration.modes[0]
    mode = spread.modes[0] if spread and spread.modes else ModeSpread()
    return {
        "stroke": str(vibration.stroke),
        "velocity_mm_s": vibration.velocity_mm_s,
        "onset_mm": vibration.onset_mm,
        "onset_spread_mm": spread.onset_mm if spread else None,
        "duration_s": vibration.duration_s,
        "duration_spread_s": spread.duration_s if spread else None,
        "frequency_Hz": first.frequency_Hz,
        "frequency_spread_Hz": mode.frequency_Hz,
        "amplitude_m_s2": first.amplitude_m_s2,
        "amplitude_spread_m_s2": mode.amplitude_m_s2,
        "presses": spread.presses if spread else None,
    }
