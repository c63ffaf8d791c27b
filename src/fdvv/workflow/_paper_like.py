"""The design of the paper's space that comes closest to a button: something to start from."""

from __future__ import annotations

from itertools import product

import numpy as np

from fdvv.errors import InputError
from fdvv.model import FDVVModel, Stroke
from fdvv.optimize import DesignSpace, paper_space
from fdvv.units import FloatArray

PLACES = 7
"""Tried in the range of each point."""


def paper_design_like(model: FDVVModel) -> dict[str, float]:
    """Give the design whose points are nearest to a button's slowest press in the mean square.

    The three places are searched on a grid; what a range does not reach stays at its bound. InputError on a
    model without a press.
    """
    if not model.of(Stroke.PRESS):
        raise InputError(model.name, "curves", "it has no press", "start from another button")
    space = paper_space()
    curve = model.of(Stroke.PRESS)[0]
    x = np.linspace(0.0, model.travel_mm, 100)
    wanted = curve.force_cN(np.clip(x, curve.start_mm, curve.end_mm))
    tried = [_points(space, places, x, wanted) for places in product(*_places(space, model.travel_mm))]
    best = min(tried, key=lambda points: _miss(points, x, wanted))
    names = (*(f"x{i}_mm" for i in (1, 2, 3)), *(f"y{i}_cN" for i in (1, 2, 3)))
    design = dict(zip(names, best.T.ravel().tolist(), strict=True))
    actuation_mm = model.actuation_mm if model.actuation_mm is not None else model.travel_mm / 2
    onset_mm = model.vibrations[0].onset_mm if model.vibrations else actuation_mm
    return _within(space, {**design, "actuation_mm": actuation_mm, "vibration_mm": onset_mm})


def _places(space: DesignSpace, travel_mm: float) -> list[FloatArray]:
    """Give what is tried for each place; none beyond the travel but where the range begins there."""
    ranges = [one for one in space.parameters if one.name.startswith("x")]
    return [np.linspace(one.low, max(one.low, min(one.high, travel_mm)), PLACES) for one in ranges]


def _points(space: DesignSpace, places: tuple[float, ...], x: FloatArray, wanted: FloatArray) -> FloatArray:
    """Put the points on the curve, within their ranges, (3, 2)."""
    low, high = next((one.low, one.high) for one in space.parameters if one.name == "y1_cN")
    return np.column_stack([places, np.clip(np.interp(places, x, wanted), low, high)])


def _miss(points: FloatArray, x: FloatArray, wanted: FloatArray) -> float:
    return float(np.mean((np.interp(x, points[:, 0], points[:, 1]) - wanted) ** 2))


def _within(space: DesignSpace, design: dict[str, float]) -> dict[str, float]:
    found = {one.name: float(np.clip(design[one.name], one.low, one.high)) for one in space.parameters}
    return space.checked(found)
