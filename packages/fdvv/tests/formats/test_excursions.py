"""What is a bench's excursion and what the switch's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.read import read_force_file
from fdvv.formats.force.types import ForceFile
from fdvv.units import FloatArray
from tests.formats import conftest as files

DOWN_mm = np.round(np.arange(-0.5, 4.1001, 0.005), 4)


def force_of(x: FloatArray) -> FloatArray:
    """Compute air, a contact step, a spring, and a stop at 4 mm."""
    return np.where(x < 0, 0.0, np.minimum(500.0 * x, 35 + 5 * x)) + 800.0 * np.maximum(x - 4.0, 0.0)


def read(folder: Path, *presses: FloatArray) -> ForceFile:
    """Read cycles of the given presses, each with a release 4 cN below the plain curve."""
    back = np.maximum(force_of(DOWN_mm[::-1]) - 4.0, 0.0)
    x = np.concatenate([np.concatenate((DOWN_mm, DOWN_mm[::-1])) for _ in presses])
    force = np.concatenate([np.concatenate((press, back)) for press in presses])
    rows = [f"{a!r},{b!r}" for a, b in zip(x.tolist(), force.tolist(), strict=True)]
    return read_force_file(files.write(folder, "p.csv", "\n".join(["x_mm,force_cN", *rows])))


def leap(at_mm: float, height_cN: float = 40.0) -> FloatArray:
    force = force_of(DOWN_mm)
    force[np.abs(DOWN_mm - at_mm) < 0.008] += height_cN
    return force


def test_a_leap_that_recurs_in_another_cycle_stays(tmp_path: Path) -> None:
    file = read(tmp_path, leap(2.0), leap(2.05), force_of(DOWN_mm))
    assert files.press(file).force_cN.size == files.press(file, 1).force_cN.size == DOWN_mm.size
    (warning,) = file.warnings
    assert "alike in several cycles; it was kept" in warning


@pytest.mark.parametrize("second", [leap(3.0), leap(2.0, -40.0), force_of(DOWN_mm)])
def test_a_leap_elsewhere_or_the_other_way_is_no_repeat(second: FloatArray, tmp_path: Path) -> None:
    file = read(tmp_path, leap(2.0), second)
    assert files.press(file).force_cN.max() == pytest.approx(force_of(DOWN_mm).max())
    assert any(
        "press of cycle 1 from 1.995 to 2.005 mm: the force leaps to 85.0 cN" in w for w in file.warnings
    )


def test_a_slip_amid_the_climb_of_a_stop_stays(tmp_path: Path) -> None:
    force = force_of(DOWN_mm)
    force[np.abs(DOWN_mm - 4.07) < 0.008] -= 30.0
    file = read(tmp_path, force)
    assert files.press(file).force_cN.size == DOWN_mm.size
    assert file.warnings == ()


def test_a_touch_in_the_air_is_reported_and_moves_nothing(tmp_path: Path) -> None:
    touched = force_of(DOWN_mm)
    touched[40] = 13.0
    file = read(tmp_path, touched, force_of(DOWN_mm), force_of(DOWN_mm))
    assert "press of cycle 1 at -0.300 mm: the force touches 13.0 cN in the air" in file.warnings[0]
    (mean,) = average_by_velocity(file)
    assert len(mean.used) == 3
