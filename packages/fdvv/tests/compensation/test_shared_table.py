"""A table of several speeds against textbook estimation, bin by bin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.compensation.tables import GATE_sigma, SharedTable
from fdvv.errors import ModelError
from fdvv.units import FloatArray

GRID_mm = np.arange(30, dtype=np.float64) * 0.05
SPEEDS_mm_s = np.array([50.0, 100.0, 150.0, 200.0])
INERTIA_cN = np.array([0.5, 2.0, 4.5, 8.0])


def fresh(speeds_mm_s: FloatArray = SPEEDS_mm_s) -> SharedTable:
    inertia = INERTIA_cN[: speeds_mm_s.size]
    return SharedTable.prior(GRID_mm, speeds_mm_s, 4.0, inertia, 1.0 + 0.3 * inertia)


def even(force_cN: float) -> FloatArray:
    return np.full(GRID_mm.size, force_cN)


def shares_by_hand(speed_mm_s: float) -> FloatArray:
    """Return the shares of rows: straight in the square of speed, the outer ones going on a little."""
    squares = SPEEDS_mm_s**2
    low = max(0, min(2, int(np.sum(squares < speed_mm_s**2)) - 1))
    part = min(max((speed_mm_s**2 - squares[low]) / (squares[low + 1] - squares[low]), -0.3), 1.3)
    return np.array([{low: 1 - part, low + 1: part}.get(i, 0.0) for i in range(4)])


def by_regression(
    spread: FloatArray, seen: FloatArray, rows: FloatArray, noises: FloatArray, fading: float
) -> tuple[FloatArray, FloatArray]:
    """Weigh all that was seen at once: Bayesian linear regression, what is older faded."""
    count = len(rows)
    weights = fading ** np.arange(count - 1, -1, -1.0) / noises**2
    precision = fading**count * np.linalg.inv(spread) + rows.T @ (weights[:, np.newaxis] * rows)
    covariance = np.asarray(np.linalg.inv(precision), dtype=np.float64)
    return covariance @ rows.T @ (weights[:, np.newaxis] * seen), covariance


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 12), st.floats(0.5, 1.0), st.booleans())
def test_any_sequence_ends_where_bayesian_regression_over_all_of_it_ends(
    seed: int, count: int, fading: float, between: bool
) -> None:
    random, table = np.random.default_rng(seed), fresh()
    speeds = random.uniform(30.0, 240.0, count) if between else random.choice(SPEEDS_mm_s, count)
    rows, noises = np.array([shares_by_hand(v) for v in speeds]), random.uniform(1.0, 6.0, count)
    spread = table.covariance_cN2
    # within 0.3 standard deviations of every belief, so nothing surprises and the gate stays open
    truth = np.linalg.cholesky(spread) @ random.uniform(-0.3, 0.3, (4, GRID_mm.size))
    seen = rows @ truth + noises[:, np.newaxis] * random.uniform(-0.3, 0.3, (count, GRID_mm.size))
    for force, speed, noise in zip(seen, speeds.tolist(), noises.tolist(), strict=True):
        table = table.update(force, speed, noise, 0.0, fading)
    mean, covariance = by_regression(spread, seen, rows, noises, fading)
    np.testing.assert_allclose(table.rows_cN, mean, atol=1e-8)
    np.testing.assert_allclose(table.covariance_cN2, covariance, atol=1e-8 * covariance.max())


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 60), st.floats(0.8, 1.0))
def test_the_covariance_stays_symmetric_and_positive(seed: int, count: int, fading: float) -> None:
    random, table = np.random.default_rng(seed), fresh()
    for _ in range(count):
        force = random.normal(0.0, 30.0, GRID_mm.size)
        table = table.update(force, random.uniform(20, 300), random.uniform(0.1, 9), 0.0, fading)
    np.testing.assert_array_equal(table.covariance_cN2, table.covariance_cN2.T)
    assert np.linalg.eigvalsh(table.covariance_cN2).min() > 0


def test_one_speed_is_the_scalar_filter() -> None:
    table = fresh(np.array([100.0]))
    variance = float(table.covariance_cN2[0, 0])
    assert variance == pytest.approx(4.0**2 + 0.5**2 + 1.15**2)
    for pressed in (100.0, 80.0, 300.0):  # whatever the press was, there is one row
        once = table.update(even(3.0), pressed, 2.0, 0.0, 1.0)
        np.testing.assert_allclose(once.rows_cN, 3.0 * variance / (variance + 4.0))
        np.testing.assert_allclose(once.covariance_cN2, 1 / (1 / variance + 1 / 4.0))


def test_a_press_moves_other_rows_by_what_the_covariance_says() -> None:
    before = fresh()
    after = before.update(even(5.0), 150.0, 2.0, 0.0, 1.0)
    covariance = before.covariance_cN2
    np.testing.assert_allclose(after.rows_cN[:, 7], 5.0 * covariance[:, 2] / (covariance[2, 2] + 4.0))
    # 4 cN are common and inertia is shared: 200 mm/s moves more than 100, which moves more than 50
    moved = after.rows_cN[:, 7]
    assert moved[2] > moved[1] > moved[0] > 0
    assert moved[3] > moved[1]


def test_bins_that_tell_nothing_take_their_neighbours_surprise() -> None:
    force = np.where((np.arange(GRID_mm.size) > 9) & (np.arange(GRID_mm.size) < 20), 4.0, np.nan)
    force[14] = np.nan
    holed = fresh().update(force, 100.0, 2.0, 0.0, 1.0)
    whole = fresh().update(even(4.0), 100.0, 2.0, 0.0, 1.0)
    np.testing.assert_allclose(holed.rows_cN, whole.rows_cN)


def test_a_stroke_that_tells_nothing_anywhere_is_refused() -> None:
    with pytest.raises(ModelError, match="within the guards"):
        fresh().update(even(np.nan), 100.0, 2.0, 0.0, 1.0)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_bounce_counts_as_two_standard_deviations(sign: float) -> None:
    before = fresh()
    force = even(1.0)
    force[10] = sign * 500.0
    after = before.update(force, 100.0, 2.0, 0.0, 1.0)
    expected = before.covariance_cN2[1, 1] + 4.0
    weight = before.covariance_cN2[1, 1] / expected
    assert after.rows_cN[1, 10] == pytest.approx(sign * weight * GATE_sigma * np.sqrt(expected))
    np.testing.assert_allclose(np.delete(after.rows_cN[1], 10), weight)


def test_smoothing_keeps_a_straight_correction_and_takes_what_is_short() -> None:
    line, ripple = 2.0 * GRID_mm, np.cos(np.pi * np.arange(GRID_mm.size))
    plain, smoothed, short = (
        fresh().update(force, 100.0, 2.0, sigma_mm, 1.0).rows_cN[1]
        for force, sigma_mm in ((line, 0.0), (line, 0.1), (ripple, 0.1))
    )
    np.testing.assert_allclose(smoothed, plain, atol=1e-9)
    assert np.abs(short[5:-5]).max() < 0.05


def test_a_table_between_speeds_is_straight_in_the_square_of_speed() -> None:
    table = fresh()
    rows = SPEEDS_mm_s[:, np.newaxis] ** 2 * 1e-4 + GRID_mm
    table = SharedTable(GRID_mm, SPEEDS_mm_s, rows, table.covariance_cN2)
    for speed in (50.0, 77.0, 100.0, 180.0, 200.0, 210.0):
        np.testing.assert_allclose(table.at(speed), speed**2 * 1e-4 + GRID_mm)
        np.testing.assert_allclose(table.shares(speed), shares_by_hand(speed), atol=1e-12)
    np.testing.assert_allclose(table.at(1000.0), table.at(2000.0))
