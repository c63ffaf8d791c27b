"""A button with more force, snap or vibration has that and nothing else more."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.model.magnify import has_snap, magnify

RATIOS = st.floats(0.5, 1.6)
SNAPPING = ("mx-blue", "mx-brown", "mx-clear", "rubber-dome")


def test_ratios_of_one_change_nothing() -> None:
    model = load_builtin("mx-clear")
    assert magnify(model) == model


@given(RATIOS)
def test_all_forces_are_multiplied(ratio: float) -> None:
    model = load_builtin("mx-clear")
    x = np.linspace(0, model.travel_mm, 50)
    for stroke in Stroke:
        wanted = ratio * model.force_cN(x, 100.0, stroke)
        np.testing.assert_allclose(magnify(model, force_ratio=ratio).force_cN(x, 100.0, stroke), wanted)


@pytest.mark.parametrize("name", SNAPPING)
@pytest.mark.parametrize("ratio", [0.6, 1.2, 1.5])
def test_the_fall_of_force_is_multiplied_and_its_middle_stays(name: str, ratio: float) -> None:
    model = load_builtin(name)
    before, after = landmarks(model), landmarks(magnify(model, snap_ratio=ratio))
    assert None not in (before.peak_cN, before.valley_cN, after.peak_cN, after.valley_cN)
    fall, middle = before.peak_cN - before.valley_cN, before.peak_cN + before.valley_cN  # type: ignore[operator]
    assert after.peak_cN - after.valley_cN == pytest.approx(ratio * fall, rel=0.01)  # type: ignore[operator]
    assert after.peak_cN + after.valley_cN == pytest.approx(middle, rel=0.01)  # type: ignore[operator]


@pytest.mark.parametrize("name", SNAPPING)
def test_a_snap_grows_without_a_jump_and_the_force_around_it_stays(name: str) -> None:
    model = load_builtin(name)
    x = np.linspace(0, model.travel_mm, 4001)
    for stroke in Stroke:
        old, new = (one.force_cN(x, 20.0, stroke) for one in (model, magnify(model, snap_ratio=1.3)))
        assert np.abs(np.diff(new)).max() < 2 * np.abs(np.diff(old)).max()
        assert np.mean(np.isclose(old, new, atol=1e-6)) > 0.05
        assert abs(np.mean(new - old)) < 0.25 * np.abs(new - old).max()


@given(RATIOS)
def test_vibrations_are_multiplied_and_forces_stay(ratio: float) -> None:
    model = load_builtin("mx-clear")
    found = magnify(model, vibration_ratio=ratio)
    assert found.curves == model.curves
    for old, new in zip(model.vibrations, found.vibrations, strict=True):
        t_s = np.linspace(0, new.duration_s, 20)
        np.testing.assert_allclose(new.acceleration_m_s2(t_s), ratio * old.acceleration_m_s2(t_s))


def test_what_a_button_lacks_cannot_grow() -> None:
    assert has_snap(load_builtin("mx-clear"))
    assert not has_snap(load_builtin("mx-red"))
    with pytest.raises(ModelError, match="no snap"):
        magnify(load_builtin("mx-red"), snap_ratio=1.2)
    with pytest.raises(ModelError, match="no vibration"):
        magnify(load_builtin("mx-blue"), vibration_ratio=1.2)


def test_a_snap_may_not_grow_until_the_button_pulls() -> None:
    with pytest.raises(ModelError, match="pull"):
        magnify(load_builtin("rubber-dome"), snap_ratio=6.0)
    model = load_builtin("mx-clear")
    valley_mm = np.linspace(1.0, 2.0, 1001)
    back = magnify(model, snap_ratio=3.0).force_cN(valley_mm, 100.0, Stroke.RELEASE)
    assert 0.0 <= back.min() < 2.0
