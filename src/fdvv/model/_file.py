"""The ``*.fdvv.json`` file: versioned plain JSON with a published schema.

Numbers are written with the shortest digits that read back to the same bits, one curve's numbers to a
line, so that a round trip is exact and a diff shows which curve changed.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from fdvv.errors import InputError, ModelError
from fdvv.files import write_atomic
from fdvv.model._curve import ForceCurve, Stroke
from fdvv.model._model import FDVVModel, Provenance
from fdvv.model._velocity import Interpolation
from fdvv.model._vibration import Mode, Vibration

FORMAT = "fdvv-model"
VERSION = 1
SUFFIX = ".fdvv.json"

Positive = Annotated[float, msgspec.Meta(gt=0)]
NotNegative = Annotated[float, msgspec.Meta(ge=0)]
StrokeName = Literal["press", "release"]


class CurveRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One B-spline force curve; velocity_mm_s is null if unknown."""

    stroke: StrokeName
    velocity_mm_s: Positive | None
    degree: Annotated[int, msgspec.Meta(ge=1, le=5)]
    knots_mm: list[float]
    control_points_cN: list[float]


class ModeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One decaying sinusoid of the cap's acceleration."""

    frequency_Hz: Positive
    amplitude_m_s2: float
    decay_1_s: NotNegative
    phase_rad: float = 0.0


class VibrationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The vibration of one stroke at one velocity; velocity_mm_s is null if it serves every speed."""

    stroke: StrokeName
    velocity_mm_s: Positive | None
    onset_mm: float
    duration_s: Positive
    modes: Annotated[list[ModeRecord], msgspec.Meta(min_length=1)]


class ProvenanceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Where the model comes from."""

    source: str = ""
    licence: str = ""
    citation: str = ""
    method: str = ""
    assumptions: list[str] = []
    simulated: bool = False


class ModelRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A button as force over displacement and velocity, with its vibration (FDVV)."""

    format: Literal["fdvv-model"]
    version: Literal[1]
    name: Annotated[str, msgspec.Meta(min_length=1)]
    travel_mm: Positive
    actuation_mm: NotNegative | None
    reset_mm: NotNegative | None
    interpolation: str
    curves: Annotated[list[CurveRecord], msgspec.Meta(min_length=1)]
    vibrations: list[VibrationRecord] = []
    provenance: ProvenanceRecord = msgspec.field(default_factory=ProvenanceRecord)


def schema() -> dict[str, Any]:
    """Give the JSON schema of the file format, as published in docs/reference/fdvv.schema.json."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(ModelRecord)}


def model_to_json(model: FDVVModel) -> str:
    """Write a model as the text of a ``*.fdvv.json`` file."""
    record = {
        "format": FORMAT,
        "version": VERSION,
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
            }
            for v in model.vibrations
        ],
        "provenance": {**vars(model.provenance), "assumptions": list(model.provenance.assumptions)},
    }
    return _pretty(record) + "\n"


def _pretty(value: object, indent: str = "") -> str:
    """Indent objects and lists of objects; keep a list of plain values on one line."""
    deeper = indent + "  "
    if isinstance(value, dict) and value:
        items = [f"{deeper}{json.dumps(k)}: {_pretty(v, deeper)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(v, dict | list) for v in value):
        return "[\n" + ",\n".join(deeper + _pretty(v, deeper) for v in value) + f"\n{indent}]"
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def model_from_json(text: str | bytes, source: object = "model") -> FDVVModel:
    """Read a model from the text of a ``*.fdvv.json`` file.

    Raises InputError that names source, the place in it and the remedy: not JSON, another format or
    version, a missing or unknown field, numbers that make no spline.
    """
    remedy = "compare with docs/reference/model-file.md, or fit the measurement again"
    try:
        head = msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(source, "whole file", f"not valid JSON ({error})", remedy) from error
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise InputError(source, "$.format", f'not an FDVV model ("format" must be "{FORMAT}")', remedy)
    if head.get("version") != VERSION:
        reason = f"file version {head.get('version')!r}, this fdvv reads version {VERSION}"
        raise InputError(source, "$.version", reason, "install a newer fdvv")
    try:
        return _model(msgspec.convert(head, ModelRecord), source, remedy)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at ")
        raise InputError(source, place.strip("`") or "$", reason, remedy) from error


def _model(record: ModelRecord, source: object, remedy: str) -> FDVVModel:
    """Build the model from a record of the right shape; each failure names its place."""
    place = "$"
    try:
        curves = []
        for i, c in enumerate(record.curves):
            place = f"$.curves[{i}]"
            curves.append(
                ForceCurve(Stroke(c.stroke), c.velocity_mm_s, c.degree, c.knots_mm, c.control_points_cN)  # type: ignore[arg-type]
            )
        vibrations = []
        for i, v in enumerate(record.vibrations):
            place = f"$.vibrations[{i}]"
            modes = tuple(Mode(**msgspec.to_builtins(mode)) for mode in v.modes)
            vibrations.append(Vibration(Stroke(v.stroke), v.velocity_mm_s, v.onset_mm, v.duration_s, modes))
        place = "$.interpolation"
        if record.interpolation not in list(Interpolation):
            names = ", ".join(Interpolation)
            raise ModelError(f"interpolation {record.interpolation!r} is not one of {names}")
        place = "$"
        fields = msgspec.to_builtins(record.provenance)
        return FDVVModel(
            name=record.name,
            travel_mm=record.travel_mm,
            curves=tuple(curves),
            actuation_mm=record.actuation_mm,
            reset_mm=record.reset_mm,
            vibrations=tuple(vibrations),
            interpolation=Interpolation(record.interpolation),
            provenance=Provenance(**{**fields, "assumptions": tuple(fields["assumptions"])}),
        )
    except ModelError as error:
        raise InputError(source, place, str(error), remedy) from error


def save_model(model: FDVVModel, path: Path | str) -> None:
    """Write a model to a ``*.fdvv.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), model_to_json(model))


def load_model(path: Path | str) -> FDVVModel:
    """Read a model from a ``*.fdvv.json`` file. Raises InputError, also where the file cannot be read."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        remedy = "check the path and its permissions"
        raise InputError(path, "whole file", error.strerror or str(error), remedy) from error
    return model_from_json(content, path)
