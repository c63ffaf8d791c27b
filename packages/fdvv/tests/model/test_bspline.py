import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fdvv.errors import ModelError
from fdvv.model import bspline as _bspline
from fdvv.units import FloatArray
from tests.model.strategies import knots

X_mm = np.linspace(0.0, 4.0, 101)


def naive_basis(t: FloatArray, i: int, k: int, x: float) -> float:
    """The recurrence of Cox and de Boor, as a textbook prints it."""
    if k == 0:
        last = x == t[-1] and t[i] < t[i + 1] == t[-1]
        return 1.0 if t[i] <= x < t[i + 1] or last else 0.0
    left = (x - t[i]) / (t[i + k] - t[i]) * naive_basis(t, i, k - 1, x) if t[i + k] > t[i] else 0.0
    span = t[i + k + 1] - t[i + 1]
    right = (t[i + k + 1] - x) / span * naive_basis(t, i + 1, k - 1, x) if span > 0 else 0.0
    return left + right


@st.composite
def splines(draw: st.DrawFn) -> tuple[FloatArray, FloatArray, int]:
    k = draw(st.integers(1, 5))
    t = draw(knots(k))
    n = t.size - k - 1
    return t, np.array(draw(st.lists(st.floats(-100, 100), min_size=n, max_size=n))), k


@settings(max_examples=60, deadline=None)
@given(splines())
def test_the_basis_is_a_partition_of_unity(spline: tuple[FloatArray, FloatArray, int]) -> None:
    t, _, k = spline
    basis = _bspline.design_matrix(t, k, X_mm)
    assert basis.min() >= -1e-15
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, rtol=0, atol=1e-12)


@settings(max_examples=15, deadline=None)
@given(splines())
def test_the_value_is_the_textbook_sum(spline: tuple[FloatArray, FloatArray, int]) -> None:
    t, c, k = spline
    x = np.linspace(0.0, 4.0, 9)
    expected = [sum(c[i] * naive_basis(t, i, k, float(a)) for i in range(c.size)) for a in x]
    np.testing.assert_allclose(_bspline.evaluate(t, c, k, x), expected, rtol=0, atol=1e-10)


@settings(max_examples=60, deadline=None)
@given(splines())
def test_inside_the_knots_value_and_derivatives_are_scipys(
    spline: tuple[FloatArray, FloatArray, int],
) -> None:
    t, c, k = spline
    for derivative in (0, 1, 2):
        ours = _bspline.evaluate(t, c, k, X_mm, derivative)
        np.testing.assert_array_equal(ours, BSpline(t, c, k)(X_mm, nu=derivative))


@settings(max_examples=60, deadline=None)
@given(splines(), st.floats(0.01, 100))
def test_outside_the_knots_the_end_values_hold_with_derivative_zero(
    spline: tuple[FloatArray, FloatArray, int], beyond: float
) -> None:
    t, c, k = spline
    x = [-beyond, 4.0 + beyond]
    np.testing.assert_allclose(_bspline.evaluate(t, c, k, x), c[[0, -1]], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(_bspline.evaluate(t, c, k, x, derivative=1), 0.0)


@pytest.mark.parametrize("k", range(1, 6))
def test_control_points_on_a_line_at_their_abscissae_draw_that_line(k: int) -> None:
    t = _bspline.uniform_knots(0.0, 4.0, 9, k)
    c = 3.0 + 2.0 * _bspline.greville(t, k)
    np.testing.assert_allclose(_bspline.evaluate(t, c, k, X_mm), 3.0 + 2.0 * X_mm, rtol=0, atol=1e-12)


@pytest.mark.parametrize("k", range(1, 6))
def test_interpolation_meets_every_node_with_one_coefficient_each(k: int) -> None:
    x = np.linspace(0.0, 4.0, 15) ** 1.1
    y = np.random.default_rng(k).normal(50, 20, 15)
    t, c = _bspline.interpolate(x, y, k)
    assert c.size == 15
    np.testing.assert_allclose(_bspline.evaluate(t, c, k, x), y, rtol=0, atol=1e-9)


def test_cubic_interpolation_leaves_out_the_knots_next_to_the_ends() -> None:
    x = np.arange(8.0)
    t, _ = _bspline.interpolate(x, np.sin(x))
    np.testing.assert_array_equal(t, [0, 0, 0, 0, 2, 3, 4, 5, 7, 7, 7, 7])


@pytest.mark.parametrize("k", range(1, 6))
def test_least_squares_leaves_a_residual_that_no_basis_function_can_take_up(k: int) -> None:
    t = _bspline.uniform_knots(0.0, 4.0, 8, k)
    y = np.random.default_rng(0).normal(50, 20, X_mm.size)
    residual = y - _bspline.evaluate(t, _bspline.least_squares(t, k, X_mm, y), k, X_mm)
    np.testing.assert_allclose(_bspline.design_matrix(t, k, X_mm).T @ residual, 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("t", "n", "k", "said"),
    [
        ([0, 0, 1, 1], 2, 0, "degree must be 1 to 5, got 0"),
        ([0, 0, 1, 1], 2, 6, "degree must be 1 to 5, got 6"),
        ([0, 0, 0, 1, 1], 2, 2, "degree 2 needs at least 3 control points, got 2"),
        ([0, 0, 1, 1], 3, 1, "3 control points of degree 1 need 5 knots, got 4"),
        ([0, 0, 3, 2, 4, 4], 4, 1, "must not fall"),
        ([0, 1, 2, 4, 4], 3, 1, "first and last 2 knots must be equal"),
        ([0, 0, 2, 3, 4], 3, 1, "first and last 2 knots must be equal"),
        ([0, 0, 2, 2, 2, 4, 4], 5, 1, "no knot may repeat more than 2 times"),
        ([1, 1, 1, 1], 2, 1, "the curve needs a length"),
    ],
)
def test_numbers_that_are_no_clamped_spline_are_refused(t: list[float], n: int, k: int, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        _bspline.check(np.array(t, dtype=np.float64), np.zeros(n), k)
