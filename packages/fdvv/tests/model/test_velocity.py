import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline, PchipInterpolator

from fdvv.errors import ModelError
from fdvv.model.bspline import uniform_knots
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.velocity import Interpolation

ROOT = Path(__file__).parents[4]
CLEAR = load_builtin("mx-clear")
SPEEDS_mm_s = CLEAR.velocities_mm_s("press")
SHARED_FIRST = BSpline(CLEAR.curves[0].knots_mm, CLEAR.curves[0].control_points_cN, 3)
X_mm = np.linspace(-0.5, 4.5, 401)


def with_method(method: Interpolation) -> FDVVModel:
    return FDVVModel("clear", 4.0, CLEAR.curves, interpolation=method)


def flat(velocity_mm_s: float | None, force_cN: float) -> ForceCurve:
    """A curve of constant force."""
    return ForceCurve(Stroke.PRESS, velocity_mm_s, 1, uniform_knots(0, 4, 2, 1), np.full(2, force_cN))


def flat_model(forces_cN: dict[float, float], method: Interpolation) -> FDVVModel:
    return FDVVModel("flat", 4.0, tuple(flat(v, f) for v, f in forces_cN.items()), interpolation=method)


@pytest.mark.parametrize("method", Interpolation)
@pytest.mark.parametrize("curve", CLEAR.curves, ids=lambda c: f"{c.stroke}-{c.velocity_mm_s}")
def test_at_a_measured_velocity_the_measured_curve_answers_to_the_bit(
    method: Interpolation, curve: ForceCurve
) -> None:
    model = with_method(method)
    at = (X_mm, curve.velocity_mm_s, curve.stroke)
    np.testing.assert_array_equal(model.force_cN(*at), curve.force_cN(X_mm))  # type: ignore[arg-type]
    np.testing.assert_array_equal(model.stiffness_cN_mm(*at), curve.stiffness_cN_mm(X_mm))  # type: ignore[arg-type]


@pytest.mark.parametrize("method", Interpolation)
def test_beyond_the_measured_velocities_the_end_curve_holds(method: Interpolation) -> None:
    model = with_method(method)
    for wanted, held in ((0.01, 0.5), (260.0, 200.0), (1e6, 200.0)):
        np.testing.assert_array_equal(model.force_cN(X_mm, wanted), model.force_cN(X_mm, held))
        np.testing.assert_array_equal(model.damping_cN_s_mm(X_mm, wanted), 0.0)


@pytest.mark.parametrize("method", [Interpolation.LINEAR, Interpolation.PCHIP])
@pytest.mark.parametrize("speed", SPEEDS_mm_s)
def test_the_force_is_continuous_where_one_pair_of_curves_hands_over_to_the_next(
    method: Interpolation, speed: float
) -> None:
    model = with_method(method)
    around = model.force_cN(X_mm[:, np.newaxis], [speed - 1e-9, speed, speed + 1e-9])
    assert np.ptp(around, axis=1).max() < 1e-7


def test_linear_goes_half_way_half_way() -> None:
    model = flat_model({50.0: 40.0, 100.0: 60.0, 200.0: 80.0}, Interpolation.LINEAR)
    np.testing.assert_allclose(model.force_cN(1.0, [75.0, 125.0]), [50.0, 65.0])
    np.testing.assert_allclose(model.damping_cN_s_mm(1.0, [75.0, 125.0]), [0.4, 0.2])


def test_nearest_takes_the_nearer_curve_and_the_slower_one_half_way() -> None:
    model = flat_model({50.0: 40.0, 100.0: 60.0}, Interpolation.NEAREST)
    np.testing.assert_array_equal(model.force_cN(1.0, [74.0, 75.0, 76.0]), [40.0, 40.0, 60.0])
    np.testing.assert_array_equal(model.damping_cN_s_mm(1.0, [74.0, 75.0, 76.0]), 0.0)


@pytest.mark.parametrize("stroke", Stroke)
def test_pchip_is_scipys(stroke: Stroke) -> None:
    rng = np.random.default_rng(1)
    x, v = rng.uniform(0, 4, 200), rng.uniform(0.5, 200, 200)
    per_point = [PchipInterpolator(SPEEDS_mm_s, [float(c.force_cN(a)) for c in CLEAR.of(stroke)]) for a in x]
    force = [float(p(b)) for p, b in zip(per_point, v, strict=True)]
    slope = [float(p(b, 1)) for p, b in zip(per_point, v, strict=True)]
    np.testing.assert_allclose(CLEAR.force_cN(x, v, stroke), force, rtol=0, atol=1e-11)
    np.testing.assert_allclose(CLEAR.damping_cN_s_mm(x, v, stroke), slope, rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", Interpolation)
def test_two_curves_are_blended_linearly_and_one_serves_every_velocity(method: Interpolation) -> None:
    alone = FDVVModel("alone", 4.0, (flat(None, 33.0),), interpolation=method)
    np.testing.assert_array_equal(alone.force_cN([0.0, 2.0], [0.5, 300.0]), 33.0)
    np.testing.assert_array_equal(alone.damping_cN_s_mm([0.0, 2.0], [0.5, 300.0]), 0.0)
    pair = flat_model({50.0: 40.0, 100.0: 60.0}, method)
    if method is not Interpolation.NEAREST:
        assert float(pair.force_cN(1.0, 60.0)) == pytest.approx(44.0)


@settings(max_examples=60, deadline=None)
@given(
    speeds=st.lists(st.integers(1, 400), min_size=2, max_size=6, unique=True),
    forces=st.lists(st.floats(-50, 150), min_size=6, max_size=6),
    wanted=st.floats(0.1, 500),
    method=st.sampled_from(Interpolation),
)
def test_a_blend_never_leaves_the_range_of_the_two_curves_beside_it(
    speeds: list[int], forces: list[float], wanted: float, method: Interpolation
) -> None:
    known = dict(zip(sorted(float(s) for s in speeds), forces, strict=False))
    force = float(flat_model(known, method).force_cN(1.0, wanted))
    slower = [f for s, f in known.items() if s <= wanted][-1:] or list(known.values())[:1]
    faster = [f for s, f in known.items() if s >= wanted][:1] or list(known.values())[-1:]
    low, high = sorted((slower[0], faster[0]))
    assert low - 1e-9 <= force <= high + 1e-9


@pytest.mark.parametrize("method", Interpolation)
@pytest.mark.parametrize("stroke", Stroke)
def test_stiffness_is_the_slope_of_the_force_over_displacement(method: Interpolation, stroke: Stroke) -> None:
    rng = np.random.default_rng(2)
    x, v, step = rng.uniform(0.01, 3.99, 500), rng.uniform(0.3, 230, 500), 1e-6
    model = with_method(method)
    difference = (model.force_cN(x + step, v, stroke) - model.force_cN(x - step, v, stroke)) / (2 * step)
    np.testing.assert_allclose(model.stiffness_cN_mm(x, v, stroke), difference, rtol=0, atol=1e-5)


@pytest.mark.parametrize("method", [Interpolation.LINEAR, Interpolation.PCHIP])
@pytest.mark.parametrize("stroke", Stroke)
def test_damping_is_the_slope_of_the_force_over_velocity(method: Interpolation, stroke: Stroke) -> None:
    rng = np.random.default_rng(3)
    x, v, step = rng.uniform(0, 4, 500), rng.uniform(0.6, 199, 500), 1e-5
    model = with_method(method)
    difference = (model.force_cN(x, v + step, stroke) - model.force_cN(x, v - step, stroke)) / (2 * step)
    np.testing.assert_allclose(model.damping_cN_s_mm(x, v, stroke), difference, rtol=0, atol=1e-7)


def test_displacements_and_velocities_broadcast() -> None:
    x, v = np.linspace(0, 4, 9)[np.newaxis, :], np.array([1.0, 75.0, 180.0])[:, np.newaxis]
    table = CLEAR.force_cN(x, v, "release")
    assert table.shape == (3, 9)
    assert table[1, 4] == CLEAR.force_cN(2.0, 75.0, "release")
    assert CLEAR.force_cN(2.0, 75.0).shape == ()


def test_a_stroke_without_a_curve_is_refused_by_name() -> None:
    model = FDVVModel("half", 4.0, (flat(None, 1.0),))
    with pytest.raises(ModelError, match="'half' has no release curve"):
        model.force_cN(1.0, 50.0, "release")


def test_the_documented_table_is_what_the_benchmark_prints() -> None:
    command = [sys.executable, "-m", "benchmarks.velocity_interpolation"]
    printed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=50).stdout
    assert "pchip" in printed
    assert printed.strip() in (ROOT / "docs" / "explanation" / "velocity.md").read_text()


@pytest.mark.parametrize("method", Interpolation)
def test_curves_on_knots_of_their_own_blend_as_curves_on_shared_knots(method: Interpolation) -> None:
    shared = with_method(method)
    # a knot inserted into one curve changes its numbers but not its course
    first = SHARED_FIRST.insert_knot(1.0)
    own = ForceCurve(Stroke.PRESS, 0.5, 3, first.t, first.c[: first.t.size - 4])
    apart = replace(shared, curves=(own, *shared.curves[1:]))
    v = np.array([0.5, 20.0, 75.0, 260.0])[:, np.newaxis]
    for ask in ("force_cN", "stiffness_cN_mm", "damping_cN_s_mm"):
        np.testing.assert_allclose(
            getattr(apart, ask)(X_mm, v), getattr(shared, ask)(X_mm, v), rtol=0, atol=1e-10
        )
