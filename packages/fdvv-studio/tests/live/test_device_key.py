"""A device under a person's hand: when its key went down, on the host's clock."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import pytest

from fdvv.device.linked import LinkedDevice
from fdvv.device.open import open_device
from fdvv.device.plant import Inputs
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model.file import load_builtin
from fdvv.program.button import button_program
from fdvv_studio.live.device_key import DeviceKey
from tests.support.pressed_rig import KeyedRig
from tests.support.scripted_person import ScriptedPerson

pytestmark = pytest.mark.clock

TICK_s = 250e-6


@pytest.fixture
def rig() -> Iterator[KeyedRig]:
    found = KeyedRig(presses=3)
    found.start()
    yield found
    found.end()


def wait_for(rig: KeyedRig, presses: int) -> float:
    until_s = time.monotonic() + 20.0
    while len(rig.pressed_s) < presses and time.monotonic() < until_s:
        time.sleep(0.01)
    assert len(rig.pressed_s) >= presses
    time.sleep(0.1)  # for the line
    return time.monotonic()


def test_the_key_s_times_are_those_of_the_board_s_own_ticks(rig: KeyedRig) -> None:
    key, begun_s = DeviceKey(open_device(f"serial:{rig.path}")), time.monotonic()
    key.render(load_builtin("mx-red"))
    found = key.pressed_s(begun_s, wait_for(rig, 3))
    assert found == pytest.approx(rig.pressed_s[:3], abs=1e-3 * key.clock_error_ms + TICK_s)
    assert key.clock_error_ms < 10
    assert key.pressed_s(found[1] - 1e-6, found[1] + 1e-6) == (found[1],)
    key.close()
    with pytest.raises(DeviceError, match="open it again"):
        key.render(load_builtin("mx-red"))


def test_a_program_is_put_under_the_hand_as_a_model_is(rig: KeyedRig) -> None:
    key, begun_s = DeviceKey(open_device(f"serial:{rig.path}")), time.monotonic()
    key.render(button_program(load_builtin("mx-red")))
    found = key.pressed_s(begun_s, wait_for(rig, 3))
    assert found == pytest.approx(rig.pressed_s[:3], abs=1e-3 * key.clock_error_ms + TICK_s)
    key.close()


def test_between_two_buttons_there_is_no_force(rig: KeyedRig) -> None:
    rig.presses = 0
    key = DeviceKey(open_device(f"serial:{rig.path}"))
    key.render(load_builtin("mx-clear"))
    time.sleep(0.2)
    assert rig.port.outputs.enable
    key.rest()
    assert not rig.port.outputs.enable
    key.render(load_builtin("mx-red"))
    key.close()
    time.sleep(0.05)
    assert not rig.port.outputs.enable


def test_a_device_that_fell_to_zero_force_says_so_once_and_renders_no_more() -> None:
    def broken(tick: int, inputs: Inputs) -> Inputs:
        return inputs._replace(lowest=0) if tick > 50 else inputs

    rig, said = KeyedRig(1, ScriptedPerson(meddle=broken)), list[str]()
    rig.start()
    key = DeviceKey(open_device(f"serial:{rig.path}"), said.append)
    key.render(load_builtin("mx-red"))
    until_s = time.monotonic() + 10
    while not said and time.monotonic() < until_s:
        time.sleep(0.02)
    assert "fell to zero force: position low; let go and play it again" in said[0]
    with pytest.raises(DeviceError, match="position low"):
        key.pressed_s(0.0, time.monotonic())
    key.close()
    rig.end()
    assert len(said) == 1


def test_a_press_that_the_line_may_have_lost_is_not_taken_for_none(rig: KeyedRig) -> None:
    rig.presses = 0
    key = DeviceKey(open_device(f"serial:{rig.path}"))
    key.render(load_builtin("mx-red"))
    key.pressed_s(0.0, time.monotonic())
    rig.lose = 2
    while rig.lose:
        time.sleep(0.01)
    time.sleep(0.1)
    with pytest.raises(DeviceError, match=r"the line lost \d frames, maybe a press; play it again"):
        key.pressed_s(0.0, time.monotonic())
    assert key.pressed_s(0.0, 0.0) == ()
    key.close()


def test_a_device_that_nobody_presses_is_refused() -> None:
    device = open_device("host")
    assert isinstance(device, LinkedDevice)
    with pytest.raises(InputError, match="is pressed by no person; use serial:PORT"):
        DeviceKey(device)
    device.close()


def test_a_button_that_the_device_does_not_take_ends_nothing(rig: KeyedRig) -> None:
    rig.presses = 0
    key, fits = DeviceKey(open_device(f"serial:{rig.path}")), load_builtin("mx-red")
    stiff = tuple(replace(one, control_points_cN=30 * one.control_points_cN) for one in fits.curves)
    with pytest.raises((InputError, ModelError)):
        key.render(replace(fits, curves=stiff))
    key.render(fits)
    assert key.problem == ""
    key.close()
