"""Amplitude over velocity and energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import FitError
from fdvv.vibration import fit_scaling, snap_energy

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)


@given(exponent=st.floats(0.0, 2.5), level=st.floats(1e-3, 1e3))
def test_a_power_law_is_found_exactly(exponent: float, level: float) -> None:
    scaling = fit_scaling(SPEEDS_mm_s, [level * (v / 100) ** exponent for v in SPEEDS_mm_s])
    assert scaling.exponent == pytest.approx(exponent, abs=1e-9)
    assert scaling.amplitude(300.0) == pytest.approx(level * 3**exponent, rel=1e-9)
    assert scaling.exponent_sd == pytest.approx(0.0, abs=1e-7)


def test_the_standard_error_is_the_spread_of_the_exponent() -> None:
    random = np.random.default_rng(0)
    fits = [
        fit_scaling(SPEEDS_mm_s, [(v / 100) * math.exp(0.2 * random.standard_normal()) for v in SPEEDS_mm_s])
        for _ in range(2000)
    ]
    true_sd = 0.2 / math.sqrt(float(np.sum((np.log(SPEEDS_mm_s) - np.mean(np.log(SPEEDS_mm_s))) ** 2)))
    assert np.std([fit.exponent for fit in fits]) == pytest.approx(true_sd, rel=0.05)
    assert np.sqrt(np.mean([fit.exponent_sd**2 for fit in fits])) == pytest.approx(true_sd, rel=0.1)


def test_energy_counts_by_its_root() -> None:
    energy = [0.02, 0.05, 0.03, 0.08]
    amplitude = [3 * (v / 100) ** 1.2 * math.sqrt(e) for v, e in zip(SPEEDS_mm_s, energy, strict=True)]
    scaling = fit_scaling(SPEEDS_mm_s, amplitude, energy)
    assert scaling.exponent == pytest.approx(1.2)
    assert scaling.amplitude(80.0, 0.04) == pytest.approx(3 * 0.8**1.2 * 0.2)


def test_one_velocity_gives_an_assumed_exponent_and_says_so() -> None:
    scaling = fit_scaling([100.0], [2.0])
    assert (scaling.exponent, scaling.exponent_sd) == (1.0, math.inf)
    assert scaling.amplitude(50.0) == pytest.approx(1.0)
    assert "extrapolated" in scaling.remark(50.0)
    assert "assumed" in scaling.remark(50.0)
    assert scaling.remark(100.0) == "measured at 100 mm/s"
    with pytest.raises(FitError, match="above 0"):
        fit_scaling([], [])


def test_the_energy_of_a_straight_fall_is_the_triangle() -> None:
    x = np.linspace(0, 4, 801)
    force = np.interp(x, [0, 1, 2, 4], [30, 60, 40, 80])
    energy = snap_energy(x, force)
    assert energy is not None
    # 20 cN over 1 mm, half of it: 10 cN mm = 0.1 mJ; forces are means over 50 um, which rounds the corners
    assert energy.energy_mJ == pytest.approx(0.1, rel=0.03)
    assert energy.drop_cN == pytest.approx(20, abs=1)
    assert energy.window_mm == pytest.approx((1.75, 3.25), abs=0.05)


def test_a_linear_switch_sets_nothing_free() -> None:
    x = np.linspace(0, 4, 801)
    assert snap_energy(x, 40 + 10 * x + 0.5 * np.sin(20 * x)) is None
