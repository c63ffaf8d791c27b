from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.model.bump import find_bump
from fdvv.units import FloatArray


def tactile(x: FloatArray, height_cN: float = 20.0) -> FloatArray:
    """Make a line with one smooth bump whose flanks turn at 1.5 and 2.5 mm."""
    return 30 + 8 * x + height_cN * np.exp(-(((x - 1.5) / 0.35) ** 2))


def test_the_bump_of_a_smooth_curve_has_the_peak_and_valley_of_its_derivative() -> None:
    x = np.linspace(0, 4, 801)
    force = tactile(x)
    bump = find_bump(x, force)
    assert bump is not None
    turning = np.flatnonzero(np.diff(np.sign(np.diff(force)))) + 1
    assert bump.peak_mm == pytest.approx(x[turning[0]], abs=0.01)
    assert bump.valley_mm == pytest.approx(x[turning[1]], abs=0.01)
    assert bump.drop_cN == pytest.approx(force[turning[0]] - force[turning[1]], abs=0.15)
    assert bump.snap_ratio == pytest.approx(bump.drop_cN / bump.peak_cN)


def test_a_linear_curve_has_no_bump_even_with_stick_and_slip() -> None:
    x = np.linspace(0, 4, 801)
    ripple = np.random.default_rng(3).normal(0, 0.5, x.size)
    assert find_bump(x, 30 + 8 * x + ripple) is None


def test_a_single_wild_sample_does_not_make_a_bump() -> None:
    x = np.linspace(0, 4, 801)
    force = 30 + 0 * x
    force[400] += 10.0
    assert find_bump(x, force) is None


@given(scale=st.floats(0.5, 5), shift=st.floats(-20, 200))
def test_the_drop_scales_with_force_and_does_not_care_for_an_offset(scale: float, shift: float) -> None:
    x = np.linspace(0, 4, 401)
    plain = find_bump(x, tactile(x), 0.0)
    moved = find_bump(x, scale * tactile(x) + shift, 0.0)
    assert plain is not None
    assert moved is not None
    assert moved.drop_cN == pytest.approx(scale * plain.drop_cN, rel=1e-9)
    assert moved.peak_mm == plain.peak_mm
