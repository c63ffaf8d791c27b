"""Open a button from whatever names one: a built-in, a model file or a file of measured curves."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fdvv.errors import InputError, did_you_mean
from fdvv.io.documents import MODEL, own_kind
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.edit import Conflict, merge
from fdvv.model.file import MODEL_SUFFIX, builtin_names, load_builtin, load_model
from fdvv.model.model import FDVVModel

if TYPE_CHECKING:
    from fdvv.button.fit import FitSettings


def open_button(spec: str, settings: FitSettings | None = None) -> FDVVModel:
    """Return the model that spec names.

    A built-in's name, a file that fdvv wrote, or a file of measured curves, which is fitted.
    Raises InputError.
    """
    if spec in builtin_names():
        return load_builtin(spec)
    path = Path(spec)
    if path.name.endswith(MODEL_SUFFIX) or own_kind(path) == MODEL:
        return load_model(path)
    if not spec or not path.is_file():
        is_folder = spec and path.is_dir()
        reason = "is a folder, one button is needed" if is_folder else "no such file or built-in button"
        remedy = f"name a file or one of {', '.join(builtin_names())}"
        near = did_you_mean(spec.lower(), builtin_names(), " ").strip()
        raise InputError(spec or "''", "argument", reason, f"{near} Else {remedy}" if near else remedy)
    # reading foreign files takes a dozen modules that a built-in does not need
    from fdvv.button.fit import fit_file

    return fit_file(path, settings).model


class FolderButton(NamedTuple):
    """What became of one file of a folder: a button, or the reason why not."""

    file: Path
    model: FDVVModel | None
    reason: str = ""


def button_files(folder: Path) -> list[Path]:
    """List the model files below a folder or, if there are none, its measured files. Raises InputError."""
    from fdvv.button.fit import measured_files

    return sorted(folder.rglob(f"*{MODEL_SUFFIX}")) or measured_files(folder)


def open_files(files: Sequence[Path]) -> Iterator[FolderButton]:
    """Open files that button_files lists, in order; a refused one yields its reason."""
    if not files[0].name.endswith(MODEL_SUFFIX):
        from fdvv.button.fit import fit_files

        for result in fit_files(files):
            yield FolderButton(result.file, result.fit.model if result.fit else None, result.reason)
        return
    for path in files:
        try:
            yield FolderButton(path, load_model(path))
        except InputError as error:
            yield FolderButton(path, None, str(error))


def open_models(
    specs: Sequence[str],
    refused: list[str] | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[FDVVModel]:
    """Open every button that specs name; a folder stands for its model files, else for its measured files.

    refused : gains one line per file of a folder that cannot be used. A button named by itself must be
    usable: raises InputError. progress : called after every file of a folder.
    """
    models: list[FDVVModel] = []
    for spec in specs:
        if not spec or not Path(spec).is_dir():
            models.append(open_button(spec))
            continue
        files = button_files(Path(spec))
        for done, button in enumerate(open_files(files), start=1):
            progress(done, len(files))
            if button.model:
                models.append(button.model)
            elif refused is not None:
                refused.append(button.reason)
    return models


PART = re.compile(r"(?P<file>.+?)(?::(?P<stroke>press|release))?(?:@(?P<velocity>[0-9.eE+-]+))?")


def open_part(spec: str) -> FDVVModel:
    """Open a part: a button, cut to one stroke and to one velocity if asked.

    Of several curves of a stroke the one measured at that velocity is taken; a single one is declared to be
    of it. Raises InputError, also where none of several is of that velocity.
    """
    if Path(spec).is_file():
        # a file that is there under the whole name is meant, however its name reads
        return open_button(spec)
    found = PART.fullmatch(spec)
    if found is None:
        reason = "is not FILE[:press|:release][@VELOCITY]"
        raise InputError(spec or "''", "argument", reason, "write it that way")
    model = open_button(found["file"])
    curves = model.of(found["stroke"]) if found["stroke"] else model.curves
    if not curves:
        reason = f"the button has no {found['stroke']} curve"
        raise InputError(spec, "argument", reason, "name the other stroke")
    vibrations = model.vibrations
    if found["velocity"]:
        velocity_mm_s = _velocity(spec, found["velocity"])
        if len({curve.stroke for curve in curves}) < len(curves):
            curves = _chosen(curves, velocity_mm_s, spec)
            vibrations = tuple(v for v in vibrations if v.velocity_mm_s in (None, velocity_mm_s))
        else:
            curves = _declared(curves, velocity_mm_s)
    strokes = {curve.stroke for curve in curves}
    return replace(model, curves=curves, vibrations=tuple(v for v in vibrations if v.stroke in strokes))


def _velocity(spec: str, text: str) -> float:
    try:
        velocity_mm_s = float(text)
    except ValueError:
        velocity_mm_s = 0.0
    if not 0 < velocity_mm_s < float("inf"):
        raise InputError(spec, "velocity", f"{text!r} is not a speed above 0 mm/s", "write e.g. @50")
    return velocity_mm_s


def _chosen(curves: tuple[ForceCurve, ...], velocity_mm_s: float, spec: str) -> tuple[ForceCurve, ...]:
    found = tuple(c for c in curves if c.velocity_mm_s == velocity_mm_s)
    if not found:
        speeds = sorted({c.velocity_mm_s for c in curves if c.velocity_mm_s is not None})
        reason = f"the button has no curve of {velocity_mm_s:g} mm/s"
        listed = ", ".join(f"@{speed:.12g}" for speed in speeds)
        raise InputError(spec, "velocity", reason, f"choose one of {listed}")
    return found


def _declared(curves: tuple[ForceCurve, ...], velocity_mm_s: float) -> tuple[ForceCurve, ...]:
    # a spread between presses at another speed says nothing about this one
    measured = (None, velocity_mm_s)
    return tuple(
        replace(c, velocity_mm_s=velocity_mm_s, spread=c.spread if c.velocity_mm_s in measured else None)
        for c in curves
    )


def merge_parts(
    specs: Sequence[str],
    name: str,
    travel_mm: float | None = None,
    actuation_mm: float | None = None,
    reset_mm: float | None = None,
    conflict: Conflict | str = Conflict.REFUSE,
) -> FDVVModel:
    """Merge parts into one FDVV model; where they differ in a point, it must be given.

    conflict : what becomes of two different curves of one stroke and velocity.
    Raises InputError, ModelError.
    """
    parts = [open_part(spec) for spec in specs]
    _check_velocities(specs, parts)
    return merge(
        parts, name, conflict=conflict, travel_mm=travel_mm, actuation_mm=actuation_mm, reset_mm=reset_mm
    )


def _check_velocities(specs: Sequence[str], parts: Sequence[FDVVModel]) -> None:
    for stroke in Stroke:
        curves = [(spec, curve) for spec, part in zip(specs, parts, strict=True) for curve in part.of(stroke)]
        unknown = [spec for spec, curve in curves if curve.velocity_mm_s is None]
        if unknown and len(unknown) < len(curves):
            reason = f"its {stroke} is of unknown velocity, but other parts have a {stroke} too"
            raise InputError(unknown[0], "velocity", reason, f"tell it: {unknown[0]}@VELOCITY in mm/s")


def one_curve(spec: str) -> ForceCurve:
    """Open a part that is a single curve. Raises InputError if it is more."""
    curves = open_part(spec).curves
    if len(curves) != 1:
        listed = ", ".join(f"{c.stroke} at {c.velocity_mm_s or 'unknown'} mm/s" for c in curves)
        reason = f"holds {len(curves)} curves ({listed}), one is needed"
        strokes = {curve.stroke for curve in curves}
        several = len(strokes) < len(curves)
        missing = [":press or :release"] * (len(strokes) > 1) + ["the velocity, as @50"] * several
        raise InputError(spec, "argument", reason, f"add {' and '.join(missing)}")
    return curves[0]
