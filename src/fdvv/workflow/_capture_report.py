"""The figures of a recorded model by name, as ``fdvv process --json`` prints them."""

from __future__ import annotations

from typing import Any

from fdvv.model import Stroke, landmark_errors, landmarks
from fdvv.preprocess import Processed
from fdvv.workflow._capture_model import RecordedModel
from fdvv.workflow._fit import fit_report
from fdvv.workflow._spread_report import curve_spread, spread_reports


def capture_report(recorded: RecordedModel) -> dict[str, Any]:
    """Give everything that a person or a program may ask of a recorded model, units in the names."""
    model = recorded.model
    pressed = bool(model.of(Stroke.PRESS))
    errors = landmark_errors(model) if pressed else {}
    return {
        "name": model.name,
        "simulated": model.provenance.simulated,
        "clock": {name: float(value) for name, value in vars(recorded.processed.clock).items()},
        "curves": [{**curve_spread(fit.curve), **fit_report(fit)} for fit in recorded.fits],
        "presses": press_reports(recorded.processed),
        "landmarks": landmarks(model).to_dict() if pressed else {"travel_mm": model.travel_mm},
        "landmark_errors": {name: vars(error) for name, error in errors.items()},
        "vibrations": {
            "heard": [one.report() for one in recorded.heard.heard],
            "in_model": spread_reports(model)["vibrations"],
            "scalings": [scaling.report() for scaling in recorded.heard.scalings],
        },
        "method": model.provenance.method,
        "assumptions": list(model.provenance.assumptions),
        "warnings": list(recorded.warnings),
    }


def press_reports(processed: Processed) -> list[dict[str, Any]]:
    """Tell of every press what was made of it; reason is null where it was used."""
    return [
        {
            "take": one.press.take,
            "part": one.press.part,
            "velocity_mm_s": one.press.velocity_mm_s,
            "achieved_mm_s": float(one.achieved_mm_s),
            "bottom_mm": float(one.spans.bottom_mm),
            "reason": str(one.reason) if one.reason else None,
        }
        for one in processed.judged
    ]
