"""What a table of curves is once it is imported again, against the model it was written from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from fdvv.button.fit import ModelFit, fit_file
from fdvv.errors import FdvvError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray

SAMPLES = 401  # every 10 um of 4 mm, as fdvv.button.compare


def curve_losses(
    model: FDVVModel, written: Exported, suffix: str, velocity_mm_s: float | None = None
) -> dict[str, float | None]:
    """Import a written table as ``fdvv import`` would, and return by how much the model differs.

    velocity_mm_s : of the curves in a format that holds one press and its release.

    ``imported_curves`` is how many come back, ``imported_rms_cN`` and ``imported_max_cN`` the difference of
    force of the worst of them over what the fit keeps of it, ``imported_travel_mm``,
    ``imported_actuation_mm`` and ``imported_reset_mm`` what is added to these; None where there is nothing to
    compare. An import moves displacement 0 to the contact it finds; forces are compared in place.
    """
    found = _imported(written, suffix)
    if found is None:
        return {"imported_curves": 0.0}
    off = [np.abs(difference) for difference in _differences(model, found, velocity_mm_s)]
    return {
        "imported_curves": float(len(found.model.curves)),
        "imported_rms_cN": max((float(np.sqrt(np.mean(d**2))) for d in off), default=None),
        "imported_max_cN": max((float(d.max()) for d in off), default=None),
        **{
            f"imported_{name}": _added(getattr(found.model, name), getattr(model, name), zero_mm)
            for name, zero_mm in (
                ("travel_mm", 0.0),
                ("actuation_mm", found.zero_mm),
                ("reset_mm", found.zero_mm),
            )
        },
    }


def _imported(written: Exported, suffix: str) -> ModelFit | None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"written{suffix}"
        written.save(path)
        try:
            return fit_file(path)
        except FdvvError:
            return None


def _differences(model: FDVVModel, found: ModelFit, velocity_mm_s: float | None) -> Iterator[FloatArray]:
    for stroke in Stroke:
        curves = found.model.of(stroke)
        for number, curve in enumerate(curves):
            of = _original(model, curve, number, len(curves), velocity_mm_s)
            if of is not None:
                x = np.linspace(curve.start_mm, curve.end_mm, SAMPLES)
                yield curve.force_cN(x) - of.force_cN(x + found.zero_mm)


def _original(
    model: FDVVModel, curve: ForceCurve, number: int, count: int, velocity_mm_s: float | None
) -> ForceCurve | None:
    """Return the curve that one was written from: by its velocity, by its number, or the one asked for."""
    written = model.of(curve.stroke)
    if curve.velocity_mm_s is None and count == len(written):
        return written[number]
    return model.nearest(curve.stroke, velocity_mm_s if curve.velocity_mm_s is None else curve.velocity_mm_s)


def _added(after: float | None, before: float | None, zero_mm: float) -> float | None:
    return None if after is None or before is None else after + zero_mm - before
