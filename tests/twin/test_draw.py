"""Rigs and fingers drawn at random."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.finger import Finger
from fdvv.twin.quantity import about
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil


@pytest.mark.parametrize("draw", [draw_rig, draw_finger])
@given(st.integers(0, 2**32 - 1))
@settings(max_examples=25, deadline=None)
def test_a_draw_is_valid_and_every_uncertain_parameter_lies_in_its_range(
    draw: Callable[[np.random.Generator], Rig | Finger], seed: int
) -> None:
    drawn = draw(np.random.default_rng(seed))
    for part in dataclasses.fields(drawn):
        section = getattr(drawn, part.name)
        for field in dataclasses.fields(section):
            known, value = about(field), getattr(section, field.name)
            if known.plausible and not known.chosen:
                assert known.plausible[0] <= value <= known.plausible[1], field.name
            else:
                assert value == field.default


def test_the_same_seed_draws_the_same_and_another_seed_another() -> None:
    assert draw_rig(np.random.default_rng(3)) == draw_rig(np.random.default_rng(3))
    assert draw_finger(np.random.default_rng(3)) != draw_finger(np.random.default_rng(4))


def test_draws_are_spread_over_the_whole_range() -> None:
    random = np.random.default_rng(0)
    low, high = 255.0, 1255.0
    seen = [draw_finger(random).impedance.stiffness_N_m for _ in range(300)]
    assert np.quantile(seen, [0.25, 0.5, 0.75]) == pytest.approx(
        [low + part * (high - low) for part in (0.25, 0.5, 0.75)], rel=0.12
    )


def test_what_a_builder_chooses_is_kept() -> None:
    drawn = draw_rig(np.random.default_rng(1))
    assert drawn.coil.supply_V == Rig().coil.supply_V
    assert drawn.controller.tick_s == Rig().controller.tick_s
    assert draw_finger(np.random.default_rng(1)).habit.lift_m == Finger().habit.lift_m


def test_no_drawn_coil_loses_its_inductance_within_the_stroke() -> None:
    for seed in range(300):
        coil = draw_rig(np.random.default_rng(seed)).coil
        ends = np.array([0.0, coil.stroke_m]) - coil.centre_m
        assert (coil.inductance_H + coil.reluctance_H_m * ends).min() >= 0.24 * coil.inductance_H


def test_a_coil_whose_inductance_would_turn_negative_is_refused() -> None:
    with pytest.raises(ModelError, match="stays above 0 over the stroke"):
        Coil(inductance_H=5e-4, reluctance_H_m=0.3)
