"""Modes shared by several speeds, and ring-downs fitted again with them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import FitError
from fdvv.model.curve import Stroke
from fdvv.vibration.damped import DampedMode
from fdvv.vibration.pool import MeasuredVibration, measure_vibration, snap_energy
from fdvv.vibration.ring import Ring
from fdvv.vibration.shared import (
    PacePresses,
    SharedMode,
    common_mode,
    common_rings,
    fit_scaling,
    measure_paces,
    refit_shared,
)
from fdvv.vibration.snap import NotFound
from tests.support.snaps import ENERGY, DECAY_1_s, FREQUENCY_Hz, made_press


def ring(*modes: tuple[float, float, float, float]) -> Ring:
    """Make a ring of modes (frequency, its error, decay, its error)."""
    made = tuple(DampedMode(f, d, 1.0, 0.0, f_sd, d_sd, 0.1) for f, f_sd, d, d_sd in modes)
    return Ring(made[0], made, made, np.ones((3, len(made))), 0.0, 1.0)


def test_one_pace_that_a_drive_bent_does_not_move_what_the_others_share() -> None:
    rings = [ring((239, 1, 150, 5)), ring((241, 1, 151, 5)), ring((240, 1, 60, 5)), ring((239, 1, 149, 5))]
    found = common_mode(rings)
    assert found is not None
    assert found.decay_1_s == pytest.approx(149.5, abs=1)
    assert found.frequency_Hz == pytest.approx(239.5, abs=0.6)
    assert found.paces == 4
    assert found.decay_sd_1_s > 5


def test_a_ring_at_another_frequency_is_no_part_of_it() -> None:
    found = common_mode([ring((239, 1, 150, 5)), ring((240, 1, 150, 5)), ring((77, 5, 30, 9))])
    assert found is not None
    assert found.frequency_Hz == pytest.approx(239.5, abs=0.6)
    assert found.paces == 2
    assert common_mode([ring((239, 1, 150, 5))]) is None


def test_searches_build_on_the_surest_first_mode_and_the_second_that_most_tell() -> None:
    rings = [
        ring((239, 2, 150, 5)),
        ring((238, 1, 150, 5), (360, 1, 100, 9)),
        ring((241, 3, 150, 5), (897, 5, 330, 9)),
        ring((240, 3, 150, 5), (901, 5, 330, 9)),
    ]
    assert common_rings(rings) == ((238, 150), (897, 330))
    assert common_rings([]) == ()


def test_a_ring_fitted_again_keeps_the_shared_mode_and_its_own_spread() -> None:
    presses = [made_press(seed)[0] for seed in range(6)]
    found = measure_vibration(presses, 100.0, ENERGY, acceleration=True)
    assert isinstance(found, MeasuredVibration)
    assert isinstance(found.ring, Ring)
    again = refit_shared(found, SharedMode(FREQUENCY_Hz, DECAY_1_s, 0.5, 4.0, 3))
    assert isinstance(again.ring, Ring)
    shared, own = again.ring.mode, found.ring.mode
    assert (shared.frequency_Hz, shared.decay_1_s, shared.decay_sd_1_s) == (FREQUENCY_Hz, DECAY_1_s, 4.0)
    assert shared.decay_spread_1_s == own.decay_spread_1_s
    assert shared.decay_spread_1_s is not None
    assert np.median(again.ring.amplitudes[:, 0]) == pytest.approx(1.0, rel=0.1)


def test_a_shared_mode_that_does_not_fit_changes_nothing() -> None:
    presses = [made_press(seed)[0] for seed in range(6)]
    found = measure_vibration(presses, 100.0, ENERGY, acceleration=True)
    assert isinstance(found, MeasuredVibration)
    for frequency, decay in ((500.0, 150.0), (FREQUENCY_Hz, 10.0)):
        assert refit_shared(found, SharedMode(frequency, decay, 1.0, 1.0, 2)) is found
    without = replace(found, ring=NotFound("for a reason"))
    assert refit_shared(without, SharedMode(FREQUENCY_Hz, DECAY_1_s, 1.0, 1.0, 2)) is without


def pace(velocity_mm_s: float, amplitude: float, seeds: range) -> PacePresses:
    presses = tuple(made_press(seed, amplitude)[0] for seed in seeds)
    return PacePresses(Stroke.PRESS, velocity_mm_s, presses, ENERGY)


def test_paces_share_the_mode_that_they_ring_in_and_keep_their_own_amplitudes() -> None:
    found, mode = measure_paces(
        [pace(50.0, 0.5, range(6)), pace(100.0, 1.5, range(6, 12))], acceleration=True
    )
    assert mode is not None
    assert mode.frequency_Hz == pytest.approx(FREQUENCY_Hz, rel=0.01)
    assert mode.decay_1_s == pytest.approx(DECAY_1_s, rel=0.05)
    for one, amplitude in zip(found, (0.5, 1.5), strict=True):
        assert isinstance(one, MeasuredVibration)
        assert isinstance(one.ring, Ring)
        assert one.ring.mode.frequency_Hz == mode.frequency_Hz
        assert one.amplitude is not None
        assert one.amplitude.value == pytest.approx(amplitude, rel=0.15)


def test_a_pace_that_shows_nothing_is_not_given_what_others_show() -> None:
    paces = [
        pace(50.0, 0.0, range(4)),
        pace(100.0, 1.0, range(6)),
        PacePresses(Stroke.PRESS, 150.0, (), ENERGY),
        replace(pace(200.0, 1.0, range(2)), energy=None),
    ]
    quiet, heard, empty, linear = measure_paces(paces, acceleration=True)[0]
    assert isinstance(heard, MeasuredVibration)
    assert isinstance(quiet, NotFound)
    assert "presses show a snap" in quiet.reason
    assert isinstance(empty, NotFound)
    assert empty.reason == "no press of it was heard"
    assert isinstance(linear, NotFound)
    assert "force does not fall" in linear.reason


SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)


@given(exponent=st.floats(0.0, 2.5), level=st.floats(1e-3, 1e3))
def test_a_power_law_is_found_exactly(exponent: float, level: float) -> None:
    scaling = fit_scaling(SPEEDS_mm_s, [level * (v / 100) ** exponent for v in SPEEDS_mm_s])
    assert scaling.exponent == pytest.approx(exponent, abs=1e-9)
    assert scaling.amplitude(300.0) == pytest.approx(level * 3**exponent, rel=1e-9)
    assert scaling.exponent_sd == pytest.approx(0.0, abs=1e-7)


def test_the_standard_error_is_the_spread_of_the_exponent() -> None:
    random = np.random.default_rng(0)
    fits = [
        fit_scaling(SPEEDS_mm_s, [(v / 100) * math.exp(0.2 * random.standard_normal()) for v in SPEEDS_mm_s])
        for _ in range(2000)
    ]
    true_sd = 0.2 / math.sqrt(float(np.sum((np.log(SPEEDS_mm_s) - np.mean(np.log(SPEEDS_mm_s))) ** 2)))
    assert np.std([fit.exponent for fit in fits]) == pytest.approx(true_sd, rel=0.05)
    assert np.sqrt(np.mean([fit.exponent_sd**2 for fit in fits])) == pytest.approx(true_sd, rel=0.1)


def test_energy_counts_by_its_root() -> None:
    energy = [0.02, 0.05, 0.03, 0.08]
    amplitude = [3 * (v / 100) ** 1.2 * math.sqrt(e) for v, e in zip(SPEEDS_mm_s, energy, strict=True)]
    scaling = fit_scaling(SPEEDS_mm_s, amplitude, energy)
    assert scaling.exponent == pytest.approx(1.2)
    assert scaling.amplitude(80.0, 0.04) == pytest.approx(3 * 0.8**1.2 * 0.2)


def test_one_velocity_gives_an_assumed_exponent_and_says_so() -> None:
    scaling = fit_scaling([100.0], [2.0])
    assert (scaling.exponent, scaling.exponent_sd) == (1.0, math.inf)
    assert scaling.amplitude(50.0) == pytest.approx(1.0)
    with pytest.raises(FitError, match="above 0"):
        fit_scaling([], [])


def test_the_energy_of_a_straight_fall_is_the_triangle() -> None:
    x = np.linspace(0, 4, 801)
    force = np.interp(x, [0, 1, 2, 4], [30, 60, 40, 80])
    energy = snap_energy(x, force)
    assert energy is not None
    # 20 cN over 1 mm, half of it: 10 cN mm = 0.1 mJ; forces are means over 50 um, which rounds the corners
    assert energy.energy_mJ == pytest.approx(0.1, rel=0.03)
    assert energy.drop_cN == pytest.approx(20, abs=1)
    assert energy.window_mm == pytest.approx((1.75, 3.25), abs=0.05)
