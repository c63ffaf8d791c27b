"""Even cubic B-splines agree with SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from fdvv.preprocess.fuse import EvenBasis, rough


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_rows_are_those_of_scipy(derivative: int) -> None:
    basis = EvenBasis(2.0, 0.25, 9)
    knots = 2.0 + 0.25 * np.arange(-3, 13)
    at = np.linspace(2.0, 4.2499, 101)

    expected = BSpline(knots, np.eye(12), 3)(at, nu=derivative)

    assert basis.rows(at, derivative) == pytest.approx(expected, abs=1e-9)


def test_rows_sum_to_one_and_hold_beyond_the_ends() -> None:
    basis = EvenBasis(0.0, 1.0, 4)

    assert basis.rows(np.linspace(-2, 7, 50)).sum(axis=1) == pytest.approx(1.0)
    assert basis.rows(np.array([-5.0])) == pytest.approx(basis.rows(np.array([0.0])))


def test_a_parabola_is_not_rough() -> None:
    assert rough(8) @ np.arange(8.0) ** 2 == pytest.approx(0.0)
