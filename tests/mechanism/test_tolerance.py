"""Tolerances: the band of a coil against the sum of its parts, and what matters most."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.units import FloatArray
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.facts import facts_of, notes_of
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.mechanism import Mechanism, varied
from fdvv_switch.spring import SpringMechanism
from fdvv_switch.target import Target
from fdvv_switch.tolerance import band_of, bump_of, tolerances_of

X: FloatArray = np.linspace(0.2, 3.9, 60)


def test_a_change_by_path_changes_that_number_alone(spring: SpringMechanism) -> None:
    changed = varied(spring, {"coil.wire_mm": 0.01, "guide.drag_cN": 1.0})
    assert isinstance(changed, SpringMechanism)
    assert changed.coil.wire_mm == pytest.approx(spring.coil.wire_mm + 0.01)
    assert changed.guide.drag_cN == pytest.approx(spring.guide.drag_cN + 1.0)
    assert changed.coil.mean_mm == spring.coil.mean_mm


def test_the_bands_width_is_the_root_of_the_sum_of_what_tolerances_do_alone(spring: SpringMechanism) -> None:
    band = band_of(spring, X, draws=1500)
    half = 0.5 * (band.press_high_cN - band.press_low_cN)
    alone = [
        0.5 * (varied(spring, {t.path: t.half}).strokes_cN(X)[0])
        - 0.5 * varied(spring, {t.path: -t.half}).strokes_cN(X)[0]
        for t in tolerances_of(spring)
    ]
    # a tolerance is 2 sigma, cut off there: a normal so cut has 0.88 of its sigma; 5 to 95 % is 1.645 of it
    wanted = 1.645 * 0.5 * 0.88 * np.sqrt(np.sum(np.square(alone), axis=0))
    np.testing.assert_allclose(half, wanted, rtol=0.12)


def test_shares_are_sorted_and_name_their_sources(spring: SpringMechanism) -> None:
    shares = band_of(spring, X, draws=20).shares
    assert [s.rms_cN for s in shares] == sorted((s.rms_cN for s in shares), reverse=True)
    assert all(s.tolerance.source for s in shares)
    assert {s.tolerance.name for s in shares[:2]} == {"wire diameter", "coil diameter"}


def test_the_design_lies_in_its_band_and_the_same_seed_repeats_it(
    clear: Target, clear_leaf: Mechanism
) -> None:
    x = clear.displacement_mm
    band, again = (band_of(clear_leaf, x, draws=60, seed=3) for _ in range(2))
    np.testing.assert_array_equal(band.press_low_cN, again.press_low_cN)
    press, _ = clear_leaf.strokes_cN(x)
    inside = (press >= band.press_low_cN - 1e-9) & (press <= band.press_high_cN + 1e-9)
    assert inside.mean() > 0.99
    bump = bump_of(x, press)
    assert bump is not None
    assert band.peak_cN is not None
    assert band.peak_cN[0] < bump[0] < band.peak_cN[1]


def test_hardness_matters_most_for_a_dome(rubber: Target, rubber_dome: DomeMechanism) -> None:
    assert band_of(rubber_dome, rubber.displacement_mm[::10], draws=20).shares[0].tolerance.name == "hardness"


def test_every_fact_is_a_finite_number_or_a_word(
    clear: Target, clear_leaf: Mechanism, rubber: Target, rubber_dome: DomeMechanism
) -> None:
    for target, mechanism in ((clear, clear_leaf), (rubber, rubber_dome)):
        facts = facts_of(mechanism, target)
        numbers = [v for part in facts.values() for v in part.values() if not isinstance(v, str)]
        assert np.isfinite(numbers).all()
        assert all(note.strip() for note in notes_of(mechanism, target))
    assert facts_of(clear_leaf, clear)["spring"]["stress_ratio"] < 1.0  # type: ignore[operator]


def test_a_size_smaller_than_its_tolerance_is_not_driven_below_nothing(clear_leaf: Mechanism) -> None:
    assert isinstance(clear_leaf, LeafMechanism)
    slack = replace(clear_leaf, leaf=replace(clear_leaf.leaf, offset_mm=0.01))
    band = band_of(slack, X, draws=20)
    assert np.isfinite(band.press_low_cN).all()
