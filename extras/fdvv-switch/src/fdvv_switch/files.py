"""A designed mechanism as files: sizes, curves, cam, drawings, a button for the twin, a report."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fdvv.io.documents import finite
from fdvv.io.files import write_atomic
from fdvv.twin.files import button_to_toml
from fdvv.units import FloatArray
from fdvv_switch.design_button import MechanismResult
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.report import mechanism_report
from fdvv_switch.section import cam_points_mm, drawing_dxf, drawings_of


def write_mechanism(result: MechanismResult, folder: Path) -> tuple[Path, ...]:
    """Write everything of a mechanism into a folder, each file whole or not at all; give their paths.

    All is worked out before the first file is written. Raises BuildError without ezdxf or matplotlib.
    """
    texts = dict(_texts(result))
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        write_atomic(folder / name, text)
    return tuple(folder / name for name in texts)


def _texts(result: MechanismResult) -> Iterator[tuple[str, str]]:
    document = json.dumps(finite(result.to_dict()), indent=2, ensure_ascii=False, allow_nan=False)
    yield "mechanism.json", document + "\n"
    yield "curves.csv", _curves_csv(result)
    if isinstance(result.mechanism, LeafMechanism):
        yield "cam.csv", _cam_csv(result.mechanism)
    for drawing in drawings_of(result.mechanism):
        yield f"{drawing.name}.dxf", drawing_dxf(drawing)
    if result.button is not None:
        yield "button.toml", button_to_toml(result.button)
    yield "report.html", mechanism_report(result)


def _curves_csv(result: MechanismResult) -> str:
    x, target, band = result.target.displacement_mm, result.target, result.band
    press, release = result.mechanism.strokes_cN(x)
    return _csv(
        {
            "displacement_mm": x,
            "target_press_cN": target.press_cN,
            "press_cN": press,
            "press_low_cN": band.press_low_cN,
            "press_high_cN": band.press_high_cN,
            "target_release_cN": target.release_cN,
            "release_cN": release,
            "release_low_cN": band.release_low_cN,
            "release_high_cN": band.release_high_cN,
        }
    )


def _cam_csv(mechanism: LeafMechanism) -> str:
    x, cam = cam_points_mm(mechanism), mechanism.cam
    surface = cam.surface_mm(x)
    return _csv(
        {
            "displacement_mm": x,
            "height_mm": cam.at(x),
            "slope_ratio": cam.at(x, 1),
            "curvature_1_mm": cam.curvature_1_mm(x),
            "leaf_cN": mechanism.leaf.force_cN(cam.at(x)),
            "surface_along_mm": surface[:, 0],
            "surface_across_mm": surface[:, 1],
        }
    )


def _csv(columns: dict[str, FloatArray]) -> str:
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(columns), *(",".join(f"{value:.5g}" for value in row) for row in rows)]
    return "\n".join(lines) + "\n"
