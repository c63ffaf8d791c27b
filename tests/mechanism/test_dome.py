"""Domes: the coned disc spring where cones are flat, the energy of rubber, Gent's relation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_switch.dome import Dome, DomeMechanism, Pin, cone_force_N
from fdvv_switch.guide import Guide
from fdvv_switch.material import hardness_shoreA, rubber_MPa

DOME = Dome(10.0, 4.0, 2.4, 0.6, 0.4, 50.0, 0.1)


def almen_laszlo_N(
    s: FloatArray, outer: float, inner: float, height: float, wall: float, young: float, poisson: float
) -> FloatArray:
    """Write the coned disc spring's force as DIN EN 16984 prints it."""
    d = outer / inner
    k1 = ((d - 1) / d) ** 2 / (math.pi * ((d + 1) / (d - 1) - 2 / math.log(d)))
    steep = (height / wall - s / wall) * (height / wall - s / (2 * wall)) + 1
    scale = 4 * young / (1 - poisson**2) * wall**4 / (k1 * (2 * outer) ** 2)
    return np.asarray(scale * s / wall * steep)


@pytest.mark.parametrize(("height", "wall"), [(0.3, 0.4), (0.6, 0.4), (0.9, 0.5)])
def test_a_flat_cone_is_the_coned_disc_spring_of_almen_and_laszlo(height: float, wall: float) -> None:
    s = np.linspace(0.0, 1.5 * height, 30)
    got = cone_force_N(s, 20.0, 10.0, height, wall, 206_000.0, 0.3)
    wanted = almen_laszlo_N(s, 20.0, 10.0, height, wall, 206_000.0, 0.3)
    np.testing.assert_allclose(got, wanted, atol=0.01 * float(np.abs(wanted).max()))


def test_a_high_thin_cone_snaps_and_a_low_thick_one_does_not() -> None:
    # the disc spring's force has a fall only where height over thickness exceeds the root of 2
    s = np.linspace(0.0, 0.6, 200)
    for height, snaps in ((0.9, True), (0.5, False)):
        force = cone_force_N(s, 20.0, 10.0, height, 0.4, 206_000.0, 0.3)
        assert bool((np.diff(force) < 0).any()) is snaps


def test_force_is_what_the_energy_of_the_strained_wall_gives_back() -> None:
    s = np.linspace(0.0, 3.0, 3001)
    radii, height, wall, young = (5.0, 2.0), 2.4, 0.6, 2.0
    force = cone_force_N(s, *radii, height, wall, young)
    outer, inner = radii
    meridian, first = math.hypot(outer - inner, height), math.atan2(height, outer - inner)
    neutral = (outer - inner) / math.log(outer / inner)

    def energy(pressed: float) -> float:
        """Sum the hoop energy over a fine grid of the section, as slowly as can be read."""
        angle = math.asin((height - pressed) / meridian)
        u = np.linspace((inner - neutral) / math.cos(first), (outer - neutral) / math.cos(first), 400)
        z = np.linspace(-wall / 2, wall / 2, 80)
        along, across = np.meshgrid(u, z, indexing="ij")
        before = neutral + along * math.cos(first) + across * math.sin(first)
        after = neutral + along * math.cos(angle) + across * math.sin(angle)
        density = 0.5 * young / (1 - 0.49**2) * ((after - before) / before) ** 2 * 2 * math.pi * before
        return float(np.trapezoid(np.trapezoid(density, z, axis=1), u))

    work = np.trapezoid(force[:2001], s[:2001])
    assert work == pytest.approx(energy(2.0) - energy(0.0), rel=1e-3)


def test_a_dome_grows_with_its_rubber_in_proportion() -> None:
    x = np.linspace(0.0, 3.5, 50)
    ratio = rubber_MPa(70.0) / rubber_MPa(50.0)
    np.testing.assert_allclose(replace(DOME, hardness_shoreA=70.0).force_cN(x), ratio * DOME.force_cN(x))


@given(st.floats(20.0, 85.0))
def test_gents_relation_goes_there_and_back(hardness: float) -> None:
    assert hardness_shoreA(rubber_MPa(hardness)) == pytest.approx(hardness)


def test_gents_relation_gives_the_published_modulus_and_has_bounds() -> None:
    # by hand: 0.0981 (56 + 381.168) / (0.137505 (254 - 127)) = 2.456 MPa at 50 Shore A
    assert rubber_MPa(50.0) == pytest.approx(2.456, abs=1e-3)
    with pytest.raises(ModelError, match="20 to 85"):
        rubber_MPa(95.0)


def test_a_dome_without_a_wall_is_refused() -> None:
    with pytest.raises(ModelError, match="top narrower"):
        replace(DOME, top_mm=11.0)
    with pytest.raises(ModelError, match="hinge"):
        replace(DOME, hinge_mm=-0.1)


def test_a_pad_adds_its_own_way_to_that_of_the_dome() -> None:
    pad, foot = Pin(2.0, 1.0, 30.0), Pin(0.0, 1.0, 50.0)
    bare = DomeMechanism(DOME, Guide(0.0, 0.0, 1e-4), foot, 9.0)
    padded = replace(bare, pad=pad)
    top = np.linspace(0.0, 3.0, 800)
    force = DOME.force_cN(top)
    key = top + (force - force[0]) / pad.stiffness_cN_mm
    assert (np.diff(key) > 0).all()
    press, release = padded.strokes_cN(key)
    np.testing.assert_allclose(press[20:], force[20:], atol=0.05)
    np.testing.assert_array_equal(press, release)
    np.testing.assert_allclose(bare.strokes_cN(top)[0][20:], force[20:], atol=0.05)


def test_over_a_pad_that_is_too_soft_the_key_jumps_and_never_goes_back() -> None:
    thin = replace(DOME, wall_mm=0.3, hinge_mm=0.1, hardness_shoreA=75.0)
    soft = DomeMechanism(thin, Guide(0.0, 0.0, 1e-4), Pin(0.0, 1.0, 50.0), 9.0, Pin(0.9, 2.0, 30.0))
    press, _ = soft.strokes_cN(np.linspace(0.0, 6.0, 2000))
    assert np.diff(press).min() < -1.0
    assert np.isfinite(press).all()
