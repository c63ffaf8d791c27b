"""Rows of buttons: figures read from the curves; what is not there is None, with the reason.

Measured curves are not fitted for this: they are averaged over 20 um and joined by lines.
"""

from __future__ import annotations

import re
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fdvv.button.fit import MeasuredParts, measured_parts, one_line, refuse_implausible
from fdvv.button.kind import ButtonKind, bump_of, kind_of
from fdvv.button.like import sketch_of
from fdvv.errors import FdvvError, InputError
from fdvv.formats.force.read import read_force_file
from fdvv.io.documents import MODEL, own_kind
from fdvv.model.bump import running_mean
from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
from fdvv.model.file import load_model
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv_studio.library.row import NUMBERS, ButtonRow, Origin
from fdvv_studio.library.stated import Stated, find_type

AVERAGED_mm = 0.02  # finer than the 50 um in which a clicky switch falls; a shorter mean leaves more noise


def polyline_model(parts: MeasuredParts, name: str) -> FDVVModel:
    """Make a model of degree 1 through the measured strokes, averaged over 20 um. Raises ModelError."""
    curves = tuple(_polyline(stroke) for stroke in parts.strokes)
    return FDVVModel(name, parts.travel_mm, curves, parts.actuation_mm, parts.reset_mm)


def _polyline(stroke: MeasuredCurve) -> ForceCurve:
    x, force, _ = stroke.by_displacement()
    grid = np.linspace(x[0], x[-1], max(2, round((x[-1] - x[0]) / AVERAGED_mm) + 1))
    mean = np.interp(grid, x, running_mean(x, force, AVERAGED_mm))
    knots = np.concatenate([grid[:1], grid, grid[-1:]])
    return ForceCurve(stroke.stroke, stroke.velocity_mm_s, 1, knots, mean)


def figures_of(model: FDVVModel) -> dict[str, float | None]:
    """Return the figures of a row by their names in ButtonRow; those of a press are None without one."""
    known = {"actuation_mm": model.actuation_mm, "reset_mm": model.reset_mm, "travel_mm": model.travel_mm}
    if model.nearest(Stroke.PRESS) is None:
        return {**dict.fromkeys(NUMBERS), **known}
    marks = landmarks(model)
    bump, back = bump_of(model, Stroke.PRESS), bump_of(model, Stroke.RELEASE)
    of_bump = ("peak_cN", "peak_mm", "valley_cN", "valley_mm", "drop_cN", "snap_ratio")
    return {
        **{name: getattr(bump, name) if bump else None for name in of_bump},
        **known,
        "release_drop_cN": back.drop_cN if back else None,
        "actuation_cN": marks.actuation_cN,
        "preload_cN": marks.preload_cN,
        "bottom_out_cN": marks.bottom_out_cN,
        "travel_mm": marks.travel_mm,
        "pre_slope_cN_mm": marks.pre_slope_cN_mm,
        "post_slope_cN_mm": marks.post_slope_cN_mm,
        "work_mJ": marks.work_mJ,
        "loss_mJ": marks.hysteresis_loss_mJ,
    }


def reasons_of(model: FDVVModel, figures: dict[str, float | None]) -> tuple[str, ...]:
    """Say why figures are None, each reason with its subject."""
    release = model.of(Stroke.RELEASE)
    reasons = {
        "bump": figures["peak_cN"] is None and "not detected: the force never falls by 4 cN",
        "release": (not release and "the source holds no release")
        or (figures["release_drop_cN"] is None and "no bump detected: the force never falls by 4 cN"),
        "loss": release and figures["loss_mJ"] is None and "the release ends while the button still pushes",
        "actuation": figures["actuation_mm"] is None and "the source does not tell where the contact closes",
        "reset": figures["reset_mm"] is None and "the source does not tell where the contact opens",
        "speed": not model.velocities_mm_s(Stroke.PRESS) and "the source tells no speed: a slow bench",
    }
    if not model.of(Stroke.PRESS):
        reasons |= {"bump": "the source holds no press", "press": "the source holds no press"}
    return tuple(f"{subject}: {reason}" for subject, reason in reasons.items() if reason)


STATED = re.compile(
    r"\b(silent|linear|tactile|clicky|click|dome|topre|optical|magnetic|hall|low profile|speed)\b", re.I
)

LONGEST_name = 200  # assumed: a heading may have any length, and a row shows it in a line


class ReadFile(NamedTuple):
    """A file as it was read; parts : None for a model file."""

    model: FDVVModel
    format: str
    parts: MeasuredParts | None = None


def read_file(path: Path) -> ReadFile:
    """Read a model file, or the polylines of a measured one's active strokes, unfitted. Raises InputError."""
    if own_kind(path) == MODEL:
        return ReadFile(load_model(path), "fdvv-model")
    file = read_force_file(path)
    try:
        parts = measured_parts(file)
        refuse_implausible(path, parts.implausible)
        name = one_line(file.name)[:LONGEST_name].strip() or "unnamed"
        return ReadFile(polyline_model(parts, name), file.format, parts)
    except InputError:
        raise
    except FdvvError as error:
        remedy = "check that the file holds one whole stroke from contact to the stop"
        raise InputError(path, "curve", str(error), remedy) from error


def row_of_file(
    path: Path,
    button_id: str,
    collection: str,
    origin: Origin = Origin.MEASURED,
    read: ReadFile | None = None,
) -> ButtonRow:
    """Return the row of a file, read already or read here. Raises InputError."""
    dated = datetime.fromtimestamp(path.stat().st_mtime, UTC).date().isoformat()
    content = read or read_file(path)
    stated = find_type(content.model.name, collection, path)
    return row_of_model(content.model, button_id, origin, collection, dated, content.parts, stated)


UNREADABLE = (FdvvError, OSError, ValueError, ArithmeticError, LookupError, MemoryError)
"""What reading a file may raise, whatever it holds."""


def refusal(error: BaseException) -> str:
    """Say in one line why a file cannot be used, and what to do about it."""
    if isinstance(error, InputError):
        return one_line(f"{error.place}: {error.reason}; {error.remedy}")
    return one_line(f"whole file: cannot be read ({error}); check the file")


def row_of_model(
    model: FDVVModel,
    button_id: str,
    origin: Origin,
    collection: str = "",
    date: str | None = None,
    parts: MeasuredParts | None = None,
    stated: Stated | None = None,
) -> ButtonRow:
    """Return the row of a model.

    parts : of a measured button, with its counts of presses.
    stated : its type, where more than its name is known.
    """
    kind, figures = kind_of(model), figures_of(model)
    stated = stated or find_type(model.name, collection)
    said = f"{model.name} {collection} {model.provenance.source}".replace("_", " ").replace("-", " ")
    words = [word.lower() for word in STATED.findall(said)] + ([stated.type] if stated else [])
    return ButtonRow(
        id=button_id,
        name=model.name,
        origin=origin,
        collection=collection,
        stated=tuple(dict.fromkeys(words)),
        kind=kind.kind,
        kind_reason=_kind_reason(kind, stated),
        **{name: None if value is None else round(value, 4) for name, value in figures.items()},  # type: ignore[arg-type]
        speeds_mm_s=tuple(round(v, 3) for v in model.velocities_mm_s(Stroke.PRESS)),
        cycles=parts.cycles if parts else None,
        used=parts.used if parts else None,
        date=date,
        source=model.provenance.source,
        licence=model.provenance.licence,
        simulated=model.provenance.simulated,
        why=reasons_of(model, figures),
        sketch=sketch_of(model),
    )


def _kind_reason(kind: ButtonKind, stated: Stated | None) -> str:
    """Say what is stated first, then what the curve suggests, how surely, and by which fact."""
    first = f"stated {stated}; the curve suggests {str(kind.kind).rstrip('?')}, " if stated else ""
    sure = "" if kind.sure_ratio is None else f"right for {100 * kind.sure_ratio:.0f} % of such curves: "
    return f"{first}{sure}{kind.fact}"
