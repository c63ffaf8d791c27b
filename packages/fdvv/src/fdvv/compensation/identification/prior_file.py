"""What a builder knows of a rig and of its force sensor, from TOML files (docs/reference/files.md)."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from msgspec import Meta
from msgspec.inspect import type_info

from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.identification.rig_model import Plausible, Prior
from fdvv.errors import InputError, ModelError
from fdvv.force_text import force_text
from fdvv.io.documents import read_toml
from fdvv.io.files import read_limited
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import CellSpec

LARGEST_bytes = 100_000
PLACES, FAR = 200, 1e6
"""Places of a curve that are looked at; a bound that no number meets, finite for the files of sessions."""
REMEDY = "see docs/reference/files.md"


@dataclass(frozen=True)
class Known:
    """A key of a file: its parameter, size in its unit, least and largest mean."""

    name: str
    scale: float
    low: float
    high: float


KNOWN = {
    "gain_ratio": Known("gain_0", 1.0, 0.2, 3.0),
    "mass_g": Known("mass_g", 1.0, 0.5, 1000.0),
    "friction_cN": Known("friction_cN", 1.0, 0.0, 500.0),
    "drag_N_s_m": Known("viscous_N_s_m", 1.0, 0.0, 100.0),
    "back_emf_N_s_m": Known("back_emf_N_s_m", 1.0, 0.0, 100.0),
    "weight_cN": Known("weight_cN", 1.0, -1000.0, 1000.0),
    "spring_N_m": Known("", 1.0, -5000.0, 5000.0),
    "electric_lag_ms": Known("electric_lag_s", 1e-3, 0.02, 4.0),
    "position_lag_ms": Known("position_lag_s", 1e-3, 0.05, 4.0),
}
"""Keys of a prior's file; each holds a mean and a spread (one standard deviation) in the key's unit."""
BOUNDS = {
    "friction_cN": 0.0,
    "viscous_N_s_m": 0.0,
    "mass_g": 0.1,
    "electric_lag_s": 2e-5,
    "position_lag_s": 5e-5,
}
"""Least values that identification may find; gain and delays have an upper one too."""
HIGHEST = {"gain_0": 3.0, "electric_lag_s": 4e-3, "position_lag_s": 4e-3}


@dataclass(frozen=True)
class SensorSheet:
    """What the data sheet of a force sensor says.

    Attributes
    ----------
    range_N : both signs. noise_cN : rms. delay_ms : time constant of its filter.
    moving_g : mass between sensor and cap, which moves with the cap; 0 for a cell in the cap.
    plate_g : mass between finger and cell. stiffness_N_mm, damping_ratio : of the cell under that plate.
        0 g and 0 N/mm: it is no load cell in the cap, and the force loop stays open.
    """

    range_N: Annotated[float, Meta(ge=0.05, le=1000.0)]
    noise_cN: Annotated[float, Meta(ge=0.0, le=100.0)]
    delay_ms: Annotated[float, Meta(ge=0.0, le=20.0)]
    moving_g: Annotated[float, Meta(ge=0.0, le=100.0)] = 0.0
    plate_g: Annotated[float, Meta(ge=0.0, le=100.0)] = 0.0
    stiffness_N_mm: Annotated[float, Meta(ge=0.0, le=1e5)] = 0.0
    damping_ratio: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.05

    @property
    def sensor(self) -> Sensor:
        """Return it as identification needs it: a plate lies before the cell, which reads what is left."""
        return Sensor(1e-3 * self.delay_ms, self.moving_g - self.plate_g, self.noise_cN)

    @property
    def cell(self) -> CellSpec | None:
        """Return the load cell in the cap, for the force loop; None if it is none."""
        if not (self.plate_g and self.stiffness_N_mm):
            return None
        plate_kg, stiffness_N_m = 1e-3 * self.plate_g, 1e3 * self.stiffness_N_mm
        damping = 2 * self.damping_ratio * math.sqrt(stiffness_N_m * plate_kg)
        return CellSpec(
            plate_kg=plate_kg,
            stiffness_N_m=stiffness_N_m,
            damping_N_s_m=damping,
            filter_s=1e-3 * self.delay_ms,
        )


def load_prior(path: Path | str) -> Prior:
    """Read a prior. Raises InputError with file, key, what is wrong and what to do."""
    path = Path(path)
    data = _read(path)
    pairs = {key: _pair(path, key, value, KNOWN) for key, value in data.items()}
    if not pairs:
        raise InputError(path, "whole file", "says nothing of the rig", f"write one of {', '.join(KNOWN)}")
    spring = pairs.pop("spring_N_m", (0.0, 0.0))
    try:
        ranges = {KNOWN[key].name: _plausible(KNOWN[key], *pair) for key, pair in pairs.items()}
        return Prior(ranges=ranges, spring_N_m=spring)
    except ModelError as error:
        raise InputError(path, "whole file", str(error), REMEDY) from error


def _plausible(known: Known, mean: float, spread: float) -> Plausible:
    low, high = BOUNDS.get(known.name, -FAR), HIGHEST.get(known.name, FAR)
    low = 0.2 if known.name == "gain_0" else low
    return Plausible(known.scale * mean, known.scale * spread, low, high)


def _pair(path: Path, key: str, value: Any, known: Mapping[str, Known]) -> tuple[float, float]:
    if key not in known:
        raise _key_error(path, key, known)
    if not isinstance(value, dict) or set(value) != {"mean", "spread"}:
        raise InputError(
            path, key, "must hold a mean and a spread", f"write {key} = {{ mean = 1, spread = 0.2 }}"
        )
    mean, spread = (_number(path, f"{key}.{part}", value[part]) for part in ("mean", "spread"))
    low, high = known[key].low, known[key].high
    if not low <= mean <= high:
        raise InputError(path, f"{key}.mean", f"is {mean:g}, not {low:g} to {high:g}", "check its unit")
    if not spread > 0:
        raise InputError(path, f"{key}.spread", f"is {spread:g}", "write one standard deviation, above 0")
    return mean, spread


def load_sensor(path: Path | str) -> SensorSheet:
    """Read the data sheet of a force sensor. Raises InputError as load_prior does."""
    path = Path(path)
    data = _read(path)
    sheet_type: Any = type_info(SensorSheet)
    known = {field.name: field for field in sheet_type.fields}
    for key, value in data.items():
        if key not in known:
            raise _key_error(path, key, known)
        number, (low, high) = _number(path, key, value), (known[key].type.ge, known[key].type.le)
        if not low <= number <= high:
            raise InputError(path, key, f"is {number:g}, not {low:g} to {high:g}", "check its unit")
    for key, field in known.items():
        if field.required and key not in data:
            raise InputError(path, key, "is missing", "take it from the sensor's data sheet")
    sheet = SensorSheet(**{key: float(value) for key, value in data.items()})
    if bool(sheet.plate_g) != bool(sheet.stiffness_N_mm):
        lacking = "stiffness_N_mm" if sheet.plate_g else "plate_g"
        raise InputError(
            path, lacking, "is missing", "a load cell in the cap needs plate_g and stiffness_N_mm"
        )
    return sheet


def check_range(path: Path, model: FDVVModel, velocities_mm_s: Sequence[float]) -> SensorSheet:
    """Read a sensor's data sheet for a button. InputError as for load_sensor, and beyond its range."""
    sheet = load_sensor(path)
    grid = np.linspace(0.0, model.travel_mm, PLACES)
    strokes = [stroke for stroke in Stroke if model.of(stroke)]
    largest_cN = max(
        float(np.abs(model.force_cN(grid, v, stroke)).max()) for v in velocities_mm_s for stroke in strokes
    )
    if largest_cN > 100 * sheet.range_N:
        reason = f"is {sheet.range_N:g}, {model.name} needs {force_text(largest_cN, '.0f')}"
        raise InputError(path, "range_N", reason, "choose a lighter button, or another sensor")
    return sheet


def _read(path: Path) -> dict[str, Any]:
    return read_toml(read_limited(path, LARGEST_bytes, REMEDY), path, REMEDY)


def _number(path: Path, place: str, value: Any) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
        raise InputError(path, place, f"must be a number, got {value!r}", "write a plain number")
    return float(value)


def _key_error(path: Path, key: str, known: Mapping[str, Any]) -> InputError:
    near = difflib.get_close_matches(key, list(known), 1, 0.5)
    remedy = f'did you mean "{near[0]}"?' if near else f"known are {', '.join(known)}"
    return InputError(path, key, "is no key of this file", remedy)
