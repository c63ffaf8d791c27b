import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.edit import splice
from fdvv.model.file import load_builtin
from tests.model.strategies import curves

SLOW, FAST = (load_builtin("mx-clear").of("press")[i] for i in (0, 3))


@st.composite
def segments(draw: st.DrawFn) -> tuple[float, float]:
    a, b = sorted(draw(st.tuples(st.floats(0, 4), st.floats(0, 4))))
    return (a, b) if b - a > 1e-3 else (max(0.0, a - 0.1), min(4.0, b + 0.1))


@settings(max_examples=80, deadline=None)
@given(curves(Stroke.PRESS), curves(Stroke.RELEASE), segments(), st.floats(0.01, 1.0))
def test_a_splice_is_the_insert_on_the_segment_and_the_base_beyond_the_blend(
    base: ForceCurve, insert: ForceCurve, segment_mm: tuple[float, float], blend_mm: float
) -> None:
    a, b = segment_mm
    spliced = splice(base, insert, segment_mm, blend_mm)
    x = np.linspace(0, 4, 801)
    inside = np.concatenate([x[(x > a) & (x < b)], [a, b]])
    outside = x[(x < a - blend_mm - 1e-8) | (x > b + blend_mm + 1e-8)]
    np.testing.assert_allclose(spliced.force_cN(inside), insert.force_cN(inside), rtol=0, atol=1e-9)
    np.testing.assert_allclose(spliced.force_cN(outside), base.force_cN(outside), rtol=0, atol=1e-9)
    assert (spliced.stroke, spliced.velocity_mm_s) == (base.stroke, base.velocity_mm_s)
    assert (spliced.start_mm, spliced.end_mm) == (base.start_mm, base.end_mm)


@pytest.mark.parametrize("segment_mm", [(1.0, 2.0), (0.55, 2.0), (0.04, 3.97), (0.0, 1.0), (2.0, 4.0)])
def test_force_and_slope_are_continuous_over_the_whole_splice(segment_mm: tuple[float, float]) -> None:
    spliced = splice(SLOW, FAST, segment_mm, 0.1)
    at = np.unique(spliced.knots_mm)[1:-1]
    for values in (spliced.force_cN, spliced.stiffness_cN_mm):
        np.testing.assert_allclose(values(at - 1e-9), values(at + 1e-9), rtol=0, atol=1e-4)


def test_control_points_away_from_the_segment_stay_as_they_are() -> None:
    spliced = splice(SLOW, FAST, (1.0, 2.0), 0.1)
    np.testing.assert_array_equal(spliced.control_points_cN[:3], SLOW.control_points_cN[:3])
    np.testing.assert_array_equal(spliced.control_points_cN[-5:], SLOW.control_points_cN[-5:])


def test_a_segment_over_the_whole_curve_is_the_insert() -> None:
    spliced = splice(SLOW, FAST, (0.0, 4.0), 0.1)
    np.testing.assert_array_equal(spliced.knots_mm, FAST.knots_mm)
    np.testing.assert_array_equal(spliced.control_points_cN, FAST.control_points_cN)


def test_splicing_a_curve_into_itself_moves_it_only_in_the_blend() -> None:
    x = np.linspace(0, 4, 801)
    change = splice(SLOW, SLOW, (1.0, 2.0), 0.1).force_cN(x) - SLOW.force_cN(x)
    blend = ((x > 0.9) & (x < 1.0)) | ((x > 2.0) & (x < 2.1))
    assert np.abs(change[~blend]).max() < 1e-12
    assert np.abs(change).max() < 0.1


@pytest.mark.parametrize(
    ("segment_mm", "blend_mm", "said"),
    [
        ((2.0, 1.0), 0.1, "must rise, got 2 to 1 mm"),
        ((1.0, 1.0), 0.1, "must rise"),
        ((1.0, np.nan), 0.1, "must rise"),
        ((1.0, 2.0), 0.0, "blend_mm must be positive, got 0.0"),
        ((-0.1, 2.0), 0.1, "segment -0.1 to 2 mm leaves the edited curve, which reaches from 0 to 4 mm"),
        ((3.0, 4.5), 0.1, "leaves the edited curve"),
    ],
)
def test_a_segment_that_cannot_be_is_refused(
    segment_mm: tuple[float, float], blend_mm: float, said: str
) -> None:
    with pytest.raises(ModelError, match=said):
        splice(SLOW, FAST, segment_mm, blend_mm)


def test_a_segment_beyond_the_assigned_curve_is_refused() -> None:
    short = ForceCurve(Stroke.PRESS, 50.0, 1, [0, 0, 3, 3], [0, 60])  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="leaves the assigned curve, which reaches from 0 to 3 mm"):
        splice(SLOW, short, (1.0, 3.5), 0.1)


def test_a_curve_that_jumps_is_not_raised_in_degree() -> None:
    step = ForceCurve(Stroke.PRESS, 50.0, 1, [0, 0, 2, 2, 4, 4], [0, 1, 5, 6])  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="degree 1 with a jump cannot be raised to degree 3"):
        splice(SLOW, step, (1.0, 3.0), 0.1)
