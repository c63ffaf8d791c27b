"""What a library keeps of each file: the columns of its table with types and meaning, and sampled curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
import numpy.typing as npt

from fdvv.button.kind import ButtonType
from fdvv.button.like import Sketch
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv_studio.library.row import ButtonRow, CACHE_version, Origin

if TYPE_CHECKING:
    from pyarrow import Schema, Table


KEPT_STEP_mm = 0.02
"""Of the curves: that over which the force of a measured file is averaged before its figures are read."""

MOST_points = 2000  # 40 mm at KEPT_STEP_mm, ten times the travel of a key; 8 kB a curve


class SampledCurve(msgspec.Struct, frozen=True):
    """Force of one stroke at one speed, evenly sampled; contact is at 0.

    velocity_mm_s : None if the file tells none.
    force_cN : at start_mm + i step_mm, (n,), single precision.
    """

    stroke: str
    velocity_mm_s: float | None
    start_mm: float
    step_mm: float
    force_cN: npt.NDArray[np.float32]

    def curve(self) -> ForceCurve:
        x = self.start_mm + self.step_mm * np.arange(self.force_cN.size)
        knots = np.concatenate([x[:1], x, x[-1:]])
        return ForceCurve(Stroke(self.stroke), self.velocity_mm_s, 1, knots, self.force_cN.astype(np.float64))


class LibraryRecord(msgspec.Struct, frozen=True):
    """One file. Without a row it is refused if there is a reason, else a file of fdvv's that is no button.

    id, place, stamp, pair, sha256, format, warnings : as in the library's columns.
    """

    id: str
    place: str
    stamp: str
    pair: str | None = None
    sha256: str | None = None
    row: ButtonRow | None = None
    reason: str = ""
    format: str = ""
    warnings: tuple[str, ...] = ()
    curves: tuple[SampledCurve, ...] = ()

    @property
    def state(self) -> str:
        return "button" if self.row else "refused" if self.reason else "other"


def sample(model: FDVVModel) -> tuple[SampledCurve, ...]:
    """Sample every curve of a model from its beginning to its end, about every 20 um."""
    samples = []
    for curve in model.curves:
        length = curve.end_mm - curve.start_mm
        points = int(np.clip(round(length / KEPT_STEP_mm) + 1, 2, MOST_points))
        x = np.linspace(curve.start_mm, curve.end_mm, points)
        force_cN = curve.force_cN(x).astype(np.float32)
        place = (str(curve.stroke), curve.velocity_mm_s, float(x[0]), length / (points - 1))
        samples.append(SampledCurve(*place, force_cN))
    return tuple(samples)


FORMAT, VERSION = "fdvv-library", 1
TEXTS, WHOLES = "list<string>", "list<int16>"
CURVES = "list<curve>"


@dataclass(frozen=True)
class Column:
    """A column: its name with its unit, its type and what it holds."""

    name: str
    type: str
    meaning: str


COLUMNS = (
    Column("id", "string", "measured: and 16 hexadecimal digits of a hash of the place"),
    Column("place", "string", "path of the file below the folder, the folder's name before it"),
    Column("stamp", "string", "size in bytes and time of change in ns of the file, and of its pair"),
    Column("pair", "string", "name of the file that holds the other stroke; null if there is none"),
    Column("sha256", "string", "of the file's bytes, followed by those of its pair"),
    Column("state", "string", "button, refused, or other: a file of fdvv's that is no button"),
    Column("reason", "string", "why it was refused, else null; what follows is null unless it is a button"),
    Column("name", "string", "of the button"),
    Column("collection", "string", "folder of the file"),
    Column("format", "string", "how the file was read; fdvv-model for a model"),
    Column("stated", TEXTS, "words of maker or measurer in name, folder or table, as silent; not measured"),
    Column("kind", "string", "linear, tactile, clicky?, dome? or unclear, by the force alone"),
    Column("kind_reason", "string", "what is stated, how often such a curve is right, and by which fact"),
    Column("peak_cN", "double", "force at the top of the bump of the press"),
    Column("peak_mm", "double", "and where that is"),
    Column("valley_cN", "double", "force at the bottom of that bump"),
    Column("valley_mm", "double", "and where that is"),
    Column("drop_cN", "double", "fall of force between them"),
    Column("snap_ratio", "double", "that fall as a share of the peak"),
    Column("release_drop_cN", "double", "fall of force of the bump of the release"),
    Column("actuation_mm", "double", "where the electrical contact closes on the press"),
    Column("actuation_cN", "double", "force there"),
    Column("reset_mm", "double", "where it opens on the release"),
    Column("preload_cN", "double", "force just after contact with the cap"),
    Column("bottom_out_cN", "double", "force at the end of the travel"),
    Column("travel_mm", "double", "from contact with the cap to the stop"),
    Column("pre_slope_cN_mm", "double", "slope of the press before the bump"),
    Column("post_slope_cN_mm", "double", "slope of the press after it"),
    Column("work_mJ", "double", "work of the press"),
    Column("loss_mJ", "double", "of it, what the release does not give back"),
    Column("speeds_mm_s", "list<double>", "known speeds of the presses, rising; empty if none is reported"),
    Column("cycles", "int32", "presses in the file; null for a model"),
    Column("used", "int32", "presses whose mean the figures are of; null for a model"),
    Column("date", "string", "ISO day on which the file was last changed"),
    Column("source", "string", "as a model file states it; empty for a measured file"),
    Column("licence", "string", "as a model file states it; empty for a measured file"),
    Column("simulated", "bool", "whether the numbers come from the twin"),
    Column("why", TEXTS, "reasons of the figures that are null, each beginning with its subject"),
    Column("warnings", TEXTS, "what was repaired, left out or not found"),
    Column("press_dcN", WHOLES, "slowest press, 64 forces evenly from 0 to travel_mm, tenths of a cN"),
    Column("release_dcN", WHOLES, "its release likewise; empty if the file holds none"),
    Column("curves", CURVES, "every stroke and speed: force_cN[i] at start_mm + i step_mm, float"),
)
"""Columns of a library's table."""

_SKETCH = {"press_dcN", "release_dcN"}
ROW_NAMES = tuple(f for f in ButtonRow.__struct_fields__ if f not in ("origin", "sketch"))
READ_NAMES = ("place", "state", *ROW_NAMES, *sorted(_SKETCH))
"""The columns of which rows are made again."""


@cache
def library_schema() -> Schema:
    """Return the schema; its metadata says which files hold rows of this meaning."""
    import pyarrow as pa

    curve = pa.struct(
        [
            ("stroke", pa.string()), ("velocity_mm_s", pa.float64()), ("start_mm", pa.float64()),
            ("step_mm", pa.float64()), ("force_cN", pa.list_(pa.float32())),
        ]
    )  # fmt: skip
    types = {
        "string": pa.string(), "double": pa.float64(), "int32": pa.int32(), "bool": pa.bool_(),
        "list<double>": pa.list_(pa.float64()), TEXTS: pa.list_(pa.string()),
        WHOLES: pa.list_(pa.int16()), CURVES: pa.list_(curve),
    }  # fmt: skip
    said = {"format": FORMAT, "version": str(VERSION), "rows": str(CACHE_version)}
    return pa.schema([(column.name, types[column.type]) for column in COLUMNS], metadata=said)


def table_of(records: Sequence[LibraryRecord]) -> Table:
    import pyarrow as pa

    return pa.Table.from_pylist([_line(record) for record in records], library_schema())


def _line(record: LibraryRecord) -> dict[str, Any]:
    names = ("id", "place", "stamp", "pair", "sha256", "state")
    line: dict[str, Any] = {name: getattr(record, name) for name in names}
    line["reason"] = record.reason or None
    row = record.row
    if row is None:
        return line
    line |= {name: getattr(row, name) for name in ROW_NAMES}
    line |= {name: getattr(row.sketch, name) for name in _SKETCH}
    line |= {"kind": str(row.kind), "format": record.format, "warnings": record.warnings}
    line["curves"] = [msgspec.structs.asdict(curve) for curve in record.curves]
    return line


def rows_of(table: Table) -> list[tuple[str, ButtonRow]]:
    """Make rows of a table with READ_NAMES, each with its place; files without a button are left out."""
    columns = {name: table.column(name).to_pylist() for name in ("place", "state", *ROW_NAMES)}
    sketches = zip(*(_tuples(table, name) for name in ("press_dcN", "release_dcN")), strict=True)
    rows = []
    for i, sketch in enumerate(sketches):
        if columns["state"][i] != "button":
            continue
        values = {name: columns[name][i] for name in ROW_NAMES}
        for name in ("stated", "speeds_mm_s", "why"):
            values[name] = tuple(values[name])
        values["kind"] = ButtonType(values["kind"])
        rows.append(
            (columns["place"][i], ButtonRow(origin=Origin.MEASURED, sketch=Sketch(*sketch), **values))
        )
    return rows


def _tuples(table: Table, name: str) -> list[tuple[int, ...]]:
    """Return lists of integers; by way of one array, which is ten times as fast as value by value."""
    tuples = []
    for chunk in table.column(name).chunks:
        values, ends = chunk.flatten().to_numpy(zero_copy_only=False).tolist(), [0]
        ends += chunk.value_lengths().fill_null(0).to_numpy().cumsum().tolist()
        tuples += [tuple(values[a:b]) for a, b in pairwise(ends)]
    return tuples


def curves_of(line: dict[str, Any]) -> tuple[SampledCurve, ...]:
    curves = line["curves"] or ()
    return tuple(SampledCurve(**c | {"force_cN": np.array(c["force_cN"], dtype=np.float32)}) for c in curves)
