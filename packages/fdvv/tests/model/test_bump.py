"""Bumps, contact and stop of a stroke."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.formats.force.read import read_force_file
from fdvv.model.bump import find_bottom_out_mm, find_bump, find_contact_mm
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import active_part
from fdvv.units import FloatArray


def tactile(x: FloatArray) -> FloatArray:
    """Make a line with one smooth bump whose flanks turn at 1.5 and 2.5 mm."""
    return 30 + 8 * x + 20.0 * np.exp(-(((x - 1.5) / 0.35) ** 2))


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


def bench_stroke(air_mm: float = 0.3, stop_cN_mm: float = 1500.0) -> tuple[FloatArray, FloatArray]:
    """Make a slow bench stroke: air, contact step of 35 cN in 0.07 mm, spring of 12 cN/mm, stop at 4 mm."""
    x = np.arange(-air_mm, 4.08, 0.005)
    force = np.where(x < 0, 0.0, np.minimum(500.0 * x, 35 + 12 * x)) + stop_cN_mm * np.maximum(x - 4.0, 0.0)
    return x, force + np.random.default_rng(1).normal(0, 0.05, x.size)


def test_contact_of_a_stroke_that_begins_loaded_is_its_first_sample() -> None:
    x, force = bench_stroke(air_mm=-0.5)
    assert find_contact_mm(MeasuredCurve(x, force, Stroke.PRESS)) == x[0]


def test_a_light_touch_in_the_air_is_not_the_contact() -> None:
    x, force = bench_stroke(air_mm=1.0)
    force[20:24] += 5.0
    assert find_contact_mm(MeasuredCurve(x, force, Stroke.PRESS)) == pytest.approx(0.0, abs=0.006)


def test_a_stroke_that_never_meets_the_stop_has_no_bottom_out() -> None:
    x, force = bench_stroke()
    short = MeasuredCurve(x[x < 3.5], force[x < 3.5], Stroke.PRESS)
    assert find_bottom_out_mm(short) is None
    assert active_part(short).displacement_mm[-1] == short.displacement_mm[-1]


@pytest.mark.parametrize(("from_mm", "to_mm", "added_cN"), [(1.5, 1.7, 30.0), (3.8, np.inf, 10.0)])
def test_a_click_in_the_middle_and_a_step_well_before_the_stop_are_not_the_stop(
    from_mm: float, to_mm: float, added_cN: float
) -> None:
    x, force = bench_stroke()
    force[(x > from_mm) & (x < to_mm)] += added_cN
    assert find_bottom_out_mm(MeasuredCurve(x, force, Stroke.PRESS)) == pytest.approx(4.0, abs=0.021)


@pytest.mark.parametrize("stop_cN_mm", [150.0, 400.0, 3000.0])
def test_soft_and_hard_stops_are_found(stop_cN_mm: float) -> None:
    x, force = bench_stroke(stop_cN_mm=stop_cN_mm)
    assert find_bottom_out_mm(MeasuredCurve(x, force, Stroke.PRESS)) == pytest.approx(4.0, abs=0.025)


@pytest.mark.shared
def test_the_extent_of_real_cherry_switches_is_that_of_their_data_sheet(shared_data: Path) -> None:
    table = np.loadtxt(
        shared_data / "bluepylons-parsed" / "Cherry-MX-Red.csv", delimiter=",", skiprows=1, usecols=(0, 1)
    )
    deepest = int(np.argmax(table[:, 0]))
    press = MeasuredCurve(table[: deepest + 1, 0] / 1000, table[: deepest + 1, 1] * 0.980665, Stroke.PRESS)
    part = active_part(press)
    # total travel of an MX switch: 4 mm, less 0.5 mm at most (Cherry's data sheet)
    assert 3.5 <= part.displacement_mm[-1] - part.displacement_mm[0] <= 4.1


@given(
    width_mm=st.floats(0.01, 0.12),
    depth_mm=st.floats(0.03, 0.08),
    fall_cN=st.floats(0.0, 30.0),
    stop_cN_mm=st.floats(400.0, 2000.0),
)
def test_a_gap_in_the_stop_does_not_move_the_knee(
    width_mm: float, depth_mm: float, fall_cN: float, stop_cN_mm: float
) -> None:
    x = np.arange(-0.3, 4.4, 0.005)
    force = np.where(x < 0, 0.0, np.minimum(500.0 * x, 35 + 12 * x))
    rise = np.maximum(x - 4.0, 0.0)
    whole = force + stop_cN_mm * rise
    # the stop rests for the gap, falls by what it slips, and goes on
    gap = np.clip(rise - depth_mm, 0.0, width_mm)
    slipped = whole - stop_cN_mm * gap - min(fall_cN, 0.8 * stop_cN_mm * depth_mm) * gap / width_mm
    found = [find_bottom_out_mm(MeasuredCurve(x, f, Stroke.PRESS)) for f in (whole, slipped)]
    assert found[0] == pytest.approx(4.0, abs=0.021)
    assert found[1] == pytest.approx(found[0], abs=0.02)


@given(at=st.integers(2, 55), samples=st.integers(1, 8), spike_cN=st.floats(10.0, 1000.0))
def test_a_spike_in_the_air_does_not_move_contact(at: int, samples: int, spike_cN: float) -> None:
    x, force = bench_stroke()
    plain = find_contact_mm(MeasuredCurve(x, force, Stroke.PRESS))
    force[at : min(at + samples, 58)] = spike_cN
    assert find_contact_mm(MeasuredCurve(x, force, Stroke.PRESS)) == pytest.approx(plain, abs=0.006)


def test_a_lost_sample_after_contact_is_no_air() -> None:
    x, force = bench_stroke()
    force[np.searchsorted(x, 0.013)] = 0.0
    assert find_contact_mm(MeasuredCurve(x, force, Stroke.PRESS)) == pytest.approx(0.0, abs=0.006)


@pytest.mark.shared
@pytest.mark.parametrize(
    ("log", "knee_mm"),
    [
        ("BKE_Redux_v1_Light_01/DataLog_1", 3.21),
        ("BKE_Redux_v1_Light_01/DataLog_2", 3.21),
        ("NiZ_Black_65g/NiZ_65g-DataLog_2", 3.90),
        ("NiZ_Black_65g/NiZ_65g-DataLog_3", 3.95),
        ("Topre_R1_45g/DataLog_1", 3.90),
        ("Topre_R1_45g/DataLog_2", 3.92),
        ("Topre_R1_45g/DataLog_3", 3.92),
    ],
)
def test_the_knee_of_a_real_dome_is_above_the_slip_in_its_stop(
    log: str, knee_mm: float, shared_data: Path
) -> None:
    press = read_force_file(shared_data / f"buddyog-topre/{log}.csv").cycles[0].press
    assert press is not None
    assert find_bottom_out_mm(press) == pytest.approx(knee_mm, abs=0.05)


def test_a_stroke_that_only_pulls_has_a_contact() -> None:
    pull = MeasuredCurve(np.linspace(0, 2, 50), np.linspace(-20, -6, 50), Stroke.PRESS)
    assert find_contact_mm(pull) >= 0
