"""Traces of how deep a key was over time: drawn here, made by a simulated person, or read from a file."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.units import FloatArray

LARGEST_bytes = 4_000_000
LONGEST_s, DEEPEST_mm = 120.0, 10.0
FEWEST = 4
TIMES = {"t_s": 1.0, "time_s": 1.0, "t_ms": 1e-3, "time_ms": 1e-3, "unixtime": 1e-3}
"""Columns that hold time, and what turns them into seconds."""

PLACES = ("displacement_mm", "depth_mm", "travel_mm", "x_mm")
RATIO, KEY = "keyValue", "keyCode"
"""Columns of analogue keyboards: depth as a part of the travel, and which key."""

FULL_mm = 4.0
"""Travel that a part of it is taken of."""
STEP_s = 0.002
SILENT_s = 0.02
"""A keyboard that reports a key only while it moves: after such a silence it had not moved."""


@dataclass(frozen=True, eq=False)
class PressTrace:
    """How deep the cap of a key was.

    Attributes
    ----------
    name : for people. origin : where it comes from.
    t_s : (n,) rising from 0.
    displacement_mm : (n,) of the cap; 0 and above is up.
    """

    name: str
    origin: str
    t_s: FloatArray
    displacement_mm: FloatArray

    def __post_init__(self) -> None:
        t, x = (np.ascontiguousarray(c, dtype=np.float64) for c in (self.t_s, self.displacement_mm))
        object.__setattr__(self, "t_s", t)
        object.__setattr__(self, "displacement_mm", x)
        if t.ndim != 1 or t.shape != x.shape or t.size < FEWEST:
            raise ModelError(
                f"a trace needs {FEWEST} or more pairs of time and place, got {t.size}, {x.size}"
            )
        if not (np.isfinite(t).all() and np.isfinite(x).all() and (np.diff(t) > 0).all() and t[0] == 0.0):
            raise ModelError("a trace needs finite numbers, and times that rise from 0")
        if t[-1] > LONGEST_s or np.abs(x).max() > DEEPEST_mm:
            raise ModelError(f"a trace lasts {LONGEST_s:g} s and is {DEEPEST_mm:g} mm deep at most")

    @property
    def duration_s(self) -> float:
        return float(self.t_s[-1])


def read_press_trace(data: bytes, source: str) -> PressTrace:
    """Read a trace from CSV or from JSON, an object of columns.

    A column of time (t_s, time_s, t_ms, time_ms) and one of place (displacement_mm, depth_mm, travel_mm,
    x_mm), as the studio records a key too, or an analogue keyboard's log (unixtime, keyCode, keyValue as part
    of 4 mm; the key that moved most is taken). Lines of CSV that begin with # are comments. Raises InputError
    with place and remedy.
    """
    if len(data) > LARGEST_bytes:
        raise InputError(source, "whole file", f"is larger than {LARGEST_bytes // 1_000_000} MB", "cut it")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(source, "whole file", "is no text", "pass a CSV or JSON file") from None
    columns = _json_columns(text, source) if text.lstrip().startswith("{") else _csv_columns(text, source)
    t, x = _time_and_place(columns, source)
    order = np.argsort(t, kind="stable")
    t, first = np.unique(t[order], return_index=True)  # two rows of one time: the first counts
    try:
        return PressTrace(source, f"read from {source}", t - t[:1], x[order][first])
    except ModelError as error:
        raise InputError(source, "columns", str(error), "pass one press or a few of them") from error


def _json_columns(text: str, source: str) -> dict[str, FloatArray]:
    try:
        columns = msgspec.json.decode(text, type=dict[str, list[float]])
    except msgspec.MsgspecError as error:
        reason = f"is no object of columns: {error}"
        raise InputError(source, "$", reason, 'write {"t_s": […], "displacement_mm": […]}') from error
    return {name: np.array(column) for name, column in columns.items()}


def _csv_columns(text: str, source: str) -> dict[str, FloatArray]:
    rows = csv.reader("" if line.startswith("#") else line for line in io.StringIO(text))
    names = [name.strip() for name in next(filter(None, rows), [])]
    numbers: list[list[float]] = []
    for row in rows:
        if not row:
            continue
        try:
            numbers.append([float(cell) for cell in row[: len(names)]])
        except ValueError:
            reason = f"{','.join(row)[:60]!r} is no row of numbers"
            raise InputError(source, f"line {rows.line_num}", reason, "leave it out") from None
        if len(numbers[-1]) < len(names):
            raise InputError(source, f"line {rows.line_num}", "has too few columns", "leave it out")
    table = np.array(numbers).reshape(-1, max(1, len(names)))
    return {name: table[:, i] for i, name in enumerate(names)}


def _time_and_place(columns: dict[str, FloatArray], source: str) -> tuple[FloatArray, FloatArray]:
    time = next((name for name in columns if name in TIMES), None)
    place = next((name for name in columns if name in (*PLACES, RATIO)), None)
    if time is None or place is None:
        reason = f"has the columns {', '.join(columns) or 'none'}"
        raise InputError(source, "header", reason, "name one t_s or time_ms, and one displacement_mm")
    t, x = columns[time] * TIMES[time], columns[place] * (FULL_mm if place == RATIO else 1.0)
    if t.size != x.size:
        raise InputError(source, "columns", f"{t.size} times, {x.size} places", "make them equally long")
    if KEY in columns and t.size:
        keys, own = columns[KEY], np.unique(columns[KEY])
        most = max(own, key=lambda key: float(np.abs(np.diff(x[keys == key])).sum()))
        t, x = _hold_silent(t[keys == most], x[keys == most])
    return t, x


def _hold_silent(t: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Hold a key's position while its keyboard reported nothing."""
    silent = np.flatnonzero(np.diff(t) > SILENT_s)
    return np.insert(t, silent + 1, t[silent + 1] - STEP_s), np.insert(x, silent + 1, x[silent])


def synthetic_traces() -> tuple[PressTrace, ...]:
    """Return synthetic traces: minimum-jerk motions between given points, not recorded from a person."""
    return (
        _draw("slow press", (0.2, 0.0), (2.2, 4.0), (2.7, 4.0), (4.7, 0.0), (5.0, 0.0)),
        _draw("firm press", (0.2, 0.0), (0.28, 4.0), (0.4, 4.0), (0.48, 0.0), (0.8, 0.0)),
        _draw("fast double tap", *_taps(2, 0.16)),
        _draw("drumming", *_taps(8, 0.14)),
        _draw(
            "hesitant press",
            (0.2, 0.0), (0.5, 1.2), (0.9, 1.0), (1.2, 1.9), (1.6, 1.5), (1.9, 4.0), (2.2, 4.0), (2.4, 0.0),
            (2.7, 0.0),
        ),
        _draw("half way and back", (0.2, 0.0), (0.35, 2.0), (0.5, 0.4), (0.65, 2.2), (0.9, 0.0), (1.2, 0.0)),
        _draw("long hold", (0.2, 0.0), (0.3, 4.0), (3.3, 4.0), (3.42, 0.0), (3.8, 0.0)),
    )  # fmt: skip


def _taps(count: int, period_s: float) -> list[tuple[float, float]]:
    points = [(0.2, 0.0)]
    for i in range(count):
        start = 0.2 + i * period_s
        points += [(start + 0.4 * period_s, 4.0), (start + 0.55 * period_s, 4.0), (start + period_s, 0.0)]
    return [*points, (0.5 + count * period_s, 0.0)]


def _draw(name: str, *points: tuple[float, float]) -> PressTrace:
    """Move from point to point (s, mm) on minimum jerk."""
    times, places = (np.array(column) for column in zip((0.0, points[0][1]), *points, strict=True))
    t = np.arange(round(times[-1] / STEP_s) + 1) * STEP_s
    leg = np.clip(np.searchsorted(times, t, side="right") - 1, 0, times.size - 2)
    s = np.clip((t - times[leg]) / (times[leg + 1] - times[leg]), 0.0, 1.0)
    part = s**3 * (10.0 + s * (6.0 * s - 15.0))
    return PressTrace(
        name, "synthetic, not recorded", t, places[leg] + (places[leg + 1] - places[leg]) * part
    )
