"""A leaf switch given as it is built presses as one whose parts were identified; its file keeps them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv.twin import BuiltCam, ButtonPhysics, button_to_toml, identify, load_button, probe_button


def built(name: str = "mx-brown") -> ButtonPhysics:
    """Take what the twin identifies in a button's curves as what it is built of."""
    button = load_button(name)
    found = identify(button)
    x = button.curve.step_m * np.arange(button.press_N.size)
    elastic, height, rail, ratio = (
        np.interp(x, found.x_m, column)
        for column in (found.elastic_N, found.height_m, found.rail_N, found.friction_ratio)
    )
    return replace(button, cam=BuiltCam(elastic, height, rail, ratio, found.preload_N))


def test_parts_that_were_identified_and_are_given_back_press_alike() -> None:
    wanted, got = (probe_button(button) for button in (load_button("mx-brown"), built()))
    inside = wanted.displacement_mm > 0.1
    for stroke in ("press_cN", "release_cN"):
        error = (getattr(got, stroke) - getattr(wanted, stroke))[inside]
        assert float(np.sqrt(np.mean(error**2))) < 0.2


def test_curves_tell_nothing_where_the_cam_is_given() -> None:
    button = built()
    other = replace(button, press_N=2.0 * button.press_N, release_N=2.0 * button.release_N)
    np.testing.assert_array_equal(probe_button(button).press_cN, probe_button(other).press_cN)


def test_a_file_keeps_what_was_built(tmp_path: Path) -> None:
    path = tmp_path / "button.toml"
    path.write_text(button_to_toml(built()))
    again = load_button(path)
    assert again.cam is not None
    np.testing.assert_allclose(probe_button(again).press_cN, probe_button(built()).press_cN, atol=0.05)


def test_a_cam_that_is_not_whole_is_refused_with_its_place(tmp_path: Path) -> None:
    text = button_to_toml(built())
    path = tmp_path / "button.toml"
    for wrong, said in (
        (text.replace("rail_N = [", "rails_N = ["), r"\[cam\]"),
        (text.replace("\npreload_N = ", "\npreload_N = 'x' #"), "preload_N"),
        (text.replace("\npreload_N = ", "\npreload_N = -"), "above 0"),
    ):
        path.write_text(wrong)
        with pytest.raises(InputError, match=said):
            load_button(path)


def test_a_dome_has_no_cam_and_columns_must_fit() -> None:
    button = built()
    assert button.cam is not None
    with pytest.raises(ModelError, match="for a leaf"):
        replace(load_button("hp-pr1101u"), cam=button.cam)
    with pytest.raises(ModelError, match="equally long"):
        replace(button.cam, height_m=button.cam.height_m[:-1])
    with pytest.raises(ModelError, match="finite"):
        replace(button.cam, height_m=button.cam.height_m * np.nan)
