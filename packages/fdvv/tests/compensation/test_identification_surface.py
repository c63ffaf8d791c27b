"""The surface that a rig is identified on is safe to press."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.tables import grid_mm
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

TARGETS = {
    name: ForceSurface.of_model(load_builtin(name), [50, 200], 0.05) for name in ("mx-clear", "mx-red")
}


def tables(surface: ForceSurface) -> list[FloatArray]:
    return [surface.press_cN, surface.release_cN]


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_the_cap_is_held_up_and_the_limit_kept(target: ForceSurface) -> None:
    surface = identification_surface(target, weight_cN=-60.0, limit_cN=90.0)
    home = surface.displacement_mm <= 0.1
    for table in tables(surface):
        assert table[:, home].min() >= 80.0
        assert table.max() <= 90.0
    assert surface.velocity_mm_s.tolist() == target.velocity_mm_s.tolist()


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_without_ripples_it_is_the_target_lifted_but_for_its_home(target: ForceSurface) -> None:
    surface = identification_surface(target, weight_cN=20.0, ripple_cN=0.0)
    for found, asked in zip(tables(surface), tables(target), strict=True):
        np.testing.assert_allclose(found[:, 12:-2], asked[:, 12:-2] + 20.0, atol=3.0)


def test_ripples_differ_between_strokes_and_have_no_steps() -> None:
    row = np.full((1, 81), 60.0)
    flat = ForceSurface(grid_mm(4.0, 0.05), np.array([50.0]), row, row)
    surface = identification_surface(flat, ripple_cN=8.0)
    press, release = (table[0] - 80.0 for table in tables(surface))
    assert abs(np.corrcoef(press, release)[0, 1]) < 0.5
    for ripple in (press, release):
        assert 6.0 < np.abs(ripple).max() < 14.0
        assert np.abs(np.diff(ripple)).max() < 8.0


def test_every_second_speed_is_pressed_on_a_higher_level_and_the_next_turn_exchanges_them() -> None:
    row = np.full((3, 81), 60.0)
    flat = ForceSurface(grid_mm(4.0, 0.05), np.array([50.0, 100.0, 200.0]), row, row)
    first, second = (identification_surface(flat, turn=turn).press_cN[:, 20] for turn in (0, 1))
    np.testing.assert_allclose(first - first[0], [0.0, 24.0, 0.0])
    np.testing.assert_allclose(second - second[1], [24.0, 0.0, 24.0])


def test_a_weak_rig_gets_the_same_shape_with_less_of_everything() -> None:
    target = TARGETS["mx-red"]
    weaker = replace(target, press_cN=0.1 * target.press_cN, release_cN=0.1 * target.release_cN)
    usual, weak = (identification_surface(t, limit_cN=n) for t, n in ((target, 200.0), (weaker, 20.0)))
    below = target.displacement_mm > 0.5
    np.testing.assert_allclose(weak.press_cN[:, below], 0.1 * usual.press_cN[:, below], atol=1e-9)
    np.testing.assert_allclose(weak.release_cN[:, below], 0.1 * usual.release_cN[:, below], atol=1e-9)
    assert weak.press_cN.max() <= 20.0


def test_a_heavy_mover_is_held_up_by_half_more_than_its_weight() -> None:
    heavy = identification_surface(TARGETS["mx-red"], weight_cN=90.0)
    assert heavy.press_cN[:, 0].min() == heavy.release_cN[:, 0].min() == pytest.approx(135.0)
