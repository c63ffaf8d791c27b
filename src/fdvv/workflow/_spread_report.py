"""The spreads of a model by name, as commands report them."""

from __future__ import annotations

from typing import Any

import numpy as np

from fdvv.model import FDVVModel, ForceCurve, ModeSpread, Vibration


def spread_reports(model: FDVVModel) -> dict[str, Any]:
    """Give what a model keeps of its presses: of its curves, its points and its vibrations."""
    points = {name: getattr(model, f"{name}_spread") for name in ("travel", "actuation", "reset")}
    return {
        "curves": [curve_spread(curve) for curve in model.curves],
        "points": {name: vars(spread) for name, spread in points.items() if spread},
        "vibrations": [vibration_spread(v) for v in model.vibrations],
    }


def curve_spread(curve: ForceCurve) -> dict[str, Any]:
    """Give the figures of how the presses behind a curve differ; null where it was not measured so."""
    spread = curve.spread
    return {
        "stroke": str(curve.stroke),
        "velocity_mm_s": curve.velocity_mm_s,
        "achieved_mm_s": spread.achieved_mm_s if spread else None,
        "achieved_spread_mm_s": spread.achieved_spread_mm_s if spread else None,
        "presses": spread.presses if spread else None,
        "median_spread_cN": float(np.median(spread.spread_cN)) if spread else None,
        "largest_spread_cN": float(spread.spread_cN.max()) if spread else None,
    }


def vibration_spread(vibration: Vibration) -> dict[str, Any]:
    """Give a vibration by its principal mode, with how presses differ; null where that was not measured."""
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
