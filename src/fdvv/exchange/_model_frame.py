"""A model as a labelled array: force over stroke, velocity and displacement."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.exchange._frames import require_frames
from fdvv.model import FDVVModel, Stroke

if TYPE_CHECKING:
    import xarray as xr

STEP_mm = 0.01


def model_to_xarray(
    model: FDVVModel, velocities_mm_s: Sequence[float] | None = None, step_mm: float = STEP_mm
) -> xr.Dataset:
    """Give a model as a dataset: ``force`` and ``stiffness`` over stroke, velocity and displacement.

    velocities_mm_s : by default those the model has curves at; a model of unknown velocity has the one
    coordinate NaN.
    Displacement goes in steps from 0 to the travel, its end included. Units are in ``attrs["units"]`` as CF's
    conventions write them; travel, contact points and provenance in the dataset's attributes. A stroke
    without curves is left out. Raises BuildError without xarray, ModelError for a step that is not positive.
    """
    require_frames()
    import xarray as xr

    if not (np.isfinite(step_mm) and step_mm > 0):
        raise ModelError(f"step_mm must be positive, got {step_mm}")
    strokes = [stroke for stroke in Stroke if model.of(stroke)]
    known = sorted({v for stroke in strokes for v in model.velocities_mm_s(stroke)})
    speeds = np.array(known or [np.nan] if velocities_mm_s is None else velocities_mm_s, dtype=np.float64)
    x = np.unique(np.append(np.arange(0.0, model.travel_mm, step_mm), model.travel_mm))
    # a curve of unknown velocity is the same at every speed
    grid = (x[np.newaxis], np.nan_to_num(speeds, nan=1.0)[:, np.newaxis])
    dimensions = ("stroke", "velocity", "displacement")
    force = np.stack([model.force_cN(*grid, stroke) for stroke in strokes])
    slope = np.stack([model.stiffness_cN_mm(*grid, stroke) for stroke in strokes])
    return xr.Dataset(
        {
            "force": (dimensions, force, {"units": "cN", "long_name": "force against the finger"}),
            "stiffness": (dimensions, slope, {"units": "cN mm-1", "long_name": "force over displacement"}),
        },
        {
            "stroke": [str(stroke) for stroke in strokes],
            "velocity": ("velocity", speeds, {"units": "mm s-1", "long_name": "mean speed of the stroke"}),
            "displacement": (
                "displacement",
                x,
                {"units": "mm", "long_name": "into the button, from contact"},
            ),
        },
        _about(model),
    )


def _about(model: FDVVModel) -> dict[str, Any]:
    points = {"travel": model.travel_mm, "actuation": model.actuation_mm, "reset": model.reset_mm}
    told = {f"{name}_mm": np.nan if at is None else at for name, at in points.items()}
    of = model.provenance
    return {
        "name": model.name,
        **told,
        "interpolation": str(model.interpolation),
        "source": of.source,
        "license": of.licence,
        "references": of.citation,
        "simulated": int(of.simulated),
        "Conventions": "CF-1.11",
    }
