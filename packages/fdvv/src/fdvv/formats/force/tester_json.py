"""The switch force tester's JSON (geekboards and its descendants): mm and gf, contact points included."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.formats.force.text import LARGEST, LEAST_SAMPLES, refusal
from fdvv.formats.force.types import Notes, RawCycle, Reading, Track
from fdvv.units import FloatArray, cN_from_gf

POINTS = {"press": ("pressPoint", "press_point"), "release": ("releasePoint", "release_point")}


def is_tester_json(lines: Sequence[str]) -> bool:
    """Recognise JSON by its first character; which JSON it is shows when it is read."""
    return next((line.lstrip()[0] for line in lines if line.strip()), "") in "{["


def read_tester_json(source: Path, lines: Sequence[str], notes: Notes) -> Reading:
    """Read down_x, down_y, up_x, up_y and the two contact points."""
    record = _load(source, "\n".join(lines))
    press = _stroke(source, record, "down", notes)
    release = _stroke(source, record, "up", notes)
    actuation, reset = (_point(record, name, notes) for name in POINTS)
    if release is not None and press is not None:
        release = _rebuild_release(press, release, reset, notes)
    cycle = RawCycle("", None, press, release, actuation and actuation[0], reset and reset[0])
    return Reading("tester-json", source.stem, [cycle])


def _load(source: Path, text: str) -> Mapping[str, Any]:
    try:
        record = json.loads(text)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise refusal(source, place, f"not JSON: {error.msg}") from None
    except (ValueError, RecursionError):
        raise refusal(source, "whole file", "not JSON that can be read") from None
    if not isinstance(record, dict) or not {"down_x", "down_y"} & set(record):
        raise refusal(source, "whole file", "JSON without down_x and down_y is no force curve")
    return record


def _stroke(source: Path, record: Mapping[str, Any], side: str, notes: Notes) -> Track | None:
    x, force = (_numbers(source, record.get(f"{side}_{axis}"), f"$.{side}_{axis}") for axis in "xy")
    where = {"down": "press", "up": "release"}[side]
    if x.size == 0 and force.size == 0:
        notes.say(f"$.{side}_x: there is no {where} in the file")
        return None
    if side == "down" and x.size != force.size:
        count = min(x.size, force.size)
        notes.say(
            f"$.{side}_x, $.{side}_y: {x.size} displacements, {force.size} forces; the first {count} pairs "
            "were kept"
        )
        x, force = x[:count], force[:count]
    good = np.isfinite(force) & (np.isfinite(x) if x.size == force.size else True)
    if not good.all():
        first = int(np.flatnonzero(~good)[0])
        notes.say(
            f"$.{side}_y[{first}]: no usable number; {int((~good).sum())} samples of the {where} left out"
        )
        x, force = (x[good] if x.size == good.size else x), force[good]
    if force.size < LEAST_SAMPLES:
        raise refusal(source, f"$.{side}_y", f"only {force.size} samples")
    return Track(where, x, cN_from_gf(force))


def _numbers(source: Path, values: object, place: str) -> FloatArray:
    if values is None:
        return np.empty(0)
    if not isinstance(values, list):
        raise refusal(source, place, "is not a list of numbers")
    return np.array([_number(value) for value in values], dtype=np.float64)


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return np.nan
    return float(value) if abs(value) <= LARGEST else np.nan


def _point(record: Mapping[str, Any], name: str, notes: Notes) -> tuple[float, float] | None:
    key = next((key for key in POINTS[name] if key in record), None)
    value = record.get(key) if key else None
    if isinstance(value, list) and len(value) == 2:
        point = (_number(value[0]), _number(value[1]))
        if np.isfinite(point).all():
            return point
    if key:
        notes.say(f"$.{key}: not a pair of displacement and force; the {name} has no contact point")
    return None


def _rebuild_release(
    press: Track, release: Track, reset: tuple[float, float] | None, notes: Notes
) -> Track | None:
    """Rebuild a release's displacement where the file only copies that of the press.

    The forces of the release are in the order of time. The tester steps back by the press's own step
    and notes displacement and force where the contact opened: that sample anchors the release.
    """
    x, force = release.x_mm, release.force_cN
    ascending = x.size > 1 and x[-1] > x[0]
    falling = float(np.mean(force[: force.size // 4 + 1])) > float(np.mean(force[-(force.size // 4) - 1 :]))
    if not (ascending and falling):
        if x.size != force.size:
            notes.say(f"$.up_x: {x.size} displacements for {force.size} forces; the release was refused")
            return None
        return release
    step = float(np.median(np.diff(press.x_mm)))
    anchor = _anchor(force, reset, press, step)
    if anchor is None:
        notes.say(
            "$.up_x: copied from down_x, so it ascends while the force falls, and no release point says "
            "where the samples belong; the release was refused"
        )
        return None
    index, at_mm = anchor
    rebuilt: FloatArray = at_mm + (index - np.arange(force.size, dtype=np.float64)) * step
    notes.say(
        f"$.up_x: copied from down_x, so it ascends while the force falls; the release was put back from "
        f"{rebuilt[0]:.4g} to {rebuilt[-1]:.4g} mm in steps of {step:.4g} mm, anchored at the release point "
        f"(sample {index + 1} at {at_mm:.4g} mm)"
    )
    return Track("release", rebuilt, force)


def _anchor(
    force_cN: FloatArray, reset: tuple[float, float] | None, press: Track, step: float
) -> tuple[int, float] | None:
    """Find the release sample with the stated force within 0.1 mm of its position."""
    if reset is None or step <= 0.0:
        return None
    same = np.flatnonzero(np.abs(force_cN - cN_from_gf(reset[1])) < 1e-6)
    start = reset[0] + same * step
    near = np.flatnonzero(np.abs(start - press.x_mm[-1]) <= max(0.1, 3.0 * step))
    if not near.size:
        return None
    best = near[int(np.argmin(np.abs(start[near] - press.x_mm[-1])))]
    return int(same[best]), reset[0]
