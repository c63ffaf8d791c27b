"""Force curves as the tables that switch testers and their sites use."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import zip_longest

import numpy as np

from fdvv.errors import ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray, gf_from_cN

STEP_mm = 0.01
"""The finest published benches step 5 µm, most 10."""
DECIMALS_mm = 9
"""Readers round to a picometre; so do writers, and nothing is lost between them."""


def curves_csv(model: FDVVModel, step_mm: float = STEP_mm) -> Exported:
    """Write every curve into one plain table, mm and cN, each as it was made: presses down, releases up.

    A curve has its displacement and force, and where the contact's point is known whether it is closed;
    stroke, velocity and unit stand in the names. Columns of shorter curves end early.
    """
    titles: list[str] = []
    columns: list[Sequence[str]] = []
    for curve in model.curves:
        x, force, closed = _as_made(model, curve, step_mm)
        made = {"displacement_mm": x, "actuated": closed, "force_cN": force}
        for quantity, values in made.items():
            if values is not None:
                titles.append(f"{_label(curve)}_{quantity}")
                columns.append(_cells(values))
    return Exported(
        "csv",
        _table(titles, columns),
        (
            f"{len(model.curves)} curves with stroke and velocity, a sample each {step_mm:g} mm",
            *_points(model),
        ),
        (
            "control points (samples of them are written)",
            *_without_vibration(model),
            "provenance and spreads",
        ),
    )


def bluepylons_csv(
    model: FDVVModel, velocity_mm_s: float | None = None, step_mm: float = STEP_mm
) -> Exported:
    """Write one press and its release as the Open Switch Curve Meter does: x_um, force_gf, actuated."""
    parts = [_as_made(model, curve, step_mm) for curve in _pair(model, velocity_mm_s)]
    x, force = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    # the meter writes a column of zeros where no contact was wired
    closed = np.concatenate([np.zeros(x.size) if c is None else c for x, _, c in parts])
    columns = [
        [repr(v) for v in values.tolist()] for values in (1000 * x, gf_from_cN(force), closed.astype(int))
    ]
    data = _table(["x_um", "force_gf", "actuated"], columns)
    return Exported("bluepylons-csv", data, ("one press and its release", *_points(model)), _of_one(model))


def haata_csv(model: FDVVModel, step_mm: float = STEP_mm) -> Exported:
    """Write every press and release as numbered cycles of HaaTa's charts: quoted cells, mm and gf."""
    titles, columns = [], []
    for stroke in Stroke:
        for number, curve in enumerate(model.of(stroke), start=1):
            x, force, _ = _as_made(model, curve, step_mm)
            for axis, values in (("x", x), ("y", gf_from_cN(force))):
                titles.append(f'"{stroke.capitalize()} {number}, {axis}"')
                columns.append([f'"{cell}"' for cell in _cells(values)])
    lost = ("velocities (cycles are only numbered)", "contact points", *_without_vibration(model))
    return Exported("haata", _table(titles, columns, '""'), (f"{len(model.curves)} curves",), lost)


def switch_tester_json(
    model: FDVVModel, velocity_mm_s: float | None = None, step_mm: float = STEP_mm
) -> Exported:
    """Write one press and its release as the switch force tester's JSON: lists in mm and gf, points."""
    record: dict[str, object] = {}
    for curve in _pair(model, velocity_mm_s):
        x, force, _ = _as_made(model, curve, step_mm)
        side = "down" if curve.stroke is Stroke.PRESS else "up"
        record |= {f"{side}_x": x.tolist(), f"{side}_y": gf_from_cN(force).tolist()}
    for name, stroke in (("pressPoint", Stroke.PRESS), ("releasePoint", Stroke.RELEASE)):
        at = model.actuation_mm if stroke is Stroke.PRESS else model.reset_mm
        on = model.nearest(stroke, velocity_mm_s)
        if at is not None and on is not None:
            record[name] = [at, gf_from_cN(float(on.force_cN(at)))]
    data = (json.dumps(record, allow_nan=False) + "\n").encode()
    return Exported("tester-json", data, ("one press and its release", *_points(model)), _of_one(model))


def _as_made(
    model: FDVVModel, curve: ForceCurve, step_mm: float
) -> tuple[FloatArray, FloatArray, FloatArray | None]:
    """Sample a curve in the order of time: displacement, force and whether the contact is closed.

    The contact's point is among the samples, so that it is read back where it is. Where only the other
    stroke's is known, the contact stays as it was: open on the press, closed on the release.
    """
    if not (np.isfinite(step_mm) and step_mm >= 1e-4):
        raise ModelError(f"step_mm must be at least 0.0001, got {step_mm}")
    press = curve.stroke is Stroke.PRESS
    point = model.actuation_mm if press else model.reset_mm
    inside = point is not None and curve.start_mm < point < curve.end_mm
    whole = np.arange(np.ceil((curve.end_mm - curve.start_mm) / step_mm)) * step_mm + curve.start_mm
    x = np.unique(np.round(np.append(whole, [curve.end_mm, *([point] if inside else [])]), DECIMALS_mm))
    closed = None
    if model.actuation_mm is not None or model.reset_mm is not None:
        never = np.inf if press else -np.inf
        at = round(float(point), DECIMALS_mm) if inside and point is not None else never
        closed = (x >= at if press else x > at).astype(np.float64)
    order = slice(None) if press else slice(None, None, -1)
    return x[order], curve.force_cN(x)[order], None if closed is None else closed[order]


def _pair(model: FDVVModel, velocity_mm_s: float | None) -> list[ForceCurve]:
    found = [model.nearest(stroke, velocity_mm_s) for stroke in Stroke]
    return [curve for curve in found if curve is not None]


def _label(curve: ForceCurve) -> str:
    if curve.velocity_mm_s is None:
        return str(curve.stroke)
    return f"{curve.stroke}_{np.format_float_positional(curve.velocity_mm_s, trim='-')}mm_s"


def _cells(values: FloatArray) -> list[str]:
    return [repr(value).removesuffix(".0") for value in values.tolist()]


def _table(titles: Sequence[str], columns: Sequence[Sequence[str]], blank: str = "") -> bytes:
    rows = [titles, *zip_longest(*columns, fillvalue=blank)]
    return "".join(",".join(row) + "\n" for row in rows).encode()


def _points(model: FDVVModel) -> tuple[str, ...]:
    known = [n for n, at in (("actuation", model.actuation_mm), ("reset", model.reset_mm)) if at is not None]
    return (" and ".join(known) + (" point" if len(known) == 1 else " points"),) if known else ()


def _without_vibration(model: FDVVModel) -> tuple[str, ...]:
    return (f"{len(model.vibrations)} vibrations",) if model.vibrations else ()


def _of_one(model: FDVVModel) -> tuple[str, ...]:
    others = len(model.curves) - len(_pair(model, None))
    more = (f"{others} curves at other velocities",) if others else ()
    return (*more, "the velocity", *_without_vibration(model))
