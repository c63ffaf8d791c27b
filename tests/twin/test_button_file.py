"""Button files: what is shipped, what is refused, what makes them."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv.model import load_builtin
from fdvv.twin import ButtonPhysics, button_names, button_of_model, button_to_toml, identify, load_button
from fdvv.twin._button_file import FORCES

ROOT = Path(__file__).resolve().parents[2]


def same(a: ButtonPhysics, b: ButtonPhysics) -> bool:
    return all(
        np.allclose(getattr(a, f.name), getattr(b, f.name), atol=6e-6)
        if f.name in FORCES
        else getattr(a, f.name) == getattr(b, f.name)
        for f in dataclasses.fields(a)
    )


def test_six_buttons_are_shipped() -> None:
    assert button_names() == ("hp-pr1101u", "macbook-pro-2011", "mx-black", "mx-brown", "mx-clear", "mx-red")


@pytest.mark.parametrize("name", button_names())
def test_a_shipped_button_survives_its_file(name: str, tmp_path: Path) -> None:
    path = tmp_path / "button.toml"
    path.write_text(button_to_toml(load_button(name)))
    assert same(load_button(path), load_button(name))


def test_the_shipped_files_are_what_the_tool_makes() -> None:
    code = (
        "import sys; sys.path.insert(0, 'tools'); import make_buttons as m\n"
        "from fdvv.twin import button_to_toml\n"
        "old = {b.name: (m.OUTPUT / f'{b.name}.toml').read_text() for b in m.buttons()}\n"
        "wrong = [b.name for b in m.buttons() if old[b.name] != button_to_toml(b)]\n"
        "sys.exit(f'stale: {wrong}' if wrong else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_every_number_of_the_domes_says_that_it_is_assumed() -> None:
    for name in ("hp-pr1101u", "macbook-pro-2011"):
        assert "all else assumed" in load_button(name).source


def refused(tmp_path: Path, old: str, new: str) -> InputError:
    path = tmp_path / "button.toml"
    text = button_to_toml(load_button("mx-red"))
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        load_button(path)
    return caught.value


def test_an_unknown_parameter_is_refused_with_the_nearest_name(tmp_path: Path) -> None:
    error = refused(tmp_path, "mass_kg", "mas_kg")
    assert error.place == "slider.mas_kg"
    assert "mass_kg" in error.remedy


def test_a_value_out_of_range_is_refused_with_the_bound(tmp_path: Path) -> None:
    error = refused(tmp_path, "bristle_m = 1e-05", "bristle_m = 1e-09")
    assert error.place == "slider.bristle_m"
    assert "5e-06 to 0.001 m" in error.reason


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("press_N = [", "press_N = [nan,", "press_N"),
        ("press_N = [", 'press_N = ["a",', "press_N"),
        ("press_N = [", "press_N = [0.1,", "whole file"),
        ('name = "mx-red"', "name = 3", "name"),
        ("close_m = 0.001705", "close_m = 0.009", "whole file"),
        ("[leaf]", "[leafs]", "leafs"),
    ],
)
def test_a_wrong_file_is_refused_in_one_line_that_names_the_place(
    tmp_path: Path, old: str, new: str, place: str
) -> None:
    error = refused(tmp_path, old, new)
    assert error.place == place
    assert "\n" not in str(error)


def test_an_unknown_name_is_refused_with_the_names_there_are() -> None:
    with pytest.raises(InputError, match="mx-black, mx-brown"):
        load_button("mx-purple")


def test_a_model_without_an_activation_point_needs_to_be_told_where_it_closes() -> None:
    unknown = dataclasses.replace(load_builtin("mx-red"), actuation_mm=None)
    with pytest.raises(ModelError, match="say where the circuit closes"):
        button_of_model(unknown)
    assert button_of_model(load_builtin("mx-red")).curve.close_m == pytest.approx(0.001705)


def test_a_clicky_switch_is_refused_because_its_curves_are_not_those_of_one_leaf() -> None:
    with pytest.raises(ModelError, match="leaf close its circuit"):
        identify(button_of_model(load_builtin("mx-blue")))
