"""The ``*.fdvv.json`` file: versioned plain JSON with a published schema.

Numbers are written with the shortest digits that read back to the same bits, one curve's numbers to a
line, so that a round trip is exact and a diff shows which curve changed.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import msgspec

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError, ModelError
from fdvv.files import read_limited, write_atomic
from fdvv.model._curve import ForceCurve, Stroke
from fdvv.model._model import FDVVModel, Provenance
from fdvv.model._records import FORMAT, VERSION, ModelRecord, ModeRecord
from fdvv.model._spread_records import written
from fdvv.model._velocity import Interpolation
from fdvv.model._vibration import Mode, Vibration

SUFFIX = ".fdvv.json"
"""How a model file's name ends."""
LIMIT_bytes = 64_000_000
"""Far above any button (a curve takes some 400 bytes), far below what would fill a machine's memory."""

_REMEDY = "compare with docs/reference/model-file.md, or fit the measurement again"
_KIND = Kind(FORMAT, VERSION, "an FDVV model", _REMEDY, oldest=1)
_POINTS = ("travel_spread", "actuation_spread", "reset_spread")
_CHOICES = {"stroke": Stroke, "interpolation": Interpolation}


def model_to_json(model: FDVVModel) -> str:
    """Write a model as the text of a ``*.fdvv.json`` file, of version 1 unless it tells of spreads."""
    record = {
        "format": FORMAT,
        "version": VERSION if _has_spreads(model) else 1,
        "name": model.name,
        "travel_mm": model.travel_mm,
        "actuation_mm": model.actuation_mm,
        "reset_mm": model.reset_mm,
        "interpolation": str(model.interpolation),
        "curves": [
            {
                "stroke": str(c.stroke),
                "velocity_mm_s": c.velocity_mm_s,
                "degree": c.degree,
                "knots_mm": c.knots_mm.tolist(),
                "control_points_cN": c.control_points_cN.tolist(),
                **written(c.spread),
            }
            for c in model.curves
        ],
        "vibrations": [
            {
                "stroke": str(v.stroke),
                "velocity_mm_s": v.velocity_mm_s,
                "onset_mm": v.onset_mm,
                "duration_s": v.duration_s,
                "modes": [msgspec.to_builtins(ModeRecord(**vars(mode))) for mode in v.modes],
                **written(v.spread),
            }
            for v in model.vibrations
        ],
        "provenance": {**vars(model.provenance), "assumptions": list(model.provenance.assumptions)},
    }
    for name in _POINTS:
        record |= written(getattr(model, name), name)
    return pretty(record) + "\n"


def _has_spreads(model: FDVVModel | ModelRecord) -> bool:
    parts = (*model.curves, *model.vibrations)
    return any(getattr(model, name) for name in _POINTS) or any(part.spread for part in parts)


def model_from_json(text: str | bytes, source: object = "model") -> FDVVModel:
    """Read a model from the text of a ``*.fdvv.json`` file.

    Raises InputError that names source, the place in it and the remedy: not JSON, another format or
    version, a missing or unknown field, numbers that make no spline.
    """
    return read_document(
        text,
        source,
        _KIND,
        lambda data: _model(msgspec.json.decode(data, type=ModelRecord), source),
        _choices,
    )


def _choices(place: str) -> Iterable[str] | None:
    return _CHOICES.get(place.rpartition(".")[2])


def _model(record: ModelRecord, source: object) -> FDVVModel:
    """Build the model from a record of the right shape; each failure names its place."""
    if record.version == 1 and _has_spreads(record):
        raise InputError(
            source, "$.version", "a file of version 1 has no spreads", "write 2, or take them out"
        )
    place = "$"
    try:
        curves = []
        for i, c in enumerate(record.curves):
            place = f"$.curves[{i}]"
            curves.append(
                ForceCurve(
                    c.stroke,
                    c.velocity_mm_s,
                    c.degree,
                    c.knots_mm,  # type: ignore[arg-type]
                    c.control_points_cN,  # type: ignore[arg-type]
                    c.spread.read() if c.spread else None,
                )
            )
        vibrations = []
        for i, v in enumerate(record.vibrations):
            place = f"$.vibrations[{i}]"
            modes = tuple(Mode(**msgspec.to_builtins(mode)) for mode in v.modes)
            spread = v.spread.read() if v.spread else None
            vibrations.append(Vibration(v.stroke, v.velocity_mm_s, v.onset_mm, v.duration_s, modes, spread))
        place = "$"
        fields = msgspec.to_builtins(record.provenance)
        told = {name: getattr(record, name) for name in _POINTS}
        return FDVVModel(
            name=record.name,
            travel_mm=record.travel_mm,
            curves=tuple(curves),
            actuation_mm=record.actuation_mm,
            reset_mm=record.reset_mm,
            vibrations=tuple(vibrations),
            interpolation=record.interpolation,
            provenance=Provenance(**{**fields, "assumptions": tuple(fields["assumptions"])}),
            **{name: found.read() if found else None for name, found in told.items()},
        )
    except ModelError as error:
        raise InputError(source, place, str(error), _REMEDY) from error


def save_model(model: FDVVModel, path: Path | str) -> None:
    """Write a model to a ``*.fdvv.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), model_to_json(model))


def load_model(path: Path | str) -> FDVVModel:
    """Read a model from a ``*.fdvv.json`` file. Raises InputError, also where the file cannot be read."""
    return model_from_json(read_limited(path, LIMIT_bytes, "pass a model file"), path)
