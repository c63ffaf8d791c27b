"""From a file or a model to the row of the shelf."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from pathlib import Path

from fdvv.capture import ForceFile, read_force_file
from fdvv.errors import FdvvError, InputError
from fdvv.model import FDVVModel, Stroke, load_model
from fdvv.workflow._fit import MeasuredParts, measured_parts, one_line
from fdvv.workflow._kind import MODEL, own_kind
from fdvv.workflow._shelf_facts import figures_of, kind_of, polyline_model, reasons_of, sketch_of
from fdvv.workflow._shelf_row import Origin, ShelfRow

STATED = re.compile(
    r"\b(silent|linear|tactile|clicky|click|dome|topre|optical|magnetic|hall|low profile|speed)\b", re.I
)
LONGEST_name = 200


def row_of_file(path: Path, button_id: str, collection: str, origin: Origin = Origin.MEASURED) -> ShelfRow:
    """Read the row of a measured file, or of a model file in a folder of them. Raises InputError."""
    dated = datetime.fromtimestamp(path.stat().st_mtime, UTC).date().isoformat()
    if own_kind(path) == MODEL:
        return row_of_model(load_model(path), button_id, origin, collection, dated)
    model, parts = measured_button(path)
    return row_of_model(model, button_id, origin, collection, dated, parts)


def measured_button(path: Path) -> tuple[FDVVModel, MeasuredParts]:
    """Read a measured file as the polylines of its active strokes, unfitted. Raises InputError."""
    return button_of_file(read_force_file(path), path)


def button_of_file(file: ForceFile, path: Path) -> tuple[FDVVModel, MeasuredParts]:
    """Give what a file that was read holds as the polylines of its active strokes. Raises InputError."""
    try:
        parts = measured_parts(file)
        name = one_line(file.name)[:LONGEST_name].strip() or "unnamed"
        return polyline_model(parts, name), parts
    except InputError:
        raise
    except FdvvError as error:
        remedy = "check that the file holds one whole stroke from contact to the stop"
        raise InputError(path, "curve", str(error), remedy) from error


def row_of_model(
    model: FDVVModel,
    button_id: str,
    origin: Origin,
    collection: str = "",
    date: str | None = None,
    parts: MeasuredParts | None = None,
) -> ShelfRow:
    """Give the row of a model; parts tell how many presses a measured one is the mean of."""
    kind, figures = kind_of(model), figures_of(model)
    said = f"{model.name} {collection} {model.provenance.source}".replace("_", " ").replace("-", " ")
    return ShelfRow(
        id=button_id,
        name=model.name,
        origin=origin,
        collection=collection,
        stated=tuple(dict.fromkeys(word.lower() for word in STATED.findall(said))),
        kind=kind.kind,
        kind_reason=kind.reason,
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
