"""Forces measured on a rig for a button: quartiles to draw beside the intended force."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv.model.curve import Stroke

LIMIT_bytes = 8_000_000  # a curve has four numbers at some 200 places, about 15 kB: hundreds of curves fit
_REMEDY = "probe the button again"


@dataclass(frozen=True)
class MeasuredBand:
    """One stroke at one speed over several presses: quartiles of the force on the finger.

    displacement_mm, low_cN, median_cN, high_cN : (n,) on the places judged.
    mean_error_cN : median over the presses of the mean error against the model that was probed.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    low_cN: tuple[float, ...]
    median_cN: tuple[float, ...]
    high_cN: tuple[float, ...]
    mean_error_cN: float


@dataclass(frozen=True)
class MeasuredButton:
    """The curves of a button; simulated : the presses came from the twin."""

    device_name: str
    presses: int
    simulated: bool
    curves: tuple[MeasuredBand, ...]


class _Curve(msgspec.Struct):
    stroke: Stroke
    velocity_mm_s: float
    mean_error_cN: float
    displacement_mm: list[float]
    rendered_quartiles_cN: Annotated[list[list[float]], Meta(min_length=3, max_length=3)]


class _Probe(msgspec.Struct):
    device: str
    presses: int
    simulated: bool
    curves: list[_Curve]


def load_measured_button(project: Path, name: str) -> MeasuredButton | None:
    """Read ``<project>/measured/<name>.json``, a ProbeResult as a document; None if there is none.

    name is looked up among the files there, never made into a path. Raises InputError on a broken file.
    """
    path = next((p for p in (project / "measured").glob("*.json") if p.stem == name), None)
    return None if path is None else _read(read_limited(path, LIMIT_bytes, _REMEDY), path)


def _read(text: bytes, path: Path) -> MeasuredButton:
    try:
        probe = msgspec.json.decode(text, type=_Probe)
    except msgspec.DecodeError as error:
        raise InputError(path, "whole file", str(error), _REMEDY) from error
    for i, curve in enumerate(probe.curves):
        sizes = {len(curve.displacement_mm), *map(len, curve.rendered_quartiles_cN)}
        if len(sizes) != 1:
            raise InputError(path, f"$.curves[{i}]", f"columns of different length, {sorted(sizes)}", _REMEDY)
    return MeasuredButton(probe.device, probe.presses, probe.simulated, tuple(map(_band, probe.curves)))


def _band(curve: _Curve) -> MeasuredBand:
    low, median, high = map(tuple, curve.rendered_quartiles_cN)
    places = tuple(curve.displacement_mm)
    return MeasuredBand(curve.stroke, curve.velocity_mm_s, places, low, median, high, curve.mean_error_cN)
