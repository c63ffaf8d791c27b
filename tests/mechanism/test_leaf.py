"""Leaves and cams: energy without friction, the wedge, the surface under the nose."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_switch.guide import Guide
from fdvv_switch.leaf import Cam, Leaf, LeafMechanism, choose_leaf
from fdvv_switch.making import Making
from tests.mechanism.conftest import COIL

LEAF = Leaf(0.12, 2.0, 8.0, 5.5, 1.0)
X: FloatArray = np.linspace(0.0, 3.9, 3901)


def cam(height_mm: float = 0.4) -> Cam:
    """A smooth fall of the leaf between 1 and 2.5 mm."""
    knots = np.concatenate([np.zeros(4), np.linspace(0.0, 3.2, 12)[1:-1], np.full(4, 3.2)])
    centres = np.array([knots[i + 1 : i + 4].mean() for i in range(knots.size - 4)])
    return Cam(knots, height_mm / (1.0 + np.exp((centres - 1.7) / 0.2)) - 0.1, 0.15)


def test_stiffness_and_stress_of_a_cantilever_by_hand() -> None:
    # E b t^3 / (4 L^3) = 130000 * 2 * 0.001728 / 2048 = 0.219375 N/mm; 6 P L / (b t^2) at 0.3 N: 500 MPa
    assert LEAF.stiffness_cN_mm == pytest.approx(21.9375)
    assert LEAF.stress_MPa(30.0) == pytest.approx(500.0)
    assert LEAF.preload_cN == pytest.approx(21.9375)


def test_leaf_and_fixed_contact_share_the_load_below_the_contact() -> None:
    force = LEAF.force_cN(np.array([0.1, 0.0, -0.01, -5.0]))
    assert force[0] == pytest.approx(LEAF.preload_cN + 0.1 * LEAF.stiffness_cN_mm)
    assert force[2] == pytest.approx(LEAF.preload_cN - 0.01 * (LEAF.stiffness_cN_mm + LEAF.contact_cN_mm))
    assert force[3] == 0.0


def test_without_friction_the_slider_gets_back_what_the_leaf_loses() -> None:
    mechanism = LeafMechanism(COIL, Guide(0.0, 0.0, 1e-4), LEAF, cam(), 0.0)
    press, release = mechanism.strokes_cN(X)
    np.testing.assert_allclose(press[10:], release[10:], atol=1e-9)
    work = np.trapezoid(press - COIL.preload_cN - COIL.rate_cN_mm * X, X)
    height = mechanism.cam.at(X)
    # energy of the leaf: its force over its own way
    way = np.linspace(float(height[0]), float(height[-1]), 20_001)
    assert work == pytest.approx(np.trapezoid(LEAF.force_cN(way), way), abs=0.05)


def test_friction_takes_work_in_both_directions_and_none_where_the_leaf_is_off() -> None:
    mechanism = LeafMechanism(COIL, Guide(0.0, 0.0, 1e-4), LEAF, cam(1.2), 0.2)
    press, release = mechanism.strokes_cN(X)
    force = LEAF.force_cN(mechanism.cam.at(X))
    touching = (force > 0) & (X > 0.1)
    assert (press > release)[touching].all()
    np.testing.assert_allclose(press[(force == 0) & (X > 0.1)], release[(force == 0) & (X > 0.1)])


def test_on_a_slope_the_wedge_of_the_textbook_holds() -> None:
    # a slope of 30 degrees and friction of 10 degrees: tan 40 against a press, tan 20 against a release
    knots = np.array([0.0] * 4 + [2.0] * 4)
    slope, friction = math.tan(math.radians(30)), math.tan(math.radians(10))
    ramp = Cam(knots, slope * np.array([0.0, 2.0, 4.0, 6.0]) / 3.0, 0.15)
    mechanism = LeafMechanism(COIL, Guide(0.0, 0.0, 1e-4), LEAF, ramp, friction)
    at = np.array([0.0, 1.0])
    press, release = mechanism.strokes_cN(at)
    held = LEAF.force_cN(ramp.at(at))[1]
    spring = COIL.preload_cN + COIL.rate_cN_mm
    assert (press[1] - spring) / held == pytest.approx(math.tan(math.radians(40)))
    assert (release[1] - spring) / held == pytest.approx(math.tan(math.radians(20)))


def test_a_cams_derivatives_are_its_differences() -> None:
    shape, inside = cam(), X[(X > 0.05) & (X < 3.1)]
    for order in (0, 1):
        difference = (shape.at(inside + 1e-4, order) - shape.at(inside - 1e-4, order)) / 2e-4
        np.testing.assert_allclose(shape.at(inside, order + 1), difference, atol=2e-4)
    assert (shape.at(np.array([3.5, 9.0]), 1) == 0.0).all()


def test_the_nose_touches_the_surface_everywhere_and_cuts_it_nowhere() -> None:
    shape = cam()
    x = np.linspace(0.2, 3.0, 400)
    surface, centres = shape.surface_mm(x), np.column_stack([x, shape.at(x)])
    distance = np.hypot(*(surface[:, None, :] - centres[None, :, :]).transpose(2, 0, 1))
    assert distance.min() >= shape.nose_mm - 1e-4
    np.testing.assert_allclose(np.diag(distance), shape.nose_mm, rtol=1e-9)


@given(st.floats(15.0, 60.0), st.floats(5.0, 40.0))
def test_the_chosen_leaf_has_the_stiffness_and_preload_asked_for(stiffness: float, preload: float) -> None:
    leaf = choose_leaf(preload, stiffness, preload + 5.0, Making())
    assert leaf.stiffness_cN_mm == pytest.approx(stiffness, rel=0.04)
    assert leaf.preload_cN == pytest.approx(preload, abs=0.006 * leaf.stiffness_cN_mm)
    assert leaf.stress_MPa(preload + 5.0) <= leaf.strip.bending_MPa


def test_a_leaf_that_would_yield_or_cannot_be_cut_is_refused() -> None:
    with pytest.raises(ModelError, match="permissible"):
        choose_leaf(60.0, 5.0, 300.0, Making(strip="bronze"))
    with pytest.raises(ModelError, match="no strip"):
        choose_leaf(20.0, 1e6, 20.0, Making())
