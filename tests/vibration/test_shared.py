"""Modes that paces share, and rings told again with them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.vibration.test_snap import ENERGY, DECAY_1_s, FREQUENCY_Hz, made_press

from fdvv.vibration import (
    DampedMode,
    MeasuredVibration,
    NotFound,
    Ring,
    SharedMode,
    measure_vibration,
    shared_mode,
    shared_rings,
    with_shared,
)


def ring(*modes: tuple[float, float, float, float]) -> Ring:
    """Make a ring of modes (frequency, its error, decay, its error)."""
    made = tuple(DampedMode(f, d, 1.0, 0.0, f_sd, d_sd, 0.1) for f, f_sd, d, d_sd in modes)
    return Ring(made[0], made, made, np.ones((3, len(made))), 0.0, 1.0)


def test_one_pace_that_a_drive_bent_does_not_move_what_the_others_share() -> None:
    rings = [ring((239, 1, 150, 5)), ring((241, 1, 151, 5)), ring((240, 1, 60, 5)), ring((239, 1, 149, 5))]
    found = shared_mode(rings)
    assert found is not None
    assert found.decay_1_s == pytest.approx(149.5, abs=1)
    assert found.frequency_Hz == pytest.approx(239.5, abs=0.6)
    assert found.paces == 4
    assert found.decay_sd_1_s > 5


def test_a_ring_at_another_frequency_is_no_part_of_it() -> None:
    found = shared_mode([ring((239, 1, 150, 5)), ring((240, 1, 150, 5)), ring((77, 5, 30, 9))])
    assert found is not None
    assert found.frequency_Hz == pytest.approx(239.5, abs=0.6)
    assert found.paces == 2
    assert shared_mode([ring((239, 1, 150, 5))]) is None


def test_searches_build_on_the_surest_first_mode_and_the_second_that_most_tell() -> None:
    rings = [
        ring((239, 2, 150, 5)),
        ring((238, 1, 150, 5), (360, 1, 100, 9)),
        ring((241, 3, 150, 5), (897, 5, 330, 9)),
        ring((240, 3, 150, 5), (901, 5, 330, 9)),
    ]
    assert shared_rings(rings) == ((238, 150), (897, 330))
    assert shared_rings([]) == ()


def test_a_ring_told_again_keeps_the_shared_mode_and_its_own_spread() -> None:
    presses = [made_press(seed)[0] for seed in range(6)]
    found = measure_vibration(presses, 100.0, ENERGY, acceleration=True)
    assert isinstance(found, MeasuredVibration)
    assert isinstance(found.ring, Ring)
    again = with_shared(found, SharedMode(FREQUENCY_Hz, DECAY_1_s, 0.5, 4.0, 3))
    assert isinstance(again.ring, Ring)
    told, own = again.ring.mode, found.ring.mode
    assert (told.frequency_Hz, told.decay_1_s, told.decay_sd_1_s) == (FREQUENCY_Hz, DECAY_1_s, 4.0)
    assert told.decay_spread_1_s == own.decay_spread_1_s
    assert told.decay_spread_1_s is not None
    assert np.median(again.ring.amplitudes[:, 0]) == pytest.approx(1.0, rel=0.1)


def test_a_shared_mode_that_does_not_fit_changes_nothing() -> None:
    presses = [made_press(seed)[0] for seed in range(6)]
    found = measure_vibration(presses, 100.0, ENERGY, acceleration=True)
    assert isinstance(found, MeasuredVibration)
    for frequency, decay in ((500.0, 150.0), (FREQUENCY_Hz, 10.0)):
        assert with_shared(found, SharedMode(frequency, decay, 1.0, 1.0, 2)) is found
    without = replace(found, ring=NotFound("for a reason"))
    assert with_shared(without, SharedMode(FREQUENCY_Hz, DECAY_1_s, 1.0, 1.0, 2)) is without
