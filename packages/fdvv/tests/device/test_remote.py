"""A device on a real terminal line, in real time, pressed by someone else's thread."""

from __future__ import annotations

import os
import tty
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from fdvv.device.contract import PressError
from fdvv.device.plant import Inputs
from fdvv.device.remote import PressedDevice, find_press
from fdvv.device.serial import SerialPort
from fdvv.device.telemetry import TickColumns
from fdvv.errors import DeviceError
from fdvv.protocol.tables import Fault
from fdvv.testing.conformance import plain_surface
from tests.support.pressed_rig import SETTINGS, Rig
from tests.support.scripted_person import ScriptedPerson


def opened(rig: Rig, patience_s: float = 20.0) -> PressedDevice:
    device = PressedDevice(SerialPort(rig.path), patience_s)
    device.client.write_settings(SETTINGS)
    return device


@pytest.fixture
def rig() -> Iterator[Callable[..., Rig]]:
    rigs: list[Rig] = []

    def make(person: ScriptedPerson | None = None, presses: int = 1) -> Rig:
        rigs.append(Rig(person or ScriptedPerson(), presses))
        rigs[-1].start()
        return rigs[-1]

    yield make
    for one in rigs:
        one.end()


def test_a_person_s_press_is_found_in_the_telemetry_of_a_serial_line(rig: Callable[..., Rig]) -> None:
    with opened(rig()) as device:
        device.upload(plain_surface(), 4.0)
        press = device.press(100.0)
    assert press.displacement_mm.max() == pytest.approx(4.0, abs=0.01)
    assert press.displacement_mm[0] < 0.2 > press.displacement_mm[-1]
    assert 0.09 < press.t_s[-1] < 0.13
    assert press.commanded_cN is not None
    assert np.median(press.commanded_cN) == pytest.approx(50, abs=10)


def test_without_a_press_an_error_is_raised_after_the_patience(rig: Callable[..., Rig]) -> None:
    device = opened(rig(presses=0), 0.2)
    device.upload(plain_surface(), 4.0)
    with pytest.raises(PressError, match=r"nobody pressed within 0\.2 s") as caught:
        device.press(100.0)
    seen = caught.value.press
    assert seen is not None, "what was recorded meanwhile says whether that is the person's doing"
    assert seen.displacement_mm.max() < 0.15, "the cap lay at the top all the while"
    assert device.fault().fault is Fault.NONE
    device.close()


def test_a_fault_ends_the_waiting(rig: Callable[..., Rig]) -> None:
    def broken(tick: int, inputs: Inputs) -> Inputs:
        return inputs._replace(lowest=0) if tick > 50 else inputs

    device = opened(rig(ScriptedPerson(meddle=broken)))
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match="position_low"):
        device.press(100.0)
    device.close()


def test_a_line_that_was_closed_and_opened_again_goes_on(rig: Callable[..., Rig]) -> None:
    device = opened(rig())
    device.upload(plain_surface(), 4.0)
    device.client.reconnect()
    assert device.press(100.0).displacement_mm.max() > 3.9
    device.close()


def test_a_line_without_a_device_is_reported(rig: Callable[..., Rig]) -> None:
    line, slave = os.openpty()
    tty.setraw(slave)
    with pytest.raises(DeviceError, match="no answer to hello"):
        PressedDevice(SerialPort(os.ttyname(slave)))
    os.close(line)
    os.close(slave)


def columns(displacement_mm: list[float]) -> TickColumns:
    x = np.array(displacement_mm)
    zero = np.zeros(x.size, np.int64)
    return TickColumns(np.arange(x.size), x, 0.0 * x, 0.0 * x, 0.0 * x, zero, zero)


@pytest.mark.parametrize(
    ("path", "found"),
    [
        ([0.0] * 30 + [4.0] * 5 + [0.0] * 30, (10, 55)),
        ([0.0] * 5 + [4.0] * 5 + [0.0] * 30, (0, 30)),
        ([0.0] * 30 + [4.0] * 5 + [0.0] * 5, None),  # not back for long enough
        ([0.0] * 30 + [2.0] * 5 + [0.0] * 30, None),  # a touch
        ([0.0] * 30 + [2.0] * 5 + [0.0] * 30 + [3.9] * 2 + [0.0] * 20, (45, 87)),
        ([4.0] * 5 + [0.0] * 30 + [4.0] * 5 + [0.0] * 30, (15, 60)),  # held as it began
        ([0.0] * 30, None),
        ([], None),
    ],
)
def test_only_a_whole_press_counts(path: list[float], found: tuple[int, int] | None) -> None:
    chosen = find_press(columns(path), 4.0)
    if found is None:
        assert chosen is None
    else:
        assert chosen is not None
        rows = np.flatnonzero(chosen)
        assert (rows[0], rows[-1] + 1) == found
