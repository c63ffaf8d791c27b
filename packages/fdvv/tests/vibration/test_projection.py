"""Inner products instead of tables of each record: the same least squares."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.units import FloatArray
from fdvv.vibration.projection import Records, polynomial, shapes

THETA = np.array([239.0, 893.0, 150.0, 330.0])


def drawn(seed: int, even: bool) -> tuple[list[FloatArray], list[FloatArray]]:
    random = np.random.default_rng(seed)
    times = []
    for count in (120, 80, 121):
        t = 1e-3 + np.arange(count) / 10_000 + random.uniform(0, 1e-4)
        times.append(t if even else np.sort(t + random.uniform(0, 4e-5, count)))
    return times, [random.standard_normal(t.size) + np.exp(-150 * t) * np.sin(1500 * t) for t in times]


def power_left(times: list[FloatArray], signals: list[FloatArray], theta: FloatArray) -> float:
    """Solve each record by itself, with its own table."""
    total = 0.0
    for t, y in zip(times, signals, strict=True):
        matrix = np.hstack([shapes(t, *np.split(theta, 2)), polynomial(t, 2)])
        left = y - matrix @ np.linalg.lstsq(matrix, y, rcond=None)[0]
        total += float(left @ left)
    return total


@pytest.mark.parametrize("even", [True, False])
def test_what_remains_is_that_of_each_record_solved_by_itself(even: bool) -> None:
    times, signals = drawn(0, even)
    records = Records(times, signals, 2, same_phase=False)
    assert (records.even is not None) == even
    found = records.size**2 * records.at(THETA).power
    assert found == pytest.approx(power_left(times, signals, THETA), rel=1e-9)


@pytest.mark.parametrize("even", [True, False])
def test_slopes_are_those_of_the_power_that_remains(even: bool) -> None:
    times, signals = drawn(1, even)
    records = Records(times, signals, 2, same_phase=False)
    gradient = -2 * records.size**2 * records.at(THETA).slopes.sum(axis=0)
    for k, unit in enumerate(np.eye(THETA.size)):
        ends = [power_left(times, signals, THETA + sign * 1e-2 * unit) for sign in (1, -1)]
        assert gradient[k] == pytest.approx((ends[0] - ends[1]) / 2e-2, rel=1e-4, abs=1e-7)


def test_a_later_start_turns_weights_and_changes_nothing_else() -> None:
    times, signals = drawn(2, even=True)
    shifted = [t + 0.003 for t in times]
    one, other = (Records(t, signals, 2, same_phase=False).at(THETA) for t in (times, shifted))
    assert other.power == pytest.approx(one.power, rel=1e-12)
    np.testing.assert_allclose(other.weights, one.weights, rtol=1e-9)


def test_the_longer_half_of_records_is_left_without_what_is_known() -> None:
    times, signals = drawn(3, even=True)
    left, basis = Records(times, signals, 2, same_phase=False).typical(THETA)
    assert left.shape == (2, 120)
    assert np.abs(left @ basis).max() < 1e-9
