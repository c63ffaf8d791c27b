"""Buttons to begin with when there is none to begin from."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from fdvv.model import FDVVModel, ForceCurve, Provenance, Stroke

TRAVEL_mm = 4.0
VELOCITY_mm_s = 50.0
"""Of the first curves; more can be drawn beside them."""
FRICTION_cN = 8.0
"""A release gives back so much less than the press took."""


class ModelTemplate(StrEnum):
    """A plain spring, or one with a bump half-way."""

    LINEAR = "linear"
    TACTILE = "tactile"


_PRESS_cN = {
    ModelTemplate.LINEAR: [40, 42, 44, 46, 48, 50, 52, 54, 56, 58, 60, 62],
    ModelTemplate.TACTILE: [25, 34, 44, 54, 60, 52, 40, 42, 48, 54, 60, 66],
}


def new_model(name: str, template: ModelTemplate | str) -> FDVVModel:
    """Make a button of 4 mm travel, drawn, to be edited. Raises ModelError on a name that is none."""
    template = ModelTemplate(template)
    points = np.array(_PRESS_cN[template], dtype=np.float64)
    degree = 3
    inner = np.linspace(0.0, TRAVEL_mm, points.size - degree + 1)
    knots = np.concatenate([np.zeros(degree), inner, np.full(degree, TRAVEL_mm)]).round(6)
    forces = {Stroke.PRESS: points, Stroke.RELEASE: points - FRICTION_cN}
    return FDVVModel(
        name=name,
        travel_mm=TRAVEL_mm,
        curves=tuple(ForceCurve(s, VELOCITY_mm_s, degree, knots, f) for s, f in forces.items()),
        actuation_mm=2.0,
        reset_mm=1.8,
        provenance=Provenance(
            method=f"drawn from the {template} template", assumptions=("Nothing is measured.",)
        ),
    )
