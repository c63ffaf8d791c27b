"""Synthetic measurements whose answers are known."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray

CONTACT_mm, STOP_mm = 0.3, 4.3
CLOSES_mm, OPENS_mm = 2.3, 2.1


def known_cN(x_mm: FloatArray, stroke: str = "press", added_cN: float = 0.0) -> FloatArray:
    """Return the force of the synthetic button in bench coordinates: step, spring, bump, stop."""
    d = x_mm - CONTACT_mm
    back = stroke == "release"
    bump = 20 * np.exp(-(((d - (1.0 if back else 1.2)) / 0.4) ** 2))
    free = 35 * np.clip(d / 0.05, 0, 1) + 5 * d + bump - (6 if back else 0) + added_cN
    return np.asarray(np.where(d <= 0, 0.0, free + 1200 * np.clip(x_mm - STOP_mm, 0, None)))


def bench_mm() -> FloatArray:
    """Return the displacements of the synthetic bench: 5 um steps to 0.08 mm beyond the stop."""
    return np.asarray(np.round(np.arange(0.0, STOP_mm + 0.0801, 0.005), 3))


def write_cycle(path: Path, added_cN: float = 0.0, seed: int = 0) -> Path:
    """Write a press and its release with an electrical contact column."""
    x = bench_mm()
    noise = np.random.default_rng(seed).normal(0, 0.03, (2, x.size))
    press = known_cN(x, "press", added_cN) + noise[0]
    release = known_cN(x, "release", added_cN) + noise[1]
    rows = [f"{v:.3f},{f:.4f},{int(v >= CLOSES_mm)}" for v, f in zip(x, press, strict=True)]
    rows += [f"{v:.3f},{f:.4f},{int(v >= OPENS_mm)}" for v, f in zip(x[::-1], release[::-1], strict=True)]
    path.write_text("displacement_mm,force_cN,contact\n" + "\n".join(rows) + "\n")
    return path


def write_columns(path: Path, columns: Mapping[str, FloatArray]) -> Path:
    """Write one press per force column over a shared displacement."""
    x = bench_mm()
    table = np.column_stack([x, *columns.values()])
    lines = [",".join(f"{v:.3f}" for v in row) for row in table]
    path.write_text(",".join(["displacement_mm", *columns]) + "\n" + "\n".join(lines) + "\n")
    return path


def line_model(name: str, force_cN: float, slope_cN_mm: float = 5.0, travel_mm: float = 4.0) -> FDVVModel:
    """Make a button whose press and release (2 cN below it) are straight lines."""
    ends = np.array([force_cN, force_cN + slope_cN_mm * travel_mm])
    knots = [0.0, 0.0, travel_mm, travel_mm]
    curves = (
        ForceCurve(Stroke.PRESS, None, 1, np.array(knots), ends),
        ForceCurve(Stroke.RELEASE, None, 1, np.array(knots), ends - 2),
    )
    return FDVVModel(name, travel_mm, curves)
