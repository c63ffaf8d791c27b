"""What buttons that people press are like: bounds for variations of one.

Source: the middle 95 % of 107 buttons, those shipped and those in the shared measurements that fdvv reads,
rounded outwards (`packages/fdvv-people/tests/optimize/test_realistic.py` computes them again). 23 state
where they actuate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from fdvv.errors import ModelError
from fdvv.model.landmarks import Landmarks, landmarks
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.model_space import force_ends_cN, model_space
from fdvv_people.optimize.space import DesignSpace

REAL: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "actuation_mm": (1.5, 2.4),
        "actuation_cN": (34.0, 63.0),
        "post_slope_cN_mm": (2.0, 28.0),
        "drop_cN": (4.0, 38.0),
        "peak_mm": (0.05, 3.9),
        "snap_mm": (0.05, 1.9),
        "bottom_out_cN": (38.0, 91.0),
    }
)
"""Figures of real buttons: where the contact closes; a bump falls by drop_cN within snap_mm."""
NARROW_RATIO = 0.1
"""A range that leaves less of a parameter's own is of other buttons: a mouse travels a tenth of a key."""


def realistic_space(base: FDVVModel, names: Sequence[str] = ("FDV",)) -> DesignSpace:
    """Return `model_space` between bounds that keep designs near real buttons, the base always among them."""
    return model_space(base, names, realistic_bounds(base, names), most_cN=realistic_cN(base))


def realistic_bounds(base: FDVVModel, names: Sequence[str] = ("FDV",)) -> dict[str, tuple[float, float]]:
    """Return (low, high) by name for the parameters of a space that real buttons narrow.

    The base lies within, even where it is no usual button. What no measurement says is left out: strength,
    frequency and onset of the vibration, and scales per velocity.
    """
    wanted = _wanted(base)
    found = {}
    for one in model_space(base, names).parameters:
        if one.name not in wanted:
            continue
        low, high = max(one.low, wanted[one.name][0]), min(one.high, wanted[one.name][1])
        if high - low >= NARROW_RATIO * (one.high - one.low):
            found[one.name] = low, high
    return found


def _wanted(base: FDVVModel) -> dict[str, tuple[float, float]]:
    """Return the ranges that real buttons allow a base, each with the base in it."""
    found = {"bump_cN": (0.0, REAL["drop_cN"][1]), "bump_mm": REAL["peak_mm"], "snap_mm": REAL["snap_mm"]}
    marks = _marks(base)
    if base.actuation_mm is not None:
        found["actuation_mm"] = _with(REAL["actuation_mm"], base.actuation_mm)
    if marks and marks.actuation_cN and marks.actuation_cN > 0:
        low, high = (force_cN / marks.actuation_cN for force_cN in REAL["actuation_cN"])
        found["force_ratio"] = _with((low, high), 1.0)
    if marks:
        low, high = (slope - marks.post_slope_cN_mm for slope in REAL["post_slope_cN_mm"])
        if low < 0 < high:  # the end of a dome's travel is steeper than any spring
            found["stiffness_cN_mm"] = low, high
    return found


def _with(bounds: tuple[float, float], own: float) -> tuple[float, float]:
    return min(bounds[0], own), max(bounds[1], own)


def _marks(base: FDVVModel) -> Landmarks | None:
    try:
        return landmarks(base)
    except ModelError:
        return None


def realistic_cN(base: FDVVModel) -> float:
    """Return the largest force of a variation: that of real buttons at their bottom, or the base's."""
    return max(REAL["bottom_out_cN"][1], force_ends_cN(base)[1])
