"""The identification: curves made from a known leaf give that leaf back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import fit_file
from fdvv.errors import InputError, ModelError
from fdvv.twin.button import BuiltCam, ButtonPhysics, Curve, button_of_model
from fdvv.twin.cam import identify
from fdvv.twin.files import button_to_toml, load_button
from fdvv.twin.simulate_button import probe_button
from fdvv.units import FloatArray

CLOSE_m, FREE_m, TRAVEL_m = 0.0018, 0.0022, 0.004


def made(friction: float = 0.2) -> tuple[ButtonPhysics, FloatArray, FloatArray]:
    """Make curves of a leaf whose energy falls smoothly from 60 uJ to nothing; return them, energy and x."""
    x = np.asarray(2e-5 * np.arange(201), dtype=np.float64)
    left = np.clip((FREE_m - x) / FREE_m, 0.0, None)
    energy_J = 6e-5 * left**2
    taken_N = -2 * 6e-5 * left / FREE_m
    leaf = load_button("mx-red").leaf
    shut = 1 / (1 / leaf.cam_stiffness_N_m + 1 / (leaf.stiffness_N_m + leaf.fixed_stiffness_N_m))
    alone = 1 / (1 / leaf.cam_stiffness_N_m + 1 / leaf.stiffness_N_m)
    close_J = float(np.interp(CLOSE_m, x, energy_J))
    preload_N = np.sqrt(2 * shut * close_J)
    normal_N = np.where(
        energy_J <= close_J,
        np.sqrt(2 * shut * energy_J),
        np.sqrt(preload_N**2 + 2 * alone * np.maximum(energy_J - close_J, 0)),
    )
    middle_N, half_N = 0.35 + 6.0 * x + taken_N, friction * normal_N
    curve = Curve(travel_m=TRAVEL_m, close_m=CLOSE_m, open_m=CLOSE_m, seat_m=0.0)
    button = replace(
        load_button("mx-red"), press_N=middle_N + half_N, release_N=middle_N - half_N, curve=curve
    )
    return button, np.asarray(normal_N, dtype=np.float64), x


def test_the_friction_coefficient_and_the_normal_force_of_a_made_leaf_are_found() -> None:
    button, normal_N, x = made(0.2)
    cam = identify(button)
    inside = (x > 0.0001) & (x < 0.0019)
    found_N = np.interp(x, cam.x_m, cam.normal_N)
    assert np.abs(found_N - normal_N)[inside].max() < 0.012
    # a little of it goes to the rails: the leaf counts as off when it gives 0.15 cN
    riding = (x > 0.0001) & (x < 0.0015)
    assert np.interp(x, cam.x_m, cam.friction_ratio)[riding] == pytest.approx(0.2, abs=0.025)


def test_force_times_slope_of_the_cam_is_the_fall_of_the_leaf_s_energy() -> None:
    cam = identify(load_button("mx-brown"))
    slope = np.gradient(cam.height_m, cam.x_m)
    given_N = cam.normal_N * slope + cam.elastic_N
    button = load_button("mx-brown")
    at = 2e-5 * np.arange(button.press_N.size)
    middle_N = np.interp(cam.x_m, at, 0.5 * (button.press_N + button.release_N))
    inside = (cam.x_m > 0.0002) & (cam.x_m < 0.0037)
    assert np.sqrt(np.mean((given_N - middle_N)[inside] ** 2)) < 0.002


def test_cherry_switches_show_a_friction_coefficient_of_plastic_on_metal() -> None:
    for name in ("mx-clear", "mx-brown", "mx-black", "mx-red"):
        cam = identify(load_button(name))
        riding = (cam.x_m > 0.0003) & (cam.x_m < 0.0015)
        assert 0.1 < np.median(cam.friction_ratio[riding]) < 0.25


@pytest.mark.parametrize(
    ("name", "close_m", "said"),
    [("mx-red", 0.0025, "smaller close_m"), ("mx-clear", 0.0014, "larger close_m")],
)
def test_a_contact_where_the_leaf_cannot_be_is_refused(name: str, close_m: float, said: str) -> None:
    button = load_button(name)
    curve = replace(button.curve, close_m=close_m, open_m=close_m)
    with pytest.raises(ModelError, match=said):
        identify(replace(button, curve=curve))


@pytest.mark.shared
@pytest.mark.parametrize(
    ("file", "close_mm"),
    [
        ("bluepylons/Cherry-MX-Clear-stem-w-Cherry-MX-Hyperglide-Blue-Bottom.ods", None),
        ("haata/Cherry MX Black.csv", 1.82),
        ("haata/Cherry MX Brown.csv", 2.1),
    ],
)
def test_units_that_no_shipped_button_was_made_from_are_given_back_too(
    shared_data: Path, file: str, close_mm: float | None
) -> None:
    button = button_of_model(fit_file(shared_data / file).model, close_mm)
    probed = probe_button(button)
    at_mm = 0.02 * np.arange(button.press_N.size)
    inside = probed.displacement_mm <= at_mm[-1]
    for got_cN, force_N in ((probed.press_cN, button.press_N), (probed.release_cN, button.release_N)):
        wrong_cN = (got_cN - 100 * np.interp(probed.displacement_mm, at_mm, force_N))[inside]
        assert np.sqrt(np.mean(wrong_cN**2)) < 1.0


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
