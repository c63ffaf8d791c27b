"""Springs: formulas by hand and by energy, what fits and what does not."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_switch.coil import Coil, Envelope, choose_coil
from fdvv_switch.material import WIRES
from tests.mechanism.conftest import COIL


def test_a_rate_is_what_can_be_done_by_hand() -> None:
    # d 0.5, D 5, n 10: G d^4 / (8 D^3 n) = 81500 * 0.0625 / 10000 = 0.509375 N/mm
    coil = Coil(0.5, 5.0, 10.0, 20.0, 18.0)
    assert coil.rate_cN_mm == pytest.approx(50.9375)
    assert coil.preload_cN == pytest.approx(101.875)
    assert coil.solid_mm == pytest.approx(6.0)


def test_the_rate_is_that_of_a_twisted_wire() -> None:
    # Castigliano: the force twists n pi D of wire by F D / 2; the way is dU/dF of T^2 l / (2 G J)
    length, lever = COIL.active * math.pi * COIL.mean_mm, 0.5 * COIL.mean_mm
    polar = math.pi * COIL.wire_mm**4 / 32.0
    assert COIL.rate_cN_mm == pytest.approx(100.0 * COIL.wire.shear_MPa * polar / (length * lever**2))


def test_stress_exceeds_that_of_a_straight_wire_by_wahls_factor() -> None:
    force_N = (COIL.preload_cN + 4.0 * COIL.rate_cN_mm) / 100.0
    straight = 16.0 * force_N * 0.5 * COIL.mean_mm / (math.pi * COIL.wire_mm**3)
    # index 14: (4 * 14 - 1) / (4 * 14 - 4) + 0.615 / 14
    assert COIL.stress_MPa(4.0) / straight == pytest.approx(55.0 / 52.0 + 0.615 / 14.0)


def test_a_short_spring_never_buckles_and_a_longer_one_buckles_sooner() -> None:
    assert replace(COIL, free_mm=7.0, built_mm=6.5).buckles_mm() is None
    ways = [replace(COIL, free_mm=length).buckles_mm() for length in (20.0, 24.0, 28.0)]
    assert all(way is not None for way in ways)
    parts = [way / length for way, length in zip(ways, (20.0, 24.0, 28.0), strict=True) if way]
    assert parts == sorted(parts, reverse=True)


@given(st.floats(25.0, 60.0), st.floats(6.0, 16.0))
def test_the_chosen_spring_gives_what_is_asked_fits_and_holds(preload_cN: float, rate_cN_mm: float) -> None:
    space = Envelope()
    coil = choose_coil(preload_cN, rate_cN_mm, 4.0, space)
    assert coil.rate_cN_mm == pytest.approx(rate_cN_mm, rel=0.01)
    assert coil.preload_cN == pytest.approx(preload_cN, abs=0.03 * rate_cN_mm)
    assert coil.mean_mm + coil.wire_mm <= space.outer_mm
    assert coil.mean_mm - coil.wire_mm >= space.inner_mm
    assert coil.solid_mm < space.built_mm - 4.0
    assert coil.stress_ratio(4.0) <= 1.0


def test_what_stands_in_the_way_of_a_spring_is_said() -> None:
    with pytest.raises(ModelError, match="longer than 24 mm"):
        choose_coil(80.0, 2.0, 4.0, Envelope())
    with pytest.raises(ModelError, match="coils would touch"):
        choose_coil(30.0, 5.0, 4.0, Envelope(built_mm=5.0))
    with pytest.raises(ModelError, match="rate above 0"):
        choose_coil(30.0, -1.0, 4.0, Envelope())


def test_thicker_wire_is_weaker_per_area_and_an_unlisted_one_is_refused() -> None:
    for wire in WIRES.values():
        strengths = [wire.tensile_MPa(d) for d in (0.14, 0.2, 0.25, 0.3, 0.38)]
        assert strengths == sorted(strengths, reverse=True)
    with pytest.raises(ModelError, match="not listed"):
        WIRES["steel"].tensile_MPa(1.0)


def test_sizes_of_nothing_are_refused() -> None:
    with pytest.raises(ModelError, match="above 0"):
        Coil(0.0, 3.5, 8.0, 12.5, 9.5)
    with pytest.raises(ModelError, match="wire is one of"):
        Coil(0.25, 3.5, 8.0, 12.5, 9.5, "cheese")
    with pytest.raises(ModelError, match="inner < outer"):
        Envelope(outer_mm=2.0)
