"""From a model to a switch: real curves come back within 3 cN on the twin, and all of it is written down."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.open import open_button
from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.twin.files import load_button
from fdvv.twin.simulate_button import probe_button
from fdvv_switch.coil import Envelope
from fdvv_switch.design_button import MechanismResult, design_mechanism
from fdvv_switch.files import write_mechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.making import Making
from fdvv_switch.residual import WANTED_cN
from fdvv_switch.twin import press_design

THREE = [("mx-red", "leaf"), ("mx-clear", "leaf"), ("rubber-dome", "dome")]
DOMES = [
    "buddyog-topre/Topre_R1_45g/DataLog_1.csv",
    "buddyog-topre/NiZ_Black_65g/NiZ_65g-DataLog_3.csv",
    "haata/Lenovo P51 Keyboard.csv",
]


@pytest.fixture(scope="module")
def clear() -> MechanismResult:
    return design_mechanism(load_builtin("mx-clear"), "leaf", speeds_mm_s=(100.0,))


@pytest.mark.parametrize(("name", "kind"), THREE)
def test_a_linear_a_tactile_and_a_dome_curve_come_back_within_3_cN(name: str, kind: str) -> None:
    result = design_mechanism(load_builtin(name), kind, speeds_mm_s=())
    slow = result.pressed[0]
    assert result.met
    assert max(slow.press.rms_cN, slow.release.rms_cN) <= WANTED_cN


@pytest.mark.slow
@pytest.mark.parametrize("name", ["mx-clear", "mx-brown", "mx-black", "mx-red", "mx-blue", "rubber-dome"])
def test_auto_takes_a_leaf_for_leaf_switches_and_a_dome_for_a_dome(name: str) -> None:
    result = design_mechanism(load_builtin(name), speeds_mm_s=())
    assert result.mechanism.kind == ("dome" if name == "rubber-dome" else "leaf")
    assert result.met == (name != "mx-blue")
    worst = {k.kind: k.residual.worst_cN for k in result.kinds if k.residual}
    assert worst[result.mechanism.kind] <= min(worst.values()) + 0.5


@pytest.mark.slow
@pytest.mark.shared
@pytest.mark.parametrize("name", DOMES)
def test_measured_domes_come_back_within_3_cN(shared_data: Path, name: str) -> None:
    result = design_mechanism(open_button(str(shared_data / name)), speeds_mm_s=())
    assert result.mechanism.kind == "dome"
    assert result.met


def test_a_leaf_is_pressed_as_it_is_built_not_by_its_curves(clear: MechanismResult) -> None:
    assert isinstance(clear.mechanism, LeafMechanism)
    assert clear.button is not None
    assert clear.button.cam is not None
    lifted = replace(clear.button.cam, height_m=clear.button.cam.height_m * 1.3)
    other = press_design(replace(clear.button, cam=lifted), clear.model, ())[0]
    assert other.press.rms_cN > clear.pressed[0].press.rms_cN + 1.0


def test_at_speed_a_model_that_knows_speeds_is_compared_at_its_own(clear: MechanismResult) -> None:
    slow, fast = clear.pressed
    assert (slow.own_speed, fast.own_speed) == (False, True)
    red = load_builtin("mx-red")
    assert clear.button is not None
    pressed = press_design(clear.button, red, (100.0,))
    assert not pressed[1].own_speed


def test_the_folder_is_complete_and_its_button_presses_as_reported(
    clear: MechanismResult, tmp_path: Path
) -> None:
    for extra in ("ezdxf", "matplotlib"):
        pytest.importorskip(extra)
    written = write_mechanism(clear, tmp_path / "switch")
    names = {path.name for path in written}
    assert names == {
        *("mechanism.json", "curves.csv", "cam.csv", "spring.dxf", "cam.dxf", "leaf.dxf", "button.toml"),
        "report.html",
    }
    document = json.loads((tmp_path / "switch" / "mechanism.json").read_text())
    assert document["kind"] == "leaf"
    assert document["parts"]["spring"]["wire_mm"] > 0
    with (tmp_path / "switch" / "curves.csv").open() as file:
        rows = list(csv.DictReader(file))
    press, target = (np.array([float(r[c]) for r in rows]) for c in ("press_cN", "target_press_cN"))
    miss = float(np.sqrt(np.mean((press - target) ** 2)))
    assert miss == pytest.approx(document["residual"]["press"]["rms_cN"], abs=0.01)
    assert clear.button is not None
    again = load_button(tmp_path / "switch" / "button.toml")
    np.testing.assert_allclose(probe_button(again).press_cN, probe_button(clear.button).press_cN, atol=0.1)
    report = (tmp_path / "switch" / "report.html").read_text()
    assert "Simulated" in report
    assert report.count("<svg") == 2


def test_where_nothing_can_be_made_every_reason_is_listed() -> None:
    tiny = Making(envelope=Envelope(outer_mm=3.0, inner_mm=2.6))
    model: FDVVModel = load_builtin("mx-red")
    with pytest.raises(InputError, match="spring: no spring of"):
        design_mechanism(model, "spring", tiny)


def test_a_model_without_release_is_refused_and_named_once() -> None:
    model = load_builtin("mx-red")
    with pytest.raises(InputError, match="no release") as caught:
        design_mechanism(replace(model, curves=model.of("press")))
    assert str(caught.value).count("mx-red") == 1
