"""Rigs and fingers drawn at random."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from benchmarks.any_size import SIZES, sized_rig
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.twin.draw import draw_around, draw_finger, draw_rig
from fdvv.twin.files import load_rig, rig_to_toml
from fdvv.twin.finger import Finger
from fdvv.twin.quantity import about
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil
from fdvv.twin.settings import settings_of


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


def test_draws_are_spread_over_the_whole_range() -> None:
    random = np.random.default_rng(0)
    low, high = 255.0, 1255.0
    seen = [draw_finger(random).impedance.stiffness_N_m for _ in range(300)]
    assert np.quantile(seen, [0.25, 0.5, 0.75]) == pytest.approx(
        [low + part * (high - low) for part in (0.25, 0.5, 0.75)], rel=0.12
    )


def test_no_drawn_coil_loses_its_inductance_within_the_stroke() -> None:
    for seed in range(300):
        coil = draw_rig(np.random.default_rng(seed)).coil
        ends = np.array([0.0, coil.stroke_m]) - coil.centre_m
        assert (coil.inductance_H + coil.reluctance_H_m * ends).min() >= 0.24 * coil.inductance_H


def test_a_coil_whose_inductance_would_turn_negative_is_refused() -> None:
    with pytest.raises(ModelError, match="stays above 0 over the stroke"):
        Coil(inductance_H=5e-4, reluctance_H_m=0.3)


@pytest.mark.parametrize(("full_N", "tick_us"), [(0.5, 4000), (2.0, 1000), (10.0, 250), (50.0, 50)])
def test_a_rig_of_any_size_is_drawn_from_its_file_with_its_force(
    full_N: float, tick_us: int, tmp_path: Path
) -> None:
    size = next(size for size in SIZES if size.full_N == full_N)
    path = tmp_path / "mine.rig.toml"
    path.write_text(rig_to_toml(sized_rig(size, tick_us)))
    rig = load_rig(path)
    asked = settings_of(rig)
    assert 2**31 / (6400 * asked.duty_gain_q16) == pytest.approx(full_N, rel=0.08)
    assert asked.tick_us == tick_us
    for seed in range(20):
        drawn = draw_around(rig, np.random.default_rng(seed))
        assert 2**31 / (6400 * settings_of(drawn).duty_gain_q16) == pytest.approx(full_N, rel=0.15)
        assert 0.5 * rig.mover.mass_kg < drawn.mover.mass_kg < 2.1 * rig.mover.mass_kg
        assert drawn.controller.tick_s == rig.controller.tick_s


def test_around_the_default_rig_a_draw_is_the_usual_one_with_the_default_force() -> None:
    usual, around = draw_rig(np.random.default_rng(3)), draw_around(Rig(), np.random.default_rng(3))
    assert vars(around.mover) == pytest.approx(vars(usual.mover))
    assert around.coil.force_constant_N_A == pytest.approx(usual.coil.force_constant_N_A)
    ratios = [c.force_constant_N_A / (c.resistance_ohm + c.bridge_ohm) for c in (Rig().coil, around.coil)]
    assert ratios[0] == pytest.approx(ratios[1])
