"""The ``*.fdvv.json`` file: versioned plain JSON with a published schema.

Numbers are written with the shortest digits that read back to the same bits, one curve's numbers to a
line, so that a round trip is exact and a diff shows which curve changed.
"""

from __future__ import annotations

from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_document, tidy_schema
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpreadRecord, PointSpreadRecord, VibrationSpreadRecord
from fdvv.model.velocity import Interpolation

FORMAT = "fdvv-model"

VERSION = 2
"""Of a file with spreads; one without is of version 1, which had no place for them."""

Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]
StrokeName = Annotated[Stroke, Meta(description="press or release")]


class CurveRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Force on displacement for one stroke at one velocity, as a clamped B-spline."""

    stroke: StrokeName
    velocity_mm_s: Annotated[
        Positive | None,
        Meta(description="mean speed of the stroke, mm/s; null if unknown, and then the stroke's only curve"),
    ]
    degree: Annotated[int, Meta(ge=1, le=5, description="polynomial degree k")]
    knots_mm: Annotated[
        list[float],
        Meta(
            min_length=4,
            description="n + k + 1 knots, mm, not falling; the first and last k + 1 equal, the curve's ends",
        ),
    ]
    control_points_cN: Annotated[
        list[float], Meta(min_length=2, description="n coefficients, cN, one per basis function")
    ]
    spread: Annotated[
        CurveSpreadRecord | None, Meta(description="between presses; null or absent if not measured")
    ] = None


class ModeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One sinusoid of the cap's acceleration, amplitude exp(-decay t) sin(2 pi frequency t + phase)."""

    frequency_Hz: Annotated[float, Meta(gt=0, description="frequency, Hz")]
    amplitude_m_s2: Annotated[float, Meta(description="acceleration at the onset, m/s²")]
    decay_1_s: Annotated[float, Meta(ge=0, description="decay, 1/s")]
    phase_rad: Annotated[float, Meta(description="phase at the onset, rad")] = 0.0


class VibrationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The vibration of one stroke at one velocity."""

    stroke: StrokeName
    velocity_mm_s: Annotated[
        Positive | None, Meta(description="speed it was found at, mm/s; null if it serves every speed")
    ]
    onset_mm: Annotated[float, Meta(description="displacement at which it starts, mm")]
    duration_s: Annotated[float, Meta(gt=0, description="length, s; the signal is zero after it")]
    modes: Annotated[list[ModeRecord], Meta(min_length=1, description="the sinusoids that add up to it")]
    spread: Annotated[
        VibrationSpreadRecord | None, Meta(description="between presses; null or absent if not measured")
    ] = None


class ProvenanceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Where the model comes from."""

    source: Annotated[str, Meta(description="the button and who measured it")] = ""
    licence: Annotated[str, Meta(description="of the measurements, as their publisher states it")] = ""
    citation: Annotated[str, Meta(description="how to credit it")] = ""
    method: Annotated[str, Meta(description="how the curves were made from the source, and edits since")] = ""
    assumptions: Annotated[list[str], Meta(description="what no measurement backs, one sentence each")] = []
    simulated: Annotated[bool, Meta(description="whether the numbers come from the twin")] = False


class ModelRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A button as force over displacement and velocity, with its vibration (FDVV)."""

    format: Annotated[Literal["fdvv-model"], Meta(description="tells the file from other JSON")]
    version: Annotated[Literal[1, 2], Meta(description="of this format; 2 if the file tells of spreads")]
    name: Annotated[str, Meta(min_length=1, description="short, as a file would be called")]
    travel_mm: Annotated[float, Meta(gt=0, description="from first contact to bottom-out, mm")]
    actuation_mm: Annotated[
        NotNegative | None, Meta(description="where the contact closes on the press, mm; null if unknown")
    ]
    reset_mm: Annotated[
        NotNegative | None, Meta(description="where the contact opens on the release, mm; null if unknown")
    ]
    interpolation: Annotated[Interpolation, Meta(description="how force is found between the velocities")]
    curves: Annotated[
        list[CurveRecord], Meta(min_length=1, description="no two of one stroke and velocity; in any order")
    ]
    vibrations: Annotated[list[VibrationRecord], Meta(description="no two of one stroke and velocity")] = []
    provenance: Annotated[ProvenanceRecord, Meta(description="where the model comes from")] = msgspec.field(
        default_factory=ProvenanceRecord
    )
    travel_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of travel_mm; null or absent if not measured")
    ] = None
    actuation_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of actuation_mm; null or absent if not measured")
    ] = None
    reset_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of reset_mm; null or absent if not measured")
    ] = None


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file format, as published in docs/reference/fdvv.schema.json."""
    found = msgspec.json.schema(ModelRecord)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **tidy_schema(found)}


MODEL_SUFFIX = ".fdvv.json"
"""How a model file's name ends."""

LIMIT_bytes = 64_000_000
"""Far above any button (a curve takes some 400 bytes), far below what would fill a machine's memory."""

_REMEDY = "compare with docs/reference/model-file.md, or fit the measurement again"

_KIND = Kind(FORMAT, VERSION, "an FDVV model", _REMEDY, oldest=1)

_POINTS = ("travel_spread", "actuation_spread", "reset_spread")

_CHOICES = {"stroke": Stroke, "interpolation": Interpolation}


def model_to_json(model: FDVVModel) -> str:
    """Write a model as the text of a ``*.fdvv.json`` file, of version 1 unless it holds spreads."""
    head = {"format": FORMAT, "version": VERSION if _has_spreads(model) else 1}
    fields = head | msgspec.to_builtins(model, enc_hook=lambda array: array.tolist())
    return pretty(_written({name: fields[name] for name in ModelRecord.__struct_fields__})) + "\n"


def _written(value: Any) -> Any:
    """Leave out the spreads that are not known, for which files of version 1 had no place."""
    if isinstance(value, list | tuple):
        return [_written(item) for item in value]
    if not isinstance(value, dict):
        return value
    if "spread_cN" in value:  # of a curve: a line of numbers is easier to read after their count
        value = {"presses": value["presses"], **value}
    return {k: _written(v) for k, v in value.items() if not (v is None and k.endswith("spread"))}


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
        lambda place: _CHOICES.get(place.rpartition(".")[2]),
    )


def _model(record: ModelRecord, source: object) -> FDVVModel:
    if record.version == 1 and _has_spreads(record):
        reason, remedy = "a file of version 1 has no spreads", "write 2, or take them out"
        raise InputError(source, "$.version", reason, remedy)
    # a ModelError of a part comes out as msgspec's own error, with the place of that part
    return msgspec.convert(
        record, FDVVModel, from_attributes=True, dec_hook=lambda _, column: np.array(column)
    )


def save_model(model: FDVVModel, path: Path | str) -> None:
    """Write a model to a ``*.fdvv.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), model_to_json(model))


def load_model(path: Path | str) -> FDVVModel:
    """Read a model from a ``*.fdvv.json`` file. Raises InputError, also where the file cannot be read."""
    return model_from_json(read_limited(path, LIMIT_bytes, "pass a model file"), path)


def _files() -> dict[str, Traversable]:
    folder = resources.files("fdvv.model").joinpath("builtin")
    return {f.name.removesuffix(MODEL_SUFFIX): f for f in folder.iterdir() if f.name.endswith(MODEL_SUFFIX)}


def builtin_names() -> tuple[str, ...]:
    """Return the names of the built-in models, sorted."""
    return tuple(sorted(_files()))


def load_builtin(name: str) -> FDVVModel:
    """Read a built-in model. Raises InputError that lists the names."""
    files = _files()
    if name not in files:
        remedy = f"use one of: {', '.join(sorted(files))}"
        raise InputError("built-in model", "name", f"no model is called {name!r}", remedy)
    return model_from_json(files[name].read_bytes(), files[name].name)
