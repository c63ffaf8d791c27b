"""A button in MuJoCo: its springs draw the curve, its callback is the model, both in the real simulator."""

import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.errors import BuildError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_haptics.mjcf import mjcf, polyline, spring_button
from fdvv_haptics.mujoco import MujocoButton, mujoco_button

mujoco: Any = pytest.importorskip("mujoco")


@pytest.fixture(autouse=True)
def _log_beside_the_test(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """MuJoCo writes its log of warnings into the folder it runs in."""
    monkeypatch.chdir(tmp_path)


def _loaded(text: str) -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def _held_cN(model: Any, data: Any, x_mm: float, v_mm_s: float = 0.0) -> float:
    """Place the cap and read what pushes back: springs, damping and line; neither friction nor weight."""
    data.qpos[0], data.qvel[0] = x_mm / 1000, v_mm_s / 1000
    mujoco.mj_forward(model, data)
    return float(-100 * (data.qfrc_spring[0] + data.qfrc_damper[0] + data.qfrc_actuator[0]))


@pytest.mark.parametrize("name", builtin_names())
def test_the_springs_of_the_file_add_up_to_the_line(name: str) -> None:
    button = load_builtin(name)
    line = spring_button(button)
    model, data = _loaded(mjcf(button).text)
    for x in np.linspace(0, button.travel_mm, 23):
        wanted = np.interp(x, line.displacement_mm, line.force_cN)
        assert _held_cN(model, data, float(x)) == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("name", ["mx-black", "mx-blue", "mx-brown", "mx-red"])
def test_the_press_of_a_slow_measurement_is_within_a_quarter_cN(name: str) -> None:
    figures = mjcf(load_builtin(name)).figures
    assert 0 < (figures["press_max_cN"] or 0) <= 0.25


@pytest.mark.parametrize("v", [50.0, 100.0, 200.0])
def test_a_press_at_the_velocity_that_is_asked_for_is_followed(v: float) -> None:
    figures = mjcf(load_builtin("mx-clear"), velocity_mm_s=v).figures
    assert 0 < (figures[f"press_{v:g}mm_s_max_cN"] or 0) <= 0.25


def test_following_both_strokes_shares_the_error_between_them() -> None:
    one, both = (mjcf(load_builtin("mx-blue"), follow=f).figures for f in ("press", "both"))
    assert (one["press_rms_cN"] or 0) < 1 < (both["press_rms_cN"] or 0)
    assert both["press_rms_cN"] == pytest.approx(both["release_rms_cN"], rel=0.05)
    assert (both["worst_cN"] or 0) < 0.6 * (one["worst_cN"] or 0)


def test_the_springs_are_of_documented_kinds_only() -> None:
    model, _ = _loaded(mjcf(load_builtin("mx-blue")).text)
    assert (model.tendon_stiffness > 0).all()
    assert model.nu == 1
    assert model.dof_frictionloss[0] > 0


def _pushed(
    xml: str, v_mm_s: float, start_mm: float, end_mm: float, made: MujocoButton | None = None
) -> FloatArray:
    """Lead the cap at a steady speed by a stiff servo, and read what pushes back: rows of mm, mm/s, cN."""
    servo = '<position name="finger" joint="button" kp="60000" kv="60"/></actuator>'
    model, data = _loaded(xml.replace("</actuator>", servo))
    way = np.sign(end_mm - start_mm)
    data.qpos[0], data.qvel[0] = start_mm / 1000, way * v_mm_s / 1000
    rows = []
    with made.attached() if made else nullcontext():
        for _ in range(int(abs(end_mm - start_mm) / v_mm_s / model.opt.timestep)):
            data.ctrl[1] = (start_mm + way * v_mm_s * data.time) / 1000 + way * v_mm_s / 1000 * 60 / 60000
            before = 1000 * data.qpos[0], 1000 * data.qvel[0]
            mujoco.mj_step(model, data)
            # forces are those of the step's beginning; the cap's own mass is no part of the button
            rows.append((*before, 100 * (data.actuator_force[1] - model.body_mass[1] * data.qacc[0])))
    return np.array(rows[len(rows) // 20 :])


def _quick(xml: str) -> str:
    """Take larger steps: 0.2 ms keeps a test of a 80 ms press short."""
    return xml.replace('timestep="0.0001"', 'timestep="0.0002"')


@pytest.mark.parametrize("name", ["mx-clear", "rubber-dome", "mx-blue"])
@pytest.mark.parametrize("v", [50.0, 120.0, 200.0])
def test_a_push_feels_the_models_force_at_every_speed(name: str, v: float) -> None:
    button = load_builtin(name)
    made = mujoco_button(button)
    rows = _pushed(_quick(made.xml), v, 0.05, 0.97 * button.travel_mm, made)
    assert rows[-1, 0] > 0.9 * button.travel_mm
    off = rows[:, 2] - button.force_cN(rows[:, 0], np.abs(rows[:, 1]), "press")
    assert np.abs(off).max() < 0.1


def test_the_way_back_feels_the_release() -> None:
    button = load_builtin("mx-clear")
    made = mujoco_button(button)
    rows = _pushed(_quick(made.xml), 100, 3.9, 0.2, made)
    off = rows[:, 2] - button.force_cN(rows[:, 0], np.abs(rows[:, 1]), "release")
    assert np.abs(off).max() < 0.1
    unlike = button.force_cN(rows[:, 0], 100, "press") - button.force_cN(rows[:, 0], 100, "release")
    assert np.abs(unlike).max() > 20


@pytest.mark.parametrize("name", ["mx-black", "mx-clear"])
def test_the_plain_file_moves_by_its_own_springs_and_friction(name: str) -> None:
    button = load_builtin(name)
    rows = _pushed(mjcf(button, velocity_mm_s=100).text, 100, 0.05, 0.97 * button.travel_mm)
    off = rows[:, 2] - button.force_cN(rows[:, 0], 100, "press")
    assert np.abs(off).max() < 0.3


def test_without_callbacks_the_force_is_applied_before_each_step() -> None:
    button = load_builtin("mx-clear")
    made = mujoco_button(button)
    model, data = _loaded(made.xml)
    data.qpos[0], data.qvel[0] = 0.0015, 0.1
    made.apply(model, data)
    assert data.qfrc_applied[0] == pytest.approx(-0.01 * float(button.force_cN(1.5, 100, "press")), abs=1e-4)
    assert not made.closed
    data.qpos[0] = 0.0025
    made.apply(model, data)
    assert made.closed


def test_a_released_cap_comes_back_to_the_top() -> None:
    made = mujoco_button(load_builtin("mx-red"))
    model, data = _loaded(_quick(made.xml))
    data.qpos[0] = 0.003
    with made.attached():
        mujoco.mj_step(model, data, nstep=1000)
    assert abs(data.qpos[0]) < 2e-5


def test_the_contact_closes_and_opens_with_its_hysteresis() -> None:
    button = load_builtin("mx-blue")
    made = mujoco_button(button)
    assert (button.actuation_mm, button.reset_mm) == (2.13, 1.675)
    # without userdata the button remembers it itself
    for xml in (made.xml, made.xml.replace('<size nuserdata="1"/>', "")):
        model, data = _loaded(xml)
        seen = []
        with made.attached():
            for x in (1.0, 2.1, 2.2, 1.9, 1.7, 1.6, 2.0):
                data.qpos[0] = x / 1000
                mujoco.mj_forward(model, data)
                seen.append(float(data.sensor("button_closed").data[0]))
        assert seen == [0, 0, 1, 1, 1, 0, 0]


def test_two_buttons_share_a_scene_without_sharing_force_or_contact() -> None:
    names = {"": "mx-blue", "b_": "mx-red"}
    first, second = (mujoco.MjSpec.from_string(mujoco_button(load_builtin(n)).xml) for n in names.values())
    first.attach(second, prefix="b_", frame=first.worldbody.add_frame(pos=[0.02, 0, 0]))
    model = first.compile()
    data = mujoco.MjData(model)
    # the scene has one slot of userdata; who has none remembers the contact itself
    buttons = [
        MujocoButton(load_builtin(name), joint=f"{prefix}button", slot=slot)
        for slot, (prefix, name) in enumerate(names.items())
    ]
    data.qpos[:] = 0.0018
    with buttons[0].attached(), buttons[1].attached():
        mujoco.mj_forward(model, data)
    for i, (prefix, name) in enumerate(names.items()):
        press, release = (float(load_builtin(name).force_cN(1.8, 1, s)) for s in Stroke)
        weight = 100 * data.qfrc_gravcomp[i]
        # at rest press and release are mixed
        assert weight - 100 * data.qfrc_passive[i] == pytest.approx((press + release) / 2, abs=0.1)
        assert data.sensor(f"{prefix}button_closed").data[0] == (name == "mx-red")


def test_a_scene_without_the_sensor_still_has_the_force() -> None:
    made = mujoco_button(load_builtin("mx-red"))
    line = next(row for row in made.xml.splitlines(keepends=True) if "button_closed" in row)
    model, data = _loaded(made.xml.replace(line, ""))
    data.qpos[0] = 0.003
    with made.attached():
        mujoco.mj_forward(model, data)
    assert data.qfrc_passive[0] < -0.3


def test_without_mujoco_its_installation_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with (
        pytest.raises(BuildError, match="pip install mujoco"),
        mujoco_button(load_builtin("mx-red")).attached(),
    ):
        pass


def test_the_callbacks_of_others_run_and_are_put_back() -> None:
    ran = []

    def mine(_model: Any, _data: Any) -> None:
        ran.append(1)

    made = mujoco_button(load_builtin("mx-red"))
    model, data = _loaded(made.xml)
    mujoco.set_mjcb_passive(mine)
    try:
        with made.attached():
            mujoco.mj_forward(model, data)
        assert ran
        assert mujoco.get_mjcb_passive() is mine
        assert mujoco.get_mjcb_sensor() is None
    finally:
        mujoco.set_mjcb_passive(None)


@pytest.mark.parametrize("name", builtin_names())
def test_the_table_behind_the_callback_is_the_model(name: str) -> None:
    button = load_builtin(name)
    made = mujoco_button(button)
    drawn = np.random.default_rng(1)
    for x, v in zip(drawn.uniform(0, button.travel_mm, 60), drawn.uniform(3, 220, 60), strict=True):
        for stroke, way in ((Stroke.PRESS, 1), (Stroke.RELEASE, -1)):
            wanted = float(button.force_cN(x, v, stroke))
            slope = abs(float(button.stiffness_cN_mm(x, v, stroke)))
            # a step of the table is 2 µm, of its speeds a twentieth of the fastest
            assert made.force_cN(float(x), float(way * v)) == pytest.approx(wanted, abs=0.65 + 0.002 * slope)


def test_a_model_without_a_press_is_refused() -> None:
    whole = load_builtin("mx-red")
    only = FDVVModel("back", whole.travel_mm, whole.of("release"))
    for make in (spring_button, mujoco_button):
        with pytest.raises(ModelError, match="no press curve"):
            make(only)


def test_a_cap_needs_a_mass() -> None:
    with pytest.raises(ModelError, match="cap_mass_g must be positive"):
        mjcf(load_builtin("mx-red"), cap_mass_g=0.0)


def test_a_name_that_is_markup_stays_a_name() -> None:
    made = mjcf(load_builtin("mx-red").renamed('"><worldbody/>\x01&'))
    assert _loaded(made.text)[0].nv == 1


def test_a_polyline_keeps_within_its_tolerance_and_uses_few_corners() -> None:
    x = np.linspace(0, 4, 801)
    y = 50 * np.sin(x)
    at = polyline(x, y, 0.25)
    assert at[0] == 0
    assert at[-1] == 800
    assert np.abs(np.interp(x, x[at], y[at]) - y).max() <= 0.25
    assert at.size < 40
    assert polyline(x, 3 * x + 1, 1e-9).tolist() == [0, 800]
