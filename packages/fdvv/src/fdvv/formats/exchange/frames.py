"""Recordings and presses as tables of pandas and labelled arrays of xarray; units stand with every column."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import BuildError, ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.recording.types import UNITS, Recording, Stream, Take
from fdvv.units import FloatArray

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

CF = {"m/s2": "m s-2"}
"""Units as CF's conventions write them, where they differ from ours."""
COLUMNS = ("take", "stage", "velocity_mm_s", "stream", "axis", "quantity", "unit", "clock", "t_s", "value")
PRESS_UNITS = {"t_s": "s", "velocity_mm_s": "mm s-1", "displacement_mm": "mm", "force_cN": "cN"}
RIG_UNITS = {"sensed_mm": "mm", "sensed_cN": "cN", "commanded_cN": "cN"}
FLAGS = ("saturated", "tick")
STEP_mm = 0.01
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What makes a spreadsheet run a cell; a name that begins so is set off with an apostrophe."""


def require_frames() -> None:
    """Raise BuildError with the install command unless pandas and xarray are installed."""
    try:
        import pandas  # noqa: F401
        import xarray  # noqa: F401
    except ImportError as error:
        raise BuildError(
            'tables need pandas and xarray; install them with: pip install "fdvv[frames]"'
        ) from error


def recording_to_pandas(recording: Recording) -> pd.DataFrame:
    """Return a recording as one long table, a row for each sample of each stream.

    Columns: take, stage, velocity_mm_s (what was asked for), stream, axis (x, y, z of a marker, else empty),
    quantity, unit, clock, t_s, value in that unit. ``attrs`` hold name, person, licence and whether it is
    simulated. Times of different clocks cannot be compared. Raises BuildError without pandas.
    """
    require_frames()
    import pandas as pd

    rows = [
        pd.DataFrame(dict(zip(COLUMNS, (*about, stream.t_s, values), strict=True)))
        for about, stream, values in _series(recording)
    ]
    table = pd.concat(rows, ignore_index=True) if rows else pd.DataFrame(columns=COLUMNS)
    labels = [name for name in COLUMNS if name not in ("take", "velocity_mm_s", "t_s", "value")]
    table = table.astype(dict.fromkeys(labels, "category"))
    table.attrs = {**_about(recording), "units": {"velocity_mm_s": "mm s-1", "t_s": "s"}}
    return table


def _series(recording: Recording) -> Iterator[tuple[tuple[Any, ...], Stream, FloatArray]]:
    """Return the first eight COLUMNS, stream and values of every stream, of a marker for each axis."""
    for take in recording.takes:
        velocity_mm_s = np.nan if take.velocity_mm_s is None else float(take.velocity_mm_s)
        for stream in take.streams:
            what = (str(stream.quantity), UNITS[stream.quantity], stream.clock)
            for axis, values in zip(_axes(stream), np.atleast_2d(stream.values.T), strict=True):
                yield (take.number, str(take.stage), velocity_mm_s, stream.name, axis, *what), stream, values


def _axes(stream: Stream) -> list[str]:
    if stream.raw.ndim == 1:
        return [""]
    count = stream.raw.shape[1]
    return ["x", "y", "z"] if count == 3 else [str(i) for i in range(count)]


def recording_to_xarray(recording: Recording) -> xr.DataTree:
    """Return a recording as a tree: a node ``take_1`` … for each take, a variable for each stream.

    Streams run on their own clocks, so each has a time dimension of its own, ``t_STREAM`` in s with its
    clock in the attributes; a marker has a second one, ``axis_STREAM``. Values have their units in
    ``attrs["units"]``; marks are in the node's attributes, ``mark_NAME`` with their times. Raises
    BuildError without xarray, ModelError if two streams of a take would get one name.
    """
    require_frames()
    import xarray as xr

    takes = {f"take_{take.number}": _take(take) for take in recording.takes}
    return xr.DataTree.from_dict({"/": xr.Dataset(attrs=_about(recording)), **takes})


def _take(take: Take) -> xr.Dataset:
    import xarray as xr

    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    for stream in take.streams:
        # a slash would be a node of the tree
        name = stream.name.replace("/", "_")
        time = f"t_{name}"
        about = {"units": "s", "long_name": f"time of {stream.name}", "clock": stream.clock}
        coordinates[time] = (time, stream.t_s, about)
        shape: tuple[str, ...] = (time,)
        if stream.raw.ndim == 2:
            shape = (time, f"axis_{name}")
            coordinates[shape[1]] = _axes(stream)
        unit = UNITS[stream.quantity]
        attrs: dict[str, Any] = {"units": CF.get(unit, unit), "long_name": stream.name}
        attrs |= {"quantity": str(stream.quantity), "clock": stream.clock}
        variables[name] = (shape, stream.values, {**attrs, "scale": stream.scale, "zero": stream.zero})
    if len(variables) < len(take.streams) or set(variables) & set(coordinates):
        names = ", ".join(stream.name for stream in take.streams)
        raise ModelError(f"take {take.number}: rename one of the streams {names}, they would share a name")
    attributes: dict[str, Any] = {"number": take.number, "stage": str(take.stage), "remark": take.remark}
    attributes |= {"made": take.made, "velocity_units": "mm s-1"}
    attributes["velocity"] = np.nan if take.velocity_mm_s is None else take.velocity_mm_s
    for mark in sorted(take.marks, key=lambda mark: (mark.name, mark.clock, mark.t_s)):
        attributes.setdefault(f"mark_{mark.name} ({mark.clock}, s)", []).append(mark.t_s)
    return xr.Dataset(variables, coordinates, attributes)


def _about(recording: Recording) -> dict[str, Any]:
    return {
        "name": recording.name,
        "person": recording.person,
        "licence": recording.licence,
        "simulated": int(recording.simulated),
    }


def presses_to_pandas(presses: Sequence[Press]) -> pd.DataFrame:
    """Return presses as one table, a row for each sample, the press counted from 0 in column ``press``.

    Columns are those of Press, units in their names and in ``attrs["units"]``; what a press has not (no
    rig) is missing. Raises BuildError without pandas.
    """
    require_frames()
    import pandas as pd

    parts = []
    for number, press in enumerate(presses):
        part = pd.DataFrame({"press": number, "velocity_mm_s": press.velocity_mm_s, "t_s": press.t_s})
        for name in ("displacement_mm", "force_cN", *RIG_UNITS):
            column = getattr(press, name)
            part[name] = np.nan if column is None else column
        for name in FLAGS:
            column = getattr(press, name)
            part[name] = pd.array([pd.NA] * press.t_s.size if column is None else column, dtype="boolean")
        part["simulated"] = press.simulated
        parts.append(part)
    names = ["press", "velocity_mm_s", "t_s", "displacement_mm", "force_cN", *RIG_UNITS, *FLAGS, "simulated"]
    table = pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=names)
    table.attrs["units"] = PRESS_UNITS | RIG_UNITS
    return table


def presses_from_pandas(table: pd.DataFrame) -> tuple[Press, ...]:
    """Make presses of a table that presses_to_pandas gave, or of one with its columns.

    Columns of the rig may lack or be empty. Raises ModelError for a table without the others.
    """
    lacking = {"press", *PRESS_UNITS} - set(table.columns)
    if lacking:
        raise ModelError(f"the table lacks columns: {', '.join(sorted(lacking))}")
    return tuple(_press(part) for _, part in table.groupby("press", sort=True))


def _press(part: pd.DataFrame) -> Press:
    there = part.notna()
    optional: dict[str, Any] = {
        **{n: part[n].to_numpy(dtype=np.float64) for n in RIG_UNITS if n in part and there[n].any()},
        # a flag has no third value for a sample that lacks it
        **{n: part[n].to_numpy(dtype=np.bool_) for n in FLAGS if n in part and there[n].all()},
    }
    simulated = "simulated" in part.columns and bool(part["simulated"].iloc[0])
    t_s, x, force = (part[n].to_numpy(dtype=np.float64) for n in ("t_s", "displacement_mm", "force_cN"))
    return Press(t_s, x, force, float(part["velocity_mm_s"].iloc[0]), **optional, simulated=simulated)


def model_to_xarray(
    model: FDVVModel, velocities_mm_s: Sequence[float] | None = None, step_mm: float = STEP_mm
) -> xr.Dataset:
    """Return a model as a dataset: ``force`` and ``stiffness`` over stroke, velocity and displacement.

    velocities_mm_s : by default those the model has curves at; a model of unknown velocity has the one
    coordinate NaN.
    Displacement goes in steps from 0 to the travel, its end included. Units are in ``attrs["units"]`` as CF's
    conventions write them; travel, contact points and provenance in the dataset's attributes. A stroke
    without curves is left out. Raises BuildError without xarray, ModelError for a step that is not positive.
    """
    require_frames()
    import xarray as xr

    if not (np.isfinite(step_mm) and step_mm > 0):
        raise ModelError(f"step_mm must be positive, got {step_mm}")
    strokes = [stroke for stroke in Stroke if model.of(stroke)]
    known = sorted({v for stroke in strokes for v in model.velocities_mm_s(stroke)})
    speeds = np.array(known or [np.nan] if velocities_mm_s is None else velocities_mm_s, dtype=np.float64)
    x = np.unique(np.append(np.arange(0.0, model.travel_mm, step_mm), model.travel_mm))
    # a curve of unknown velocity is the same at every speed
    grid = (x[np.newaxis], np.nan_to_num(speeds, nan=1.0)[:, np.newaxis])
    dimensions = ("stroke", "velocity", "displacement")
    force = np.stack([model.force_cN(*grid, stroke) for stroke in strokes])
    slope = np.stack([model.stiffness_cN_mm(*grid, stroke) for stroke in strokes])
    return xr.Dataset(
        {
            "force": (dimensions, force, {"units": "cN", "long_name": "force against the finger"}),
            "stiffness": (dimensions, slope, {"units": "cN mm-1", "long_name": "force over displacement"}),
        },
        {
            "stroke": [str(stroke) for stroke in strokes],
            "velocity": ("velocity", speeds, {"units": "mm s-1", "long_name": "mean speed of the stroke"}),
            "displacement": (
                "displacement",
                x,
                {"units": "mm", "long_name": "into the button, from contact"},
            ),
        },
        _about_model(model),
    )


def _about_model(model: FDVVModel) -> dict[str, Any]:
    of = model.provenance
    return {
        "name": model.name,
        "travel_mm": model.travel_mm,
        "actuation_mm": np.nan if model.actuation_mm is None else model.actuation_mm,
        "reset_mm": np.nan if model.reset_mm is None else model.reset_mm,
        "interpolation": str(model.interpolation),
        "source": of.source,
        "license": of.licence,
        "references": of.citation,
        "simulated": int(of.simulated),
        "Conventions": "CF-1.11",
    }


def recording_csv(recording: Recording) -> Exported:
    """Write a row for each sample of each stream, with its unit; a marker has a row for each axis.

    The columns are those of recording_to_pandas. Times of different clocks cannot be compared; what was not
    seen is an empty cell.
    """
    held = io.StringIO()
    writer = csv.writer(held, lineterminator="\n")
    writer.writerow(COLUMNS)
    for about, stream, values in _series(recording):
        number, stage, speed, name, axis, *what, clock = about
        head = [number, stage, _cell(speed), _plain(name), axis, *what, _plain(clock)]
        writer.writerows(
            [*head, repr(t), _cell(value)]
            for t, value in zip(stream.t_s.tolist(), values.tolist(), strict=True)
        )
    kept = ("every sample in its unit, with take, stage, pace and clock",)
    lost = ("marks, raw counts and calibration", "bench, sources and remarks")
    takes = recording.takes
    figures: dict[str, float | None] = {
        "samples": float(sum(stream.t_s.size for take in takes for stream in take.streams)),
        "lost_marks": float(sum(len(take.marks) for take in takes)),
    }
    return Exported("recording-csv", held.getvalue().encode(), kept, lost, figures)


def _cell(value: float) -> str:
    return "" if math.isnan(value) else repr(value)


def _plain(text: str) -> str:
    return f"'{text}" if text.startswith(FORMULA) else text
