from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
from tests.model.strategies import curves, forces_cN


def measured(x: Any, force: Any, **fields: Any) -> MeasuredCurve:
    return MeasuredCurve(x, force, fields.get("stroke", Stroke.PRESS), fields.get("velocity_mm_s"))


def line(**fields: Any) -> ForceCurve:
    whole: dict[str, Any] = {
        "stroke": "press",
        "velocity_mm_s": 50.0,
        "degree": 1,
        "knots_mm": [0, 0, 4, 4],
        "control_points_cN": [10, 50],
    }
    return ForceCurve(**{**whole, **fields})


@pytest.mark.parametrize(
    ("x", "force", "said"),
    [
        ([0, 1, 2], [0, 1], r"must pair up"),
        ([0], [1], "at least 2 samples, got 1"),
        ([], [], "at least 2 samples, got 0"),
        ([0, 2, 1], [0, 1, 2], "must not fall, it does at index 2"),
        ([0, np.nan, 1], [0, 1, 2], "displacement_mm must be finite, got nan at index 1"),
        ([0, 1, 2], [0, 1, -np.inf], "force_cN must be finite, got -inf at index 2"),
        ([[0, 1]], [[0, 1]], "displacement_mm must be one column"),
    ],
)
def test_columns_that_are_no_measured_stroke_are_refused(x: Any, force: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        measured(x, force)


@pytest.mark.parametrize("velocity_mm_s", [0.0, -1.0, np.nan, np.inf])
def test_a_velocity_is_positive_and_finite(velocity_mm_s: float) -> None:
    with pytest.raises(ModelError, match="velocity_mm_s must be positive and finite"):
        measured([0, 1], [0, 1], velocity_mm_s=velocity_mm_s)
    with pytest.raises(ModelError, match="velocity_mm_s must be positive and finite"):
        line(velocity_mm_s=velocity_mm_s)


def test_a_curve_keeps_its_own_read_only_copy_of_what_it_is_given() -> None:
    x, force = np.array([0.0, 1.0]), np.array([2.0, 3.0])
    curve = measured(x, force)
    x[0], force[0] = 9.0, 9.0
    assert (curve.displacement_mm[0], curve.force_cN[0]) == (0.0, 2.0)
    with pytest.raises(ValueError, match="read-only"):
        curve.force_cN[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        line().control_points_cN[0] = 1.0


def test_repeats_are_averaged_and_counted() -> None:
    x, force, count = measured([0, 1, 1, 1, 2], [5, 1, 2, 6, 7]).by_displacement()
    np.testing.assert_array_equal(x, [0, 1, 2])
    np.testing.assert_array_equal(force, [5, 3, 7])
    np.testing.assert_array_equal(count, [1, 3, 1])


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 6), forces_cN), min_size=2, max_size=30))
def test_averaging_repeats_loses_no_sample_and_no_force(samples: list[tuple[int, float]]) -> None:
    x, force = np.array(sorted(samples), dtype=np.float64).T
    places, means, count = measured(x, force).by_displacement()
    assert np.all(np.diff(places) > 0)
    assert count.sum() == x.size
    np.testing.assert_allclose((means * count).sum(), force.sum(), rtol=0, atol=1e-9)


def test_a_part_keeps_the_samples_on_its_borders() -> None:
    part = measured([0, 1, 2, 3], [5, 6, 7, 8], velocity_mm_s=30.0).between(1, 2)
    np.testing.assert_array_equal(part.displacement_mm, [1, 2])
    np.testing.assert_array_equal(part.force_cN, [6, 7])
    assert part.velocity_mm_s == 30.0


def test_a_line_has_the_force_and_stiffness_one_works_out_in_the_head() -> None:
    curve = line()
    np.testing.assert_allclose(curve.force_cN([-1, 0, 1, 4, 5]), [10, 10, 20, 50, 50])
    np.testing.assert_allclose(curve.stiffness_cN_mm([-1, 1, 5]), [0, 10, 0])
    assert (curve.start_mm, curve.end_mm) == (0.0, 4.0)
    np.testing.assert_array_equal(curve.control_points_mm, [0, 4])


@settings(max_examples=50, deadline=None)
@given(curves())
def test_a_force_stays_between_the_least_and_the_largest_control_point(curve: ForceCurve) -> None:
    force = curve.force_cN(np.linspace(-1, 5, 200))
    assert force.min() >= curve.control_points_cN.min() - 1e-9
    assert force.max() <= curve.control_points_cN.max() + 1e-9


@settings(max_examples=50, deadline=None)
@given(curves(), st.floats(0.01, 10))
def test_samples_lie_on_the_curve_from_end_to_end(curve: ForceCurve, step_mm: float) -> None:
    samples = curve.sample(step_mm)
    assert (samples.displacement_mm[0], samples.displacement_mm[-1]) == (curve.start_mm, curve.end_mm)
    assert np.diff(samples.displacement_mm).max() <= 1.5 * step_mm or samples.force_cN.size == 2
    np.testing.assert_array_equal(samples.force_cN, curve.force_cN(samples.displacement_mm))
    assert (samples.stroke, samples.velocity_mm_s) == (curve.stroke, curve.velocity_mm_s)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"degree": 3}, "degree 3 needs at least 4 control points, got 2"),
        ({"knots_mm": [0, 0, 4]}, "need 4 knots, got 3"),
        ({"control_points_cN": [np.nan, 1]}, "control_points_cN must be finite, got nan at index 0"),
        ({"knots_mm": [0, 0, np.inf, np.inf]}, "knots_mm must be finite"),
    ],
)
def test_numbers_that_are_no_curve_are_refused(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        line(**fields)
