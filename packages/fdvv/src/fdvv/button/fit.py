"""From a file of force curves to a model, with what was repaired and how well it fits."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.button.distorted import distorted
from fdvv.button.plausible import (
    OPTION,
    Implausible,
    implausible_cycles,
    implausible_fit,
    implausible_start,
    implausible_strokes,
    implausible_whole,
)
from fdvv.errors import FdvvError, InputError
from fdvv.force_text import force_text
from fdvv.formats.force.average import Averaged, average_by_velocity
from fdvv.formats.force.read import find_force_files, read_force_file
from fdvv.formats.force.split import CYCLE
from fdvv.formats.force.types import ForceFile
from fdvv.io.documents import own_kind
from fdvv.model.bump import CONTACT_cN, find_bottom_out_mm, find_contact_mm
from fdvv.model.bump_kept import BUMP_KEPT_ratio
from fdvv.model.curve import MeasuredCurve, Stroke, reading_order
from fdvv.model.fit import CurveFit, FitMethod, active_part, fit_curve
from fdvv.model.landmarks import CUT_SHORT_mm, Landmarks, landmarks
from fdvv.model.model import FDVVModel, Provenance

STOP_REACH_mm = 0.1  # strokes of a cycle leave their stop this close together; assumed, see _within

DECIMALS_mm = 6
"""A nanometre: subtracting the contact leaves noise in the last digits, which nobody should read."""


@dataclass(frozen=True)
class FitSettings:
    """How to fit; the fields are fdvv.model.fit.fit_curve's. control_points : the paper has 15; None is auto.

    accept_implausible : fit also what fdvv.button.plausible doubts; the doubt becomes a warning.
    """

    method: FitMethod = FitMethod.ADAPTIVE
    control_points: int | None = None
    degree: int | None = None
    smoothing_mm: float = 0.0
    accept_implausible: bool = False

    def describe(self) -> str:
        """Describe the settings in one sentence, for provenance."""
        size = "BIC*-chosen" if self.control_points is None else str(self.control_points)
        smoothing = f"smoothed with sigma {self.smoothing_mm} mm" if self.smoothing_mm else "not smoothed"
        return f"fitted with {self.method} knots, {size} control points per curve, {smoothing}"


@dataclass(frozen=True, eq=False)
class ModelFit:
    """A fitted model and how it came about.

    Attributes
    ----------
    model : displacement 0 is the contact of the slowest press.
    zero_mm : where that contact lies in the file's own displacement.
    fits : one per curve of the model, in the model's order; displacements are the model's.
    measured : the raw part of each stroke that was fitted, in the model's displacement, in fits' order.
    landmarks : of the slowest press; None if the file holds no press.
    warnings : what was repaired, left out or could not be found.
    """

    model: FDVVModel
    zero_mm: float
    fits: tuple[CurveFit, ...]
    measured: tuple[MeasuredCurve, ...]
    landmarks: Landmarks | None
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the report of ``fdvv fit --json``; "strokes" holds the slowest curve of each stroke."""
        strokes: dict[str, Any] = {}
        for fit in self.fits:
            strokes.setdefault(str(fit.curve.stroke), fit_report(fit))
        return {
            "name": self.model.name,
            "zero_mm": self.zero_mm,
            "strokes": strokes,
            "curves": [
                {"stroke": str(f.curve.stroke), "velocity_mm_s": f.curve.velocity_mm_s, **fit_report(f)}
                for f in self.fits
            ],
            "landmarks": self.landmarks.to_dict() if self.landmarks else {"travel_mm": self.model.travel_mm},
            "warnings": list(self.warnings),
        }


def fit_report(fit: CurveFit) -> dict[str, Any]:
    return {
        "rmse_cN": fit.rmse_cN,
        "max_cN": fit.max_cN,
        "rows_rmse_cN": fit.rows_rmse_cN,
        "control_points": fit.curve.control_points_cN.size,
        "degree": fit.curve.degree,
        "method": str(fit.method),
        "smoothing_mm": fit.smoothing_mm,
        "bump_kept_ratio": fit.bump_kept_ratio,
        "bump_kept_samples_ratio": fit.bump_kept_samples_ratio,
        "bic_star": fit.bic_star,
        "samples": fit.samples,
        "time_s": fit.time_s,
    }


def fit_file(path: Path, settings: FitSettings | None = None) -> ModelFit:
    """Read, repair, average and fit one file of force curves.

    Raises InputError if it cannot be read, or if it cannot be a button's (fdvv.button.plausible).
    """
    kind = own_kind(Path(path))
    if kind:
        raise InputError(path, "whole file", f"holds {kind}, not a measurement", "name a measured file")
    file = read_force_file(path)
    try:
        return fit_force_file(file, settings or FitSettings(), path)
    except InputError:
        raise
    except FdvvError as error:
        remedy = "check that the file holds one whole stroke from contact to the stop"
        raise InputError(path, "curve", str(error), remedy) from error


def fit_force_file(file: ForceFile, settings: FitSettings, path: Path | str) -> ModelFit:
    """Fit what a read file holds: repeats averaged per velocity, each stroke and velocity one curve.

    Raises InputError, naming path, if that cannot be a button's.
    """
    parts = measured_parts(file)
    accepted = refuse_implausible(path, parts.implausible, settings.accept_implausible)
    fits = tuple(
        fit_curve(p, settings.method, settings.control_points, settings.degree, settings.smoothing_mm)
        for p in parts.strokes
    )
    doubts = [doubt for pair in zip(fits, parts.strokes, strict=True) for doubt in implausible_fit(*pair)]
    accepted += refuse_implausible(path, doubts, settings.accept_implausible)
    origin = one_line(f"{Path(path).name} ({file.format})")
    model = FDVVModel(
        name=one_line(file.name) or "unnamed",
        travel_mm=parts.travel_mm,
        curves=tuple(fit.curve for fit in fits),
        actuation_mm=parts.actuation_mm,
        reset_mm=parts.reset_mm,
        provenance=Provenance(source=origin, method=settings.describe()),
    )
    found = landmarks(model) if model.of(Stroke.PRESS) else None
    return ModelFit(model, parts.zero_mm, fits, parts.strokes, found, accepted + parts.warnings)


def refuse_implausible(
    path: Path | str, doubts: Sequence[Implausible], accept: bool = False
) -> tuple[str, ...]:
    """Raise InputError with the first doubt, or return all as warnings if they are accepted."""
    if doubts and not accept:
        remedy = f"{doubts[0].remedy}; fdvv fit {OPTION} takes it as it is"
        raise InputError(path, doubts[0].place, f"{doubts[0].reason}: this cannot be a button's", remedy)
    return tuple(f"implausible, accepted as asked: {doubt}" for doubt in doubts)


@dataclass(frozen=True, eq=False)
class MeasuredParts:
    """The active part of every stroke of a file, before anything is fitted.

    Attributes
    ----------
    strokes : the mean of the repeats of each stroke and velocity, in reading order; displacement 0 is the
        contact of the first press.
    zero_mm : where that contact lies in the file's own displacement.
    travel_mm, actuation_mm, reset_mm : in the strokes' displacement; None where a point is not known.
    used, cycles : how many cycles the means hold, and how many the file has.
    warnings : what was repaired, left out or could not be found.
    implausible : why this cannot be a button's; empty if it can.
    """

    strokes: tuple[MeasuredCurve, ...]
    zero_mm: float
    travel_mm: float
    actuation_mm: float | None
    reset_mm: float | None
    used: int
    cycles: int
    warnings: tuple[str, ...]
    implausible: tuple[Implausible, ...] = ()


def measured_parts(file: ForceFile) -> MeasuredParts:
    """Average the repeats of each velocity and cut every stroke from contact to bottom-out."""
    groups = average_by_velocity(file)
    warnings = [*file.warnings]
    for group in groups:
        warnings += group.warnings
        warnings += [f"{label} left out: {reason}" for label, reason in group.left_out]
    zero, travel, stop_found = _zero_and_travel(groups, warnings)
    strokes = [stroke for group in groups for stroke in (group.press, group.release) if stroke is not None]
    parts = []
    stop = zero + travel if stop_found else None
    for part in (_within(active_part(stroke), stop) for stroke in strokes):
        x = np.round(part.displacement_mm - zero, DECIMALS_mm)
        parts.append(MeasuredCurve(x, part.force_cN, part.stroke, part.velocity_mm_s))
    parts.sort(key=reading_order)
    warnings += [sentence for part in parts if (sentence := _cut_short(part))]
    return MeasuredParts(
        strokes=tuple(parts),
        zero_mm=zero,
        travel_mm=travel,
        actuation_mm=_point([g.actuation_mm for g in groups], zero, travel, "actuation", warnings),
        reset_mm=_point([g.reset_mm for g in groups], zero, travel, "reset", warnings),
        used=sum(len(group.used) for group in groups),
        cycles=len(file.cycles),
        warnings=tuple(dict.fromkeys(warnings)),
        implausible=(
            *implausible_strokes(parts, stop_found),
            *_implausible_whole(file, groups, strokes, parts),
        ),
    )


def _cut_short(part: MeasuredCurve) -> str:
    """Say where a release ends before the button is free."""
    place_mm, force_cN = part.displacement_mm[0], part.force_cN[0]
    if part.stroke is Stroke.PRESS or place_mm <= CUT_SHORT_mm or force_cN <= CONTACT_cN:
        return ""
    return (
        f"the release ends {place_mm:.2f} mm from contact, at {force_text(force_cN, '.1f')}: what it gives "
        "back, and the "
        "loss, are not known"
    )


def _within(part: MeasuredCurve, stop_mm: float | None) -> MeasuredCurve:
    """Cut a stroke at the stop of the first press where it goes on into it: its own stop was missed.

    Strokes of one cycle leave their stop within 0.1 mm of each other.
    """
    if stop_mm is None or part.displacement_mm[-1] <= stop_mm + STOP_REACH_mm:
        return part
    return part.between(float(part.displacement_mm[0]), stop_mm)


def _implausible_whole(
    file: ForceFile,
    groups: Sequence[Averaged],
    strokes: Sequence[MeasuredCurve],
    parts: Sequence[MeasuredCurve],
) -> Iterator[Implausible]:
    for stroke in strokes:
        yield from implausible_whole(stroke)
    pairs = [(g.press, g.release) for g in groups if g.press is not None and g.release is not None]
    for press, release in pairs:
        yield from implausible_start(press, release)
    of_run = [c.press or c.release for c in file.cycles if c.label.startswith(CYCLE)]
    yield from implausible_cycles([stroke for stroke in of_run if stroke is not None])
    yield from distorted(strokes, parts, pairs)


def one_line(text: str) -> str:
    """Make a file's name fit for a model file: no line breaks, nothing that UTF-8 cannot hold."""
    return " ".join(text.encode(errors="replace").decode().split())


def _zero_and_travel(groups: Sequence[Averaged], warnings: list[str]) -> tuple[float, float, bool]:
    stroke = next(s for g in groups for s in (g.press, g.release) if s is not None)
    zero = find_contact_mm(stroke)
    stop = find_bottom_out_mm(stroke, zero)
    end = float(stroke.displacement_mm[-1]) if stop is None else stop
    if stop is None:
        warnings.append(f"no stop found on the {stroke.stroke}: travel taken to its last sample")
    return round(zero, DECIMALS_mm), round(end - zero, DECIMALS_mm), stop is not None


def _point(
    found: Sequence[float | None], zero: float, travel: float, what: str, warnings: list[str]
) -> float | None:
    point = next((p for p in found if p is not None), None)
    if point is None:
        return None
    if not 0 <= point - zero <= travel:
        place = f"{what} at {point - zero:.3f} mm"
        warnings.append(f"{place} lies outside the travel of {travel:.3f} mm: left out")
        return None
    return round(point - zero, DECIMALS_mm)


@dataclass(frozen=True, eq=False)
class FolderFit:
    """What became of one file of a folder: a fit, or the reason why not."""

    file: Path
    fit: ModelFit | None
    reason: str = ""


def measured_files(folder: Path) -> list[Path]:
    """List the files below a folder that may hold measured curves, in order; fdvv's own are passed over.

    Raises InputError if there is none.
    """
    files = [path for path in find_force_files(folder) if not own_kind(path)]
    if not files:
        reason = "no .csv, .ods, .json or .txt file of measurements in it"
        raise InputError(folder, "folder", reason, "name another folder")
    return files


def fit_files(
    files: Sequence[Path], settings: FitSettings | None = None, workers: int | None = None
) -> Iterator[FolderFit]:
    """Fit files of force curves, in order; a refused file yields its reason.

    The compiled fits release the interpreter lock, so threads share the cores.
    """

    def one(path: Path) -> FolderFit:
        try:
            return FolderFit(path, fit_file(path, settings))
        except FdvvError as error:
            return FolderFit(path, None, str(error))

    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        yield from pool.map(one, files)


def summarise(results: Sequence[FolderFit]) -> dict[str, Any]:
    """Return the summary of ``fdvv fit FOLDER --json``.

    Of each stroke the median and 90th percentile of its fits; of all strokes how many have a bump, and how
    many of those kept at least 95 % of it.
    """
    fits = [f for r in results if r.fit for f in r.fit.fits]
    kept = [f.bump_kept_ratio for f in fits if f.bump_kept_ratio is not None]
    strokes = {str(stroke): [f for f in fits if f.curve.stroke is stroke] for stroke in Stroke}
    return {
        "files": len(results),
        "refused": sum(r.fit is None for r in results),
        "bumps": len(kept),
        "bumps_kept": sum(ratio >= BUMP_KEPT_ratio for ratio in kept),
        "strokes": {stroke: _spread(of_it) for stroke, of_it in strokes.items() if of_it},
    }


def _spread(fits: Sequence[CurveFit]) -> dict[str, dict[str, float]]:
    columns = {name: [getattr(f, name) for f in fits] for name in ("rmse_cN", "rows_rmse_cN", "time_s")}
    return {
        name: {"median": float(np.median(values)), "p90": float(np.percentile(values, 90))}
        for name, values in columns.items()
    }
