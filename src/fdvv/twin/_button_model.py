"""From a model of a button to its physics: its slowest press and release are what is identified."""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import FDVVModel, Stroke
from fdvv.twin._button import ButtonPhysics, Curve
from fdvv.units import FloatArray, N_from_cN, m_from_mm

STEP_mm = 0.02


def button_of_model(model: FDVVModel, close_mm: float | None = None, seat_mm: float = 0.1) -> ButtonPhysics:
    """Make a leaf switch of a model; everything its curves do not say keeps its default.

    close_mm : where the circuit closes, the model's activation point if None.
    seat_mm : depth up to which the top stop shapes the curves.

    Raises ModelError if a stroke is missing, or no activation point is known.
    """
    close = model.actuation_mm if close_mm is None else close_mm
    if close is None:
        raise ModelError(f"{model.name}: the model has no activation point; say where the circuit closes")
    if not all(model.of(stroke) for stroke in Stroke):
        raise ModelError(f"{model.name}: a real button needs curves of press and release")
    press_cN, release_cN = (_slowest_cN(model, stroke) for stroke in Stroke)
    origin = model.provenance
    return ButtonPhysics(
        model.name,
        f"model {model.name}: {origin.source}. {origin.citation}",
        origin.licence,
        N_from_cN(press_cN),
        N_from_cN(np.maximum(release_cN, 0.0)),
        Curve(
            travel_m=_metres(model.travel_mm),
            close_m=_metres(close),
            open_m=_metres(close),
            seat_m=_metres(seat_mm),
        ),
    )


def _slowest_cN(model: FDVVModel, stroke: Stroke) -> FloatArray:
    curve = min(model.of(stroke), key=lambda c: c.velocity_mm_s or 0.0)
    count = int(np.floor(model.travel_mm / STEP_mm + 1e-9)) + 1
    return np.asarray(curve.force_cN(STEP_mm * np.arange(count)))


def _metres(length_mm: float) -> float:
    """Convert, without the last bits that would only clutter a file."""
    return round(m_from_mm(length_mm), 9)
