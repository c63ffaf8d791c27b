from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fdvv.errors import FitError
from fdvv.model.bspline import design_matrix
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import CurveFit, FitMethod, bic_star, fit_curve, scan_sizes, smooth
from fdvv.units import FloatArray


def measured(x: FloatArray, force: FloatArray) -> MeasuredCurve:
    return MeasuredCurve(x, force, Stroke.PRESS)


def switch(noise_cN: float = 0.1) -> MeasuredCurve:
    """Make a tactile stroke with a contact step, as benches see it."""
    x = np.arange(0, 4.0, 0.005)
    force = np.minimum(500 * x, 35 + 10 * x) + 20 * np.exp(-(((x - 1.4) / 0.35) ** 2))
    return measured(x, force + np.random.default_rng(1).normal(0, noise_cN, x.size))


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_the_coefficients_are_the_least_squares_solution_on_the_knots_found(degree: int) -> None:
    stroke = switch()
    curve = fit_curve(stroke, degree=degree).curve
    x, y, _ = stroke.by_displacement()
    basis = design_matrix(curve.knots_mm, degree, x)
    oracle, *_ = np.linalg.lstsq(basis, y, rcond=None)
    np.testing.assert_allclose(curve.control_points_cN, oracle, atol=2e-5)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_a_curve_that_is_a_spline_of_that_size_is_found_again(degree: int) -> None:
    rng = np.random.default_rng(degree)
    inner = np.sort(rng.choice(np.arange(0.3, 3.7, 0.2), 6, replace=False))
    t = np.concatenate([np.zeros(degree + 1), inner, np.full(degree + 1, 4.0)])
    c = rng.uniform(20, 80, inner.size + degree + 1)
    x = np.arange(0, 4.0001, 0.005)
    fit = fit_curve(measured(x, BSpline(t, c, degree)(x)), control_points=c.size + 3, degree=degree)
    # three knots to spare: what is left is the walk's last step, not the curve
    assert fit.rmse_cN < 0.05


def test_free_knots_beat_uniform_ones_tenfold_on_a_contact_step() -> None:
    adaptive, uniform = (fit_curve(switch(), method, 15) for method in FitMethod)
    assert adaptive.curve.control_points_cN.size == uniform.curve.control_points_cN.size == 15
    assert adaptive.rmse_cN < 0.1 * uniform.rmse_cN
    assert adaptive.rmse_cN < 0.13


def test_no_two_knots_are_closer_than_the_samples() -> None:
    knots = np.unique(fit_curve(switch()).curve.knots_mm)
    assert np.diff(knots).min() >= 0.005 - 1e-9


def test_shifting_or_scaling_the_curve_shifts_and_scales_the_fit() -> None:
    stroke = switch()
    x, y = stroke.displacement_mm, stroke.force_cN
    plain = fit_curve(stroke).curve.force_cN(x)
    moved = fit_curve(measured(x + 1.0, 2 * y + 50)).curve.force_cN(x + 1.0)
    np.testing.assert_allclose(moved, 2 * plain + 50, atol=0.2)


def test_rows_that_repeat_a_displacement_count_as_their_mean() -> None:
    stroke = switch(noise_cN=0.0)
    x = np.repeat(stroke.displacement_mm, 2)
    y = np.repeat(stroke.force_cN, 2) + np.tile([-1.0, 1.0], stroke.force_cN.size)
    doubled, plain = (fit_curve(m, control_points=15) for m in (measured(x, y), stroke))
    assert doubled.rmse_cN == pytest.approx(plain.rmse_cN, rel=1e-6)
    assert doubled.rows_rmse_cN == pytest.approx(math.hypot(1.0, plain.rmse_cN), rel=1e-6)
    assert doubled.samples == plain.samples


def test_smoothing_is_scored_against_the_raw_curve_and_its_loss_of_bump_is_reported() -> None:
    rough, smoothed = fit_curve(switch()), fit_curve(switch(), smoothing_mm=0.4)
    assert rough.bump_kept_ratio is not None
    assert smoothed.bump_kept_ratio is not None
    assert rough.bump_kept_ratio > 0.95
    assert smoothed.bump_kept_ratio < 0.75
    assert smoothed.rmse_cN > 5 * rough.rmse_cN
    assert smoothed.smoothing_mm == 0.4


def test_a_gaussian_as_the_paper_prints_it_erases_the_bump() -> None:
    x = np.arange(0, 4.0, 0.005)
    force = 35 + 8 * x + 15 * np.exp(-(((x - 1.4) / 0.35) ** 2))
    kept = fit_curve(measured(x, force), smoothing_mm=1.2).bump_kept_ratio
    assert kept is not None
    assert kept < 0.05


def test_smoothing_a_line_leaves_it_except_near_its_ends() -> None:
    x = np.linspace(0, 4, 400)
    np.testing.assert_allclose(smooth(x, 3 * x, 0.1)[60:-60], 3 * x[60:-60], atol=1e-3)


def test_a_bump_that_least_squares_would_trim_is_held() -> None:
    x = np.arange(0, 4.0, 0.005)
    ripple = 1.5 * np.sin(2 * np.pi * x / 0.3) * (x > 0.6)
    force = np.minimum(800 * x, 40 + 6 * x) + 9 * np.exp(-(((x - 0.12) / 0.04) ** 2)) + ripple
    fit = fit_curve(measured(x, force))
    assert fit.bump_kept_ratio is not None
    assert fit.bump_kept_ratio >= 0.95


def test_bic_star_is_the_papers_equation() -> None:
    n, k, squared_error, penalty = 80, 15, 80 * 0.14**2, 2.5
    log_likelihood = sum(
        -0.5 * math.log(2 * math.pi * 0.14**2) - 0.5 * (error / 0.14) ** 2 for error in [0.14] * n
    )
    assert bic_star(n, k, squared_error, penalty) == pytest.approx(
        math.log(n) * k * penalty - 2 * log_likelihood
    )


def test_the_size_that_bic_star_chooses_has_the_smallest_score() -> None:
    stroke = switch()
    scores = scan_sizes(stroke)
    chosen = fit_curve(stroke, FitMethod.UNIFORM, control_points=None).curve.control_points_cN.size
    assert chosen == min(scores, key=lambda size: scores[size])
    assert set(scores) == set(range(5, 41))


def test_a_heavier_penalty_never_chooses_more_control_points() -> None:
    sizes = [
        fit_curve(switch(), FitMethod.UNIFORM, None, penalty=p).curve.control_points_cN.size
        for p in (1.0, 2.5, 10.0)
    ]
    assert sizes == sorted(sizes, reverse=True)


@pytest.mark.parametrize(
    ("control_points", "degree", "smoothing_mm"), [(2, 2, 0.0), (65, 2, 0.0), (15, 4, 0.0), (15, 2, -0.1)]
)
def test_settings_out_of_range_are_refused(control_points: int, degree: int, smoothing_mm: float) -> None:
    with pytest.raises(FitError, match="got"):
        fit_curve(switch(), "adaptive", control_points, degree, smoothing_mm)


def test_too_few_samples_are_refused_with_the_numbers() -> None:
    few = measured(np.linspace(0, 1, 10), np.linspace(0, 1, 10))
    with pytest.raises(FitError, match="10 distinct displacements takes 3 to 10 control points, got 15"):
        fit_curve(few, control_points=15)
    with pytest.raises(FitError, match="auto takes 16 distinct displacements, got 10"):
        fit_curve(few)


@settings(max_examples=40, deadline=None)
@given(
    steps=st.lists(st.floats(0.001, 0.3), min_size=20, max_size=120),
    seed=st.integers(0, 1000),
    size=st.integers(4, 16),
)
def test_any_rising_samples_give_a_finite_fit_that_holds_to_them(
    steps: list[float], seed: int, size: int
) -> None:
    x = np.cumsum(steps)
    force = np.random.default_rng(seed).uniform(-50, 250, x.size)
    fit = fit_curve(measured(x, force), control_points=size)
    assert np.isfinite(fit.curve.control_points_cN).all()
    # a constant is a spline; holding a bump may cost half as much again
    assert fit.rmse_cN <= 1.5 * force.std() * (1 + 1e-6)


FLOOR_cN = 0.5
"""What nobody feels: a twelfth of the just noticeable difference at no force."""


def lowest_cN(fit: CurveFit) -> float:
    return float(fit.curve.force_cN(np.linspace(fit.curve.start_mm, fit.curve.end_mm, 5000)).min())


@settings(max_examples=40, deadline=None)
@given(
    rise=st.floats(100, 5000),
    preload_cN=st.floats(5, 80),
    pull_cN=st.sampled_from([0.0, 0.0, 3.0, 20.0]),
    seed=st.integers(0, 1000),
    size=st.sampled_from([None, 6, 15]),
    method=st.sampled_from(list(FitMethod)),
)
def test_no_fit_falls_below_the_measured_forces(
    rise: float, preload_cN: float, pull_cN: float, seed: int, size: int | None, method: FitMethod
) -> None:
    x = np.arange(0, 3.0, 0.01)
    force = np.minimum(rise * x, preload_cN + 5 * x) - pull_cN * np.exp(-(((x - 2) / 0.1) ** 2))
    force += np.random.default_rng(seed).normal(0, 0.1, x.size)
    fit = fit_curve(measured(x, force), method, size)
    assert lowest_cN(fit) >= force.min() - FLOOR_cN
    if force.min() >= -FLOOR_cN:
        assert lowest_cN(fit) >= -FLOOR_cN


def test_a_key_that_pulls_keeps_its_pull() -> None:
    x = np.arange(0, 3.0, 0.005)
    force = 30 + 8 * x - 60 * np.exp(-(((x - 2) / 0.2) ** 2))
    fit = fit_curve(measured(x, force))
    assert lowest_cN(fit) == pytest.approx(force.min(), abs=0.3)
    assert force.min() < -10


@settings(max_examples=25, deadline=None)
@given(
    drop_cN=st.floats(0, 40),
    width_mm=st.floats(0.02, 0.6),
    noise_cN=st.floats(0.01, 1.0),
    count=st.integers(16, 600),
    seed=st.integers(0, 1000),
)
def test_auto_never_has_a_higher_bic_star_than_fifteen(
    drop_cN: float, width_mm: float, noise_cN: float, count: int, seed: int
) -> None:
    x = np.linspace(0, 4, count)
    force = np.minimum(600 * x, 35 + 8 * x) + drop_cN * np.exp(-(((x - 1.4) / width_mm) ** 2))
    stroke = measured(x, force + np.random.default_rng(seed).normal(0, noise_cN, count))
    auto, papers = fit_curve(stroke), fit_curve(stroke, control_points=15)
    assert auto.bic_star <= papers.bic_star + 1e-9 * abs(papers.bic_star)


@pytest.mark.shared
def test_a_real_mx_clear_is_fitted_to_a_quarter_centinewton_with_its_bump(shared_data: Path) -> None:
    table = np.loadtxt(
        shared_data / "tg-strokes" / "csv_output" / "Cherry MX Clear.downstroke.csv", delimiter=","
    )
    keep = table[:, 0] < 4.0
    fit = fit_curve(measured(table[keep, 0], table[keep, 1] * 0.980665), control_points=15)
    # both sides: a much better figure would mean that the measure changed
    assert 0.15 < fit.rmse_cN < 0.35
    assert fit.bump_kept_ratio is not None
    assert 0.95 < fit.bump_kept_ratio < 1.05
