"""Spaces of variations of a button."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin, model_from_json, model_to_json
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.model_space import (
    handles,
    model_of,
    model_parameters,
    model_space,
    monotone_constraint,
    neutral_design,
)
from fdvv_people.optimize.problem import Problem
from fdvv_people.task.score import Objective

CLEAR, RED, DOME = (load_builtin(name) for name in ("mx-clear", "mx-red", "rubber-dome"))
X = np.linspace(0.3, 3.8, 60)
ALL = [one.name for one in model_parameters(CLEAR)]


def neutral(names: list[str]) -> dict[str, float]:
    known = handles(CLEAR)
    return {name: known[name].neutral for name in names}


@pytest.mark.parametrize("names", [["FDV"], ["FDVV"], ALL], ids=["FDV", "FDVV", "all"])
def test_neutral_values_leave_the_button_as_it_is(names: list[str]) -> None:
    space = model_space(CLEAR, names)
    assert neutral_design(space, CLEAR) == neutral(list(space.names))
    same = model_of(CLEAR, neutral_design(space, CLEAR))
    for stroke in Stroke:
        for v in (50.0, 125.0, 200.0):
            np.testing.assert_allclose(
                same.force_cN(X, v, stroke), CLEAR.force_cN(X, v, stroke), rtol=1e-9, atol=1e-9
            )
    assert (same.travel_mm, same.actuation_mm, same.reset_mm) == (4.0, 2.0, 2.0)
    assert same.vibrations == CLEAR.vibrations


def test_full_fdvv_has_a_scale_for_every_velocity_and_fdv_has_none() -> None:
    speeds = {f"force_at_{v}_mm_s_ratio" for v in ("0p5", "50", "100", "150", "200")}
    assert speeds <= set(model_space(CLEAR, ["FDVV"]).names)
    assert not speeds & set(model_space(CLEAR, ["FDV"]).names)


def test_a_velocity_scale_changes_its_own_curves_alone() -> None:
    made = model_of(CLEAR, {"force_at_100_mm_s_ratio": 1.5})
    for stroke in Stroke:
        np.testing.assert_allclose(made.force_cN(X, 100.0, stroke), 1.5 * CLEAR.force_cN(X, 100.0, stroke))
        np.testing.assert_array_equal(made.force_cN(X, 50.0, stroke), CLEAR.force_cN(X, 50.0, stroke))


def test_force_stiffness_and_contrast_are_exact_on_the_curve() -> None:
    made = model_of(CLEAR, {"force_ratio": 2.0, "stiffness_cN_mm": 5.0, "bump_ratio": 1.0})
    np.testing.assert_allclose(made.force_cN(X, 50.0), 2.0 * CLEAR.force_cN(X, 50.0) + 5.0 * X)
    plain = model_of(CLEAR, {"force_ratio": 1.0, "stiffness_cN_mm": 0.0, "bump_ratio": 0.0})
    bend = np.diff(plain.force_cN(np.linspace(0.5, 3.5, 9), 50.0), 2)
    np.testing.assert_allclose(bend, 0.0, atol=1e-9)


@pytest.mark.parametrize("snap_mm", [0.2, 0.8])
def test_an_added_bump_is_where_and_as_high_as_asked(snap_mm: float) -> None:
    design = {"bump_cN": 30.0, "bump_mm": 1.8, "snap_mm": snap_mm, "bump_ratio": 0.0}
    made, plain = (model_of(RED, {**design, "bump_cN": c}) for c in (30.0, 0.0))
    added = made.force_cN(X, 50.0) - plain.force_cN(X, 50.0)
    assert added.max() == pytest.approx(30.0, abs=0.5)
    assert X[int(added.argmax())] == pytest.approx(1.8, abs=0.07)
    np.testing.assert_allclose(added[(X < 0.75) | (1.85 + snap_mm < X)], 0.0, atol=0.3)
    found = find_bump(X, made.force_cN(X, 50.0))
    assert found is not None
    assert found.peak_mm == pytest.approx(1.8, abs=0.15)


def test_travel_stretches_everything_along_it() -> None:
    made = model_of(CLEAR, {"travel_mm": 3.0})
    np.testing.assert_allclose(made.force_cN(0.75 * X, 50.0), CLEAR.force_cN(X, 50.0), rtol=1e-9)
    assert (made.travel_mm, made.actuation_mm) == (3.0, 1.5)
    assert made.vibrations[0].onset_mm == pytest.approx(0.75 * 2.3)


def test_a_reset_that_is_not_named_follows_the_actuation() -> None:
    early = model_of(CLEAR, {"actuation_mm": 1.0})
    assert (early.actuation_mm, early.reset_mm) == (1.0, 1.0)
    late = model_of(CLEAR, {"actuation_mm": 3.0})
    assert (late.actuation_mm, late.reset_mm) == (3.0, 2.0)


def test_vibration_takes_gain_frequency_and_onset() -> None:
    design = {"vibration_gain_ratio": 0.5, "vibration_Hz": 120.0, "vibration_mm": 1.5}
    (mode,) = model_of(CLEAR, design).vibrations[0].modes
    assert (mode.amplitude_m_s2, mode.frequency_Hz) == pytest.approx((2.3, 120.0))
    assert model_of(CLEAR, design).vibrations[1].onset_mm == 1.5


def test_a_single_control_point_is_a_parameter_too() -> None:
    space = model_space(CLEAR, ["press_50_point3_cN"])
    (low, high) = space.parameters[0].low, space.parameters[0].high
    made = model_of(CLEAR, {"press_50_point3_cN": high})
    (curve,) = (c for c in made.of("press") if c.velocity_mm_s == 50.0)
    assert curve.control_points_cN[3] == high
    assert high - low == pytest.approx(60.0)


def test_what_the_button_does_not_have_is_refused_with_what_it_has() -> None:
    with pytest.raises(InputError, match="bump_cN"):
        model_space(CLEAR, ["colour"])
    with pytest.raises(InputError, match="travel_mm"):
        model_space(CLEAR, ["force_ratio"], {"travel_mm": (3.0, 4.0)})


def test_constraints_are_broken_where_they_should_be() -> None:
    space = model_space(CLEAR, ["travel_mm", "actuation_mm", "reset_mm", "force_ratio"])
    good = {"travel_mm": 4.0, "actuation_mm": 2.0, "reset_mm": 1.8, "force_ratio": 1.0}
    names = [one.name for one in space.constraints]
    assert names == ["travel", "order", "force"]
    assert space.broken(good) == ()
    bad = {"travel": {"travel_mm": 2.4, "actuation_mm": 2.35}, "order": {"reset_mm": 2.1}}
    for name, change in bad.items():
        assert name in [one.name for one in space.broken({**good, **change})]
    weak = model_space(CLEAR, ["stiffness_cN_mm"], {"stiffness_cN_mm": (-60.0, 0.0)})
    assert [one.name for one in weak.broken({"stiffness_cN_mm": -50.0})] == ["force"]


def test_slack_goes_to_zero_where_a_constraint_begins_to_break() -> None:
    space = model_space(CLEAR, ["stiffness_cN_mm"], {"stiffness_cN_mm": (-60.0, 0.0)})
    force = space.constraints[-1]
    slack = np.array([force.slack({"stiffness_cN_mm": float(k)}) for k in np.linspace(-60, 0, 241)])
    assert slack[0] < 0 < slack[-1]
    assert np.abs(np.diff(slack)).max() < 2.0


def test_a_faster_press_may_be_asked_not_to_be_softer() -> None:
    monotone = monotone_constraint(DOME)
    assert monotone.slack({"force_at_200_mm_s_ratio": 2.0}) >= 0
    assert monotone.slack({"force_at_200_mm_s_ratio": 0.5}) < 0


@pytest.mark.slow
def test_designs_of_the_whole_space_are_buttons_that_a_file_holds() -> None:
    space = model_space(CLEAR, ["FDVV", "travel_mm", "reset_mm"])
    designs = engine_of("sobol").suggest(Problem(space, (Objective("asynchrony_ms"),), 1), [], 12)
    for design in designs:
        model = model_of(CLEAR, design, "made")
        assert model_from_json(model_to_json(model)) == model
        assert model.provenance.licence == CLEAR.provenance.licence
        assert "mx-clear with" in model.provenance.method
