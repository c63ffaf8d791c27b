"""Buttons of known force for the tests of the shelf."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_studio.library.figures import row_of_model
from fdvv_studio.library.row import ButtonRow, Origin
from tests.support.buttons import write_cycle

TRAVEL_mm = 4.0


def polyline(force: Callable[[FloatArray], FloatArray], stroke: Stroke = Stroke.PRESS) -> ForceCurve:
    """Draw a force through 401 points from contact to 4 mm."""
    x = np.linspace(0.0, TRAVEL_mm, 401)
    return ForceCurve(stroke, None, 1, np.concatenate([x[:1], x, x[-1:]]), force(x))


def button(
    press: Callable[[FloatArray], FloatArray],
    release: Callable[[FloatArray], FloatArray] | None = None,
    name: str = "button",
    actuation_mm: float | None = None,
) -> FDVVModel:
    """Make a button of known forces."""
    curves = (polyline(press), *((polyline(release, Stroke.RELEASE),) if release else ()))
    return FDVVModel(name, TRAVEL_mm, curves, actuation_mm)


def spring(x: FloatArray) -> FloatArray:
    """Climb a contact step of 35 cN within 50 um, then 5 cN/mm."""
    return np.asarray(35 * np.clip(x / 0.05, 0, 1) + 5 * x)


def bumped(drop_cN: float, width_mm: float = 0.4) -> Callable[[FloatArray], FloatArray]:
    """Return the spring with a fall of drop_cN at 1.5 mm, over width_mm, that comes back until 3.5 mm."""

    def force(x: FloatArray) -> FloatArray:
        down = np.clip((x - 1.5) / width_mm, 0, 1)
        up = np.clip((x - 1.5 - width_mm) / (2.0 - width_mm), 0, 1)
        level = spring(np.minimum(x, 1.5)) + 5 * np.clip(x - 3.5, 0, None)
        return np.asarray(level - drop_cN * (down - up))

    return force


def dome(x: FloatArray) -> FloatArray:
    """Build up to 60 cN at 1.2 mm, collapse to 33 cN at 2.6 mm, and stiffen as rubber does."""
    return np.interp(x, [0, 1.2, 2.6, 3.4, 4.0], [0, 60, 33, 50, 90])


def row(model: FDVVModel, button_id: str = "own:button", collection: str = "") -> ButtonRow:
    return row_of_model(model, button_id, Origin(button_id.partition(":")[0]), collection)


def write_folder(folder: Path, names: dict[str, float]) -> Path:
    """Write measured files, each with a force added to all of its curve."""
    for i, (name, added_cN) in enumerate(names.items()):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        write_cycle(folder / name, added_cN=added_cN, seed=i)
    return folder
