"""Designs: what was made of known parts is found again; real curves come within 3 cN; limits are kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.making import Making
from fdvv_switch.mechanism import Mechanism, design
from fdvv_switch.residual import WANTED_cN, residual_of
from fdvv_switch.spring import SpringMechanism
from fdvv_switch.target import Target, target_of
from fdvv_switch.tolerance import bump_of
from tests.mechanism.conftest import target_like

MAKING = Making()


def test_a_known_spring_is_found_again(spring: SpringMechanism) -> None:
    found = design(target_like(spring), "spring", MAKING)
    assert isinstance(found, SpringMechanism)
    assert found.coil.rate_cN_mm == pytest.approx(spring.coil.rate_cN_mm, rel=0.01)
    assert found.coil.preload_cN == pytest.approx(spring.coil.preload_cN, abs=0.5)
    assert residual_of(target_like(spring), found, MAKING).worst_cN < 0.4


def test_the_published_tactile_button_comes_out_of_a_leaf(clear: Target, clear_leaf: Mechanism) -> None:
    residual = residual_of(clear, clear_leaf, MAKING)
    assert residual.worst_cN < 1.5
    assert residual.met
    press, _ = clear_leaf.strokes_cN(clear.displacement_mm)
    wanted, got = (bump_of(clear.displacement_mm, p) for p in (clear.press_cN, press))
    assert wanted is not None
    assert got is not None
    np.testing.assert_allclose(got[:2], wanted[:2], atol=3.0)


def test_a_cam_keeps_its_limits_ends_level_and_closes_its_circuit_once(
    clear: Target, clear_leaf: Mechanism
) -> None:
    assert isinstance(clear_leaf, LeafMechanism)
    x, cam = clear.displacement_mm, clear_leaf.cam
    assert np.abs(cam.at(x, 1)).max() < 1.02 * MAKING.slope_ratio
    assert cam.curvature_1_mm(x).max() < 1.05 / MAKING.hollow_mm
    assert -cam.curvature_1_mm(x).min() < 1.05 / (MAKING.nose_mm + MAKING.edge_mm)
    assert abs(float(cam.at(np.array([cam.end_mm - 1e-6]), 1)[0])) < 1e-3
    assert (cam.at(x[x < clear.close_mm - 0.4]) > 0.0).all()
    assert (cam.at(x[x > clear.close_mm + 0.4]) < 0.02).all()


def test_a_softer_limit_lets_more_of_the_curve_through(clear: Target, clear_leaf: Mechanism) -> None:
    tight = replace(MAKING, slope_ratio=0.25)
    found = design(clear, "leaf", tight)
    residual = residual_of(clear, found, tight)
    assert residual.worst_cN > residual_of(clear, clear_leaf, MAKING).worst_cN
    assert any("be steeper than the limit of 0.25" in reason for reason in residual.reasons)


@pytest.mark.slow
def test_a_dome_comes_out_of_a_domes_curves(rubber: Target) -> None:
    rubber_dome = design(rubber, "dome", MAKING)
    assert isinstance(rubber_dome, DomeMechanism)
    assert residual_of(rubber, rubber_dome, MAKING).worst_cN <= WANTED_cN
    dome = rubber_dome.dome
    assert dome.base_mm <= MAKING.widest_mm
    assert dome.hinge_mm <= dome.wall_mm
    assert dome.hardness_shoreA % 5.0 == 0.0


def test_the_same_curves_give_the_same_design(clear: Target, clear_leaf: Mechanism) -> None:
    again = design(clear, "leaf", MAKING)
    for got, wanted in zip(
        again.strokes_cN(clear.displacement_mm), clear_leaf.strokes_cN(clear.displacement_mm), strict=True
    ):
        np.testing.assert_array_equal(got, wanted)


def test_a_coil_says_that_it_cannot_give_a_bump(clear: Target) -> None:
    residual = residual_of(clear, design(clear, "spring", MAKING), MAKING)
    assert not residual.met
    assert any("force of a coil only rises" in reason for reason in residual.reasons)


def test_a_residual_is_split_into_what_is_elastic_and_what_rubs(clear: Target, clear_leaf: Mechanism) -> None:
    residual = residual_of(clear, clear_leaf, MAKING)
    both = residual.press.rms_cN**2 + residual.release.rms_cN**2
    assert residual.elastic_cN**2 + residual.loop_cN**2 == pytest.approx(0.5 * both)


def test_what_has_no_release_or_no_travel_is_refused() -> None:
    model = load_builtin("mx-red")
    with pytest.raises(ModelError, match="no release"):
        target_of(replace(model, curves=model.of(Stroke.PRESS)))
    knots = np.array([0.0, 0.0, 0.3, 0.3])
    curves = tuple(ForceCurve(stroke, None, 1, knots, np.array([0.0, 50.0])) for stroke in Stroke)
    with pytest.raises(ModelError, match=r"0\.3 mm of travel"):
        target_of(FDVVModel("short", 0.3, curves))


def test_unknown_kinds_and_materials_are_refused(clear: Target) -> None:
    with pytest.raises(ModelError, match="one of spring, leaf, dome"):
        design(clear, "magnet", MAKING)
    with pytest.raises(ModelError, match="wire is one of"):
        Making(wire="gold")
    with pytest.raises(ModelError, match="friction_ratio"):
        Making(friction_ratio=2.0)
    with pytest.raises(ModelError, match="cannot be moulded"):
        design(replace(clear, travel_mm=0.8), "dome", MAKING)
