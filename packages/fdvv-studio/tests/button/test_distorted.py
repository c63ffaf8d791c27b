"""What a bench that failed leaves in a stroke is refused with its reason; a button's own leaps are not."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.distorted import distorted_active
from fdvv.button.fit import fit_file, measured_parts
from fdvv.errors import InputError
from fdvv.formats.force.read import read_force_file
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.units import FloatArray
from tests.button.test_plausible import cycle, write

Columns = tuple[FloatArray, FloatArray]
HALF = cycle()[0].size // 2
DEEP = slice(300, 360)
"""Rows of the press, 1.5 to 1.8 mm deep."""


def changed(rows: slice, how: Callable[[FloatArray], FloatArray]) -> Columns:
    """Change the forces of some rows of a press and its release."""
    x, force = cycle()
    force[rows] = how(force[rows])
    return x, force


def slipped() -> Columns:
    x, force = cycle()
    place = np.arange(x.size)
    return np.where(place < HALF, x + 0.4 * (place > 250) + 0.4 * (place > 500), x + 0.8), force


def upside_down() -> Columns:
    x, force = cycle()
    return x, force.max() - force


DISTORTED: dict[str, tuple[Callable[[], Columns], str]] = {
    "a full converter": (lambda: changed(slice(None), lambda f: np.minimum(f, 45.0)), "exactly the same"),
    "a cell that hangs": (lambda: changed(DEEP, lambda f: 0 * f + f[0]), "exactly the same"),
    "coarse steps": (lambda: changed(slice(None), lambda f: 7.0 * np.round(f / 7.0)), "in steps of 7 cN"),
    "lost decimals": (lambda: (np.floor(10 * cycle()[0]) / 10, cycle()[1]), "rows have only"),
    "decibels": (
        lambda: changed(slice(None), lambda f: 20 * np.log10(np.maximum(f, 0.01))),
        "goes down to -40 cN",
    ),
    "a hum": (
        lambda: changed(slice(None), lambda f: f + 9 * np.sin(np.arange(f.size) / 5)),
        "turns .* times by more than",
    ),
    "a burst of zeros": (lambda: changed(DEEP, lambda f: 0 * f), "leaps by .* and back"),
    "a negative part": (lambda: changed(DEEP, lambda f: -f), "leaps by .* and back"),
    "pounds from the middle on": (lambda: changed(slice(400, None), lambda f: 4.4 * f), "jumps from"),
    "newtons on the release": (lambda: changed(slice(HALF + 300, None), lambda f: f / 9.8), "jumps from"),
    "drift": (
        lambda: changed(slice(None), lambda f: f + 40 * np.arange(f.size) / f.size),
        "where nothing is touched",
    ),
    "a tare lost before the release": (
        lambda: changed(slice(HALF + 10, None), lambda f: f + 20.0),
        "where nothing is touched",
    ),
    "a stage that slips": (slipped, "the displacement jumps by 0.8"),
    "force counted from its greatest": (upside_down, "falls by .* before the deepest"),
}


@pytest.mark.parametrize("what", DISTORTED)
def test_what_a_failed_bench_leaves_is_refused_with_its_reason(tmp_path: Path, what: str) -> None:
    make, reason = DISTORTED[what]
    path = write(tmp_path, *make())
    doubts = measured_parts(read_force_file(path)).implausible
    found = [doubt for doubt in doubts if re.search(reason, doubt.reason)]
    assert found, doubts
    assert found[0].remedy.startswith("check")
    with pytest.raises(InputError, match="this cannot be a button's"):
        fit_file(path)


def test_a_click_bar_that_drops_in_one_sample_is_not_doubted() -> None:
    """The loudest measured one goes from 76 to 45 cN."""
    x = np.arange(0, 4, 0.005)
    force = np.where(x < 1.5, 35 + 27 * x, 30 + 10 * x) + 0.05 * np.sin(100 * x)
    assert list(distorted_active(MeasuredCurve(x, force, Stroke.PRESS))) == []


def test_a_snap_between_coarse_samples_is_not_doubted() -> None:
    """A key sampled at 1 kHz on a fast press: its contact step and its drop each lie between two samples."""
    x = np.arange(0, 4, 0.1)
    force = np.interp(x, [0, 0.2, 0.4, 1.5, 1.6, 1.7, 4], [0, 5, 40, 65, 25, 60, 80])
    assert list(distorted_active(MeasuredCurve(x, force, Stroke.PRESS))) == []


def test_a_bench_that_begins_on_the_cap_is_no_fault(tmp_path: Path) -> None:
    """Press and release begin and end where the cap already bears the probe with 40 cN."""
    x = np.arange(201) / 50
    press = 40 + 8 * x - 20 * np.maximum(0.0, 1 - np.abs(x - 2) / 0.5)
    path = write(tmp_path, np.concatenate([x, x[::-1]]), np.concatenate([press, press[::-1] - 6]))
    assert [str(fit.curve.stroke) for fit in fit_file(path).fits] == ["press", "release"]
