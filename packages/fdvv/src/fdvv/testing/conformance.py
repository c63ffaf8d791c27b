"""What every device must honour, as a test class to inherit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from fdvv.device.contract import Device, ProgramDevice
from fdvv.device.remote import surface_image
from fdvv.errors import DeviceError
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Fault, Settings


def plain_surface(force_cN: float = 40.0, travel_mm: float = 4.0) -> ForceSurface:
    """Make a surface that rises gently from force_cN, the release 5 cN below the press."""
    x = np.linspace(0.0, travel_mm, 41)
    press = np.tile(force_cN + 5 * x, (2, 1))
    return ForceSurface(x, np.array([50.0, 200.0]), press, press - 5)


class DeviceConformance:
    """Inherit, implement `make`, and pytest runs the contract of fdvv.device.contract.Device on it.

    travel_mm, force_cN : of the table that is pressed, which rises by 5 cN/mm; a weak device needs less.
    """

    travel_mm = 4.0
    speed_mm_s = 100.0
    force_cN = 40.0

    def make(self) -> Device:
        """Return a fresh device; twice the same one if it has a seed."""
        raise NotImplementedError

    def pressed(self, device: Device) -> Press:
        device.upload(plain_surface(self.force_cN, self.travel_mm), self.travel_mm)
        return device.press(self.speed_mm_s)

    def test_it_tells_who_it_is(self) -> None:
        info = self.make().info()
        assert info.name
        assert info.force_limit_cN > 0
        assert info.travel_limit_mm >= self.travel_mm
        assert 0 < info.tick_s <= 0.01

    def test_a_press_before_an_upload_is_refused(self) -> None:
        refused(lambda: self.make().press(self.speed_mm_s))

    def test_a_table_beyond_the_force_limit_is_refused(self) -> None:
        device = self.make()
        limit = device.info().force_limit_cN
        for force in (limit + 1, -limit - 60):
            refused(partial(device.upload, plain_surface(force), self.travel_mm))

    def test_a_travel_beyond_the_stop_is_refused(self) -> None:
        device = self.make()
        for travel_mm in (device.info().travel_limit_mm + 0.1, 0.0, -1.0):
            refused(partial(device.upload, plain_surface(), travel_mm))

    def test_a_refused_upload_leaves_the_old_table(self) -> None:
        device, other = self.make(), self.make()
        expected = self.pressed(other)
        device.upload(plain_surface(self.force_cN, self.travel_mm), self.travel_mm)
        refused(lambda: device.upload(plain_surface(1e6), self.travel_mm))
        assert np.allclose(np.median(device.press(100.0).force_cN), np.median(expected.force_cN), atol=30)

    def test_a_speed_that_is_none_is_refused(self) -> None:
        device = self.make()
        self.pressed(device)
        for speed in (0.0, -50.0, float("nan")):
            refused(partial(device.press, speed))

    def test_settings_are_written_whole_and_want_a_new_upload(self) -> None:
        device = self.make()
        device.configure(other_settings(device))
        assert device.settings().lead_us == other_settings(self.make()).lead_us
        refused(lambda: device.press(self.speed_mm_s))
        assert self.pressed(device).displacement_mm.max() > 0.98 * self.travel_mm

    def test_settings_at_odds_with_each_other_are_refused_and_the_old_ones_stay(self) -> None:
        device = self.make()
        before = device.settings()
        self.pressed(device)
        refused(partial(device.configure, replace(before, window_start_um16=9000, window_end_um16=8000)))
        assert device.settings() == before
        device.press(self.speed_mm_s)

    def test_a_paced_table_is_pressed_like_any_other(self) -> None:
        device = self.make()
        surface = plain_surface(self.force_cN, self.travel_mm)
        device.upload(surface, self.travel_mm, paced=True)
        press = device.press(self.speed_mm_s)
        assert press.commanded_cN is not None
        assert 35 < np.median(press.commanded_cN) < 65

    def test_a_press_goes_down_and_comes_back(self) -> None:
        press = self.pressed(self.make())
        x = press.displacement_mm
        assert x[0] < 0.5
        assert x.max() > 0.98 * self.travel_mm
        assert x[-1] < 0.5 * self.travel_mm
        assert press.velocity_mm_s == self.speed_mm_s

    def test_a_press_holds_what_the_rig_sensed_and_did(self) -> None:
        device = self.make()
        press = self.pressed(device)
        columns = (press.sensed_mm, press.sensed_cN, press.commanded_cN, press.saturated, press.tick)
        assert all(column is not None for column in columns)
        assert press.tick is not None
        assert np.allclose(np.diff(press.t_s[press.tick]), device.info().tick_s, rtol=1e-6)
        assert press.simulated == device.info().simulated


class ProgramConformance(DeviceConformance):
    """The contract of fdvv.device.contract.ProgramDevice: every device with the firmware."""

    def make(self) -> ProgramDevice:
        raise NotImplementedError

    def program(self, force_cN: float = 40.0) -> bytes:
        """Return a program that follows the plain surface."""
        return surface_image(plain_surface(force_cN, self.travel_mm), self.travel_mm)

    def test_a_program_is_pressed_like_a_surface(self) -> None:
        device = self.make()
        device.upload_program(self.program())
        press = device.press(self.speed_mm_s)
        assert press.commanded_cN is not None
        assert 35 < np.median(press.commanded_cN) < 65

    def test_a_damaged_program_is_refused_and_the_old_one_stays(self) -> None:
        device = self.make()
        device.upload_program(self.program())
        damaged = bytearray(self.program(80.0))
        damaged[-1] ^= 1
        refused(partial(device.upload_program, bytes(damaged)))
        press = device.press(self.speed_mm_s)
        assert press.commanded_cN is not None
        assert np.max(press.commanded_cN) < 65

    def test_there_is_no_fault_after_a_press(self) -> None:
        device = self.make()
        self.pressed(device)
        assert device.fault().fault is Fault.NONE
        assert str(device.fault()) == "no fault"
        refused(device.clear_fault)

    def test_stopping_is_always_allowed(self) -> None:
        device = self.make()
        device.stop()
        self.pressed(device)
        device.stop()
        device.stop()

    def test_a_press_misses_no_tick(self) -> None:
        press = self.pressed(self.make())
        assert press.tick is not None
        ticks = np.flatnonzero(press.tick)
        assert len(set(np.diff(ticks))) == 1

    def test_closing_twice_does_nothing_more(self) -> None:
        device = self.make()
        self.pressed(device)
        device.close()
        device.close()
        refused(lambda: device.press(self.speed_mm_s))


def other_settings(device: Device) -> Settings:
    """Return a device's settings with another look ahead, which nothing makes use of."""
    return replace(device.settings(), lead_us=1234)


def refused(call: Callable[[], object]) -> None:
    """Fail unless the call raises DeviceError with one line of text."""
    text = ""
    try:
        call()
    except DeviceError as error:
        text = str(error)
    assert text, "expected a DeviceError with a text, the call was accepted"
    assert "\n" not in text
