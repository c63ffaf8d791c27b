"""The ``*.fdvv.json`` file: versioned plain JSON with a published schema.

Numbers are written with the shortest digits that read back to the same bits, one curve's numbers to a
line, so that a round trip is exact and a diff shows which curve changed.
"""

from __future__ import annotations

from dataclasses import Field
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv.io.documents import Head, Kind, Layout, decode, document, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Vibration

FORMAT = "fdvv-model"

VERSION = 2
"""Of a file with spreads; one without is of version 1, which had no place for them."""

MODEL_SUFFIX = ".fdvv.json"
"""How a model file's name ends."""

LIMIT_bytes = 64_000_000
"""Far above any button (a curve takes some 400 bytes), far below what would fill a machine's memory."""

_REMEDY = "compare with docs/reference/model-file.md, or fit the measurement again"

_KIND = Kind(FORMAT, VERSION, "an FDVV model", _REMEDY, oldest=1)

_SPREADS = ("travel_spread", "actuation_spread", "reset_spread")
_ACHIEVED = ("achieved_mm_s", "achieved_spread_mm_s")

LAYOUT = Layout(
    # a line of numbers is easier to read after their count
    last=("curves", "vibrations", "provenance", *_SPREADS, "displacement_mm", "spread_cN", *_ACHIEVED),
    needed=("actuation_mm", "reset_mm", "interpolation"),
)

_CHOICES = {"stroke": Stroke, "interpolation": Interpolation}


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file format, as published in docs/reference/fdvv.schema.json."""
    from fdvv.io.schema import schema_of

    return schema_of(FDVVModel, _KIND, LAYOUT)


def model_to_json(model: FDVVModel) -> str:
    """Write a model as the text of a ``*.fdvv.json`` file, of version 1 unless it holds spreads."""
    version = VERSION if _has_spreads(model) else 1
    return pretty(document(model, _KIND, version, layout=LAYOUT, keep=_is_written)) + "\n"


def _is_written(field: Field[Any], value: object) -> bool:
    """Leave out the spreads that are not known, for which files of version 1 had no place."""
    return value is not None or not field.name.endswith("spread")


def _has_spreads(model: FDVVModel) -> bool:
    parts: tuple[ForceCurve | Vibration, ...] = (*model.curves, *model.vibrations)
    return any(getattr(model, name) for name in _SPREADS) or any(part.spread for part in parts)


def model_from_json(text: str | bytes, source: object = "model") -> FDVVModel:
    """Read a model from the text of a ``*.fdvv.json`` file.

    Raises InputError that names source, the place in it and the remedy: not JSON, another format or
    version, a missing or unknown field, numbers that make no spline.
    """
    return read_document(
        text,
        source,
        _KIND,
        lambda data: _model(data, source),
        lambda place: _CHOICES.get(place.rpartition(".")[2]),
    )


def _model(data: bytes, source: object) -> FDVVModel:
    model = decode(data, FDVVModel, LAYOUT)
    if _has_spreads(model) and msgspec.json.decode(data, type=Head).version == 1:
        reason, remedy = "a file of version 1 has no spreads", "write 2, or take them out"
        raise InputError(source, "$.version", reason, remedy)
    return model


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
