"""Rigs and fingers as files."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fdvv.twin
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError, ModelError
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.twin.button import ButtonPhysics, button_of_model
from fdvv.twin.cam import identify
from fdvv.twin.files import (
    FORCES,
    button_names,
    button_to_toml,
    finger_to_toml,
    load_button,
    load_finger,
    load_rig,
    rig_to_toml,
)
from fdvv.twin.finger import Finger
from fdvv.twin.quantity import about
from fdvv.twin.rig import Controller, Rig
from fdvv.twin.rig_moves import Mover

VOLTAGE = Path(fdvv.twin.__file__).parent / "rigs" / "voltage.toml"


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "rig.toml"
    path.write_text(text)
    return path


def test_the_shipped_rig_is_the_default_one_written_out() -> None:
    assert VOLTAGE.read_text() == rig_to_toml(Rig())
    assert load_rig(VOLTAGE) == Rig()


def test_a_shipped_rig_or_finger_is_read_by_its_name() -> None:
    assert load_rig("voltage") == load_rig("default") == Rig()
    folder = VOLTAGE.parents[1]
    assert load_rig("paper") == load_rig(folder / "rigs" / "paper.toml") != Rig()
    assert load_finger("paper") == load_finger(folder / "fingers" / "paper.toml") != Finger()


def test_the_light_rig_renders_a_press_in_the_time_its_firmware_has() -> None:
    device = TwinDevice(load_rig("light"), seed=1)
    device.upload(ForceSurface.of_model(load_builtin("mx-red"), [100.0]), 4.0)
    press = device.press(100.0)
    assert device.info().tick_s == 1e-4
    assert press.displacement_mm.max() > 3.9


def test_every_parameter_is_listed_with_its_range_and_source() -> None:
    for text in (rig_to_toml(Rig()), finger_to_toml(Finger())):
        lines = [line for line in text.splitlines() if "=" in line.split("#")[0]]
        assert len(lines) > 20
        assert all(line.partition(" # ")[2].count(";") >= 2 for line in lines)


@pytest.mark.parametrize("record", [Rig(), Finger(), load_rig("paper"), load_finger("paper")])
def test_every_number_lies_in_its_plausible_range_and_that_within_the_bounds(record: Rig | Finger) -> None:
    for section in dataclasses.fields(record):
        part = getattr(record, section.name)
        for field in dataclasses.fields(part):
            known, place = about(field), f"{section.name}.{field.name}"
            if not known.choices:
                assert known.plausible is not None
                low, high = known.plausible
                assert known.bounds[0] <= low <= getattr(part, field.name) <= high <= known.bounds[1], place


def values(field: dataclasses.Field[Any]) -> st.SearchStrategy[Any]:
    known = about(field)
    if known.choices:
        return st.sampled_from(known.choices)
    low, high = known.plausible or known.bounds
    return st.integers(int(low), int(high)) if field.type == "int" else st.floats(low, high)


def sections(kind: type) -> st.SearchStrategy[Any]:
    return st.builds(kind, **{field.name: values(field) for field in dataclasses.fields(kind)})


@given(sections(Mover), st.sampled_from(["voltage", "current"]))
def test_a_rig_comes_back_from_its_text_bit_for_bit(
    tmp_path_factory: pytest.TempPathFactory, mover: Mover, drive: str
) -> None:
    rig = Rig(mover=mover, coil=dataclasses.replace(Rig().coil, drive=drive))
    path = write(tmp_path_factory.mktemp("rig"), rig_to_toml(rig))
    assert load_rig(path) == rig


def test_a_finger_comes_back_from_its_text(tmp_path: Path) -> None:
    finger = Finger(habit=dataclasses.replace(Finger().habit, lift_m=0.003, push_N=2.0))
    assert load_finger(write(tmp_path, finger_to_toml(finger))) == finger


def test_a_parameter_left_out_keeps_its_default(tmp_path: Path) -> None:
    assert load_rig(write(tmp_path, "[mover]\nmass_kg = 0.012\n")) == Rig(mover=Mover(mass_kg=0.012))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "[mover]\nmass_kg = -0.02\n",
            r"rig.toml: mover.mass_kg: mass_kg must be 0.0005 to 1 kg, got -0.02; .*0.012",
        ),
        ("[mover]\nmass_kg = nan\n", "mass_kg must be 0.0005 to 1 kg, got nan"),
        ("[mover]\nmass_kg = 'heavy'\n", "mass_kg must be a number, got 'heavy'"),
        ("[mover]\nmass_kg = true\n", "mass_kg must be a number, got True"),
        ("[mover]\nmass = 0.02\n", "mover.mass: unknown parameter; did you mean mass_kg?"),
        ("[motor]\nmass_kg = 0.02\n", "motor: unknown section; did you mean mover?"),
        ("mover = 3\n", "mover: must be a section, got 3; write .mover. above its parameters"),
        ("[coil]\ndrive = 'pneumatic'\n", 'drive must be "voltage" or "current", got \'pneumatic\''),
        ("[coil]\ncommand_bits = 10.5\n", "command_bits must be a whole number, got 10.5"),
        (
            "[controller]\ncompute_s = 0.002\n",
            "controller: .*compute_s must be below tick_s 0.001 s, got 0.002",
        ),
        ("[controller]\nwindow_end_m = 0.0004\n", "window_end_m must exceed window_start_m"),
        ("[position_sensor]\nburst_s = 0.002\n", "burst_s must not exceed tick_s"),
        ("[mover\n", "line 1, column 7: not valid TOML"),
    ],
)
def test_what_cannot_be_used_is_refused_with_file_key_bound_and_remedy(
    tmp_path: Path, text: str, message: str
) -> None:
    with pytest.raises(InputError, match=message.replace("?", "[?]")) as caught:
        load_rig(write(tmp_path, text))
    assert "\n" not in str(caught.value)
    assert caught.value.remedy


def test_a_file_that_is_absent_or_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        load_rig(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not UTF-8"):
        load_rig(broken)


def test_values_out_of_bounds_are_refused_in_code_too() -> None:
    with pytest.raises(ModelError, match=r"Controller: tick_s must be 5e-05 to 0\.004 s, got 1"):
        Controller(tick_s=1.0)


ROOT = Path(__file__).resolve().parents[4]


def same(a: ButtonPhysics, b: ButtonPhysics) -> bool:
    return all(
        np.allclose(getattr(a, f.name), getattr(b, f.name), atol=6e-6)
        if f.name in FORCES
        else getattr(a, f.name) == getattr(b, f.name)
        for f in dataclasses.fields(a)
    )


@pytest.mark.parametrize("name", button_names())
def test_a_shipped_button_survives_its_file(name: str, tmp_path: Path) -> None:
    path = tmp_path / "button.toml"
    path.write_text(button_to_toml(load_button(name)))
    assert same(load_button(path), load_button(name))


def test_the_shipped_files_are_what_the_tool_makes() -> None:
    code = (
        "import sys; sys.path.insert(0, 'tools'); import make_buttons as m\n"
        "from fdvv.twin.files import button_to_toml\n"
        "old = {b.name: (m.OUTPUT / f'{b.name}.toml').read_text() for b in m.buttons()}\n"
        "wrong = [b.name for b in m.buttons() if old[b.name] != button_to_toml(b)]\n"
        "sys.exit(f'stale: {wrong}' if wrong else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_every_number_of_the_domes_says_that_it_is_assumed() -> None:
    for name in ("hp-pr1101u", "macbook-pro-2011"):
        assert "all else assumed" in load_button(name).source


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
    path, text = tmp_path / "button.toml", button_to_toml(load_button("mx-red"))
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        load_button(path)
    assert caught.value.place == place
    assert "\n" not in str(caught.value)


def test_an_unknown_name_is_refused_with_the_names_there_are() -> None:
    with pytest.raises(InputError, match="mx-black, mx-brown"):
        load_button("mx-purple")


def test_a_model_without_an_activation_point_needs_one_as_an_argument() -> None:
    unknown = dataclasses.replace(load_builtin("mx-red"), actuation_mm=None)
    with pytest.raises(ModelError, match="say where the circuit closes"):
        button_of_model(unknown)
    assert button_of_model(load_builtin("mx-red")).curve.close_m == pytest.approx(0.001705)


def test_a_clicky_switch_is_refused_because_its_curves_are_not_those_of_one_leaf() -> None:
    with pytest.raises(ModelError, match="leaf close its circuit"):
        identify(button_of_model(load_builtin("mx-blue")))
