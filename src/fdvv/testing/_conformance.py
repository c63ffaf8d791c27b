"""What every device must honour, as a test class to inherit."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from fdvv.device import Device
from fdvv.errors import DeviceError
from fdvv.model import ForceSurface, Press


def plain_surface(force_cN: float = 40.0, travel_mm: float = 4.0) -> ForceSurface:
    """Make a surface that rises gently from force_cN, the release 5 cN below the press."""
    x = np.linspace(0.0, travel_mm, 41)
    press = np.tile(force_cN + 5 * x, (2, 1))
    return ForceSurface(x, np.array([50.0, 200.0]), press, press - 5)


class DeviceConformance:
    """Inherit, implement `make`, and pytest runs the contract of fdvv.device.Device on it."""

    travel_mm = 4.0
    speed_mm_s = 100.0

    def make(self) -> Device:
        """Give a fresh device; twice the same one if it has a seed."""
        raise NotImplementedError

    def pressed(self, device: Device) -> Press:
        """Upload the plain surface and press once."""
        device.upload(plain_surface(travel_mm=self.travel_mm), self.travel_mm)
        return device.press(self.speed_mm_s)

    def test_it_tells_who_it_is(self) -> None:
        """Name and limits are usable."""
        info = self.make().info()
        assert info.name
        assert info.force_limit_cN > 0
        assert info.travel_limit_mm >= self.travel_mm
        assert 0 < info.tick_s <= 0.01

    def test_a_press_before_an_upload_is_refused(self) -> None:
        """There is nothing to press yet."""
        refused(lambda: self.make().press(self.speed_mm_s))

    def test_a_table_beyond_the_force_limit_is_refused(self) -> None:
        """Force beyond the limit, either sign."""
        device = self.make()
        limit = device.info().force_limit_cN
        for force in (limit + 1, -limit - 60):
            refused(partial(device.upload, plain_surface(force), self.travel_mm))

    def test_a_travel_beyond_the_stop_is_refused(self) -> None:
        """Travel beyond the limit, or none at all."""
        device = self.make()
        for travel_mm in (device.info().travel_limit_mm + 0.1, 0.0, -1.0):
            refused(partial(device.upload, plain_surface(), travel_mm))

    def test_a_refused_upload_leaves_the_old_table(self) -> None:
        """Whole or not at all."""
        device, other = self.make(), self.make()
        expected = self.pressed(other)
        device.upload(plain_surface(travel_mm=self.travel_mm), self.travel_mm)
        refused(lambda: device.upload(plain_surface(1e6), self.travel_mm))
        assert np.allclose(np.median(device.press(100.0).force_cN), np.median(expected.force_cN), atol=30)

    def test_a_speed_that_is_none_is_refused(self) -> None:
        """Zero, negative and not-a-number speeds."""
        device = self.make()
        self.pressed(device)
        for speed in (0.0, -50.0, float("nan")):
            refused(partial(device.press, speed))

    def test_a_press_goes_down_and_comes_back(self) -> None:
        """One stroke pair, from rest to the stop and back."""
        press = self.pressed(self.make())
        x = press.displacement_mm
        assert x[0] < 0.5
        assert x.max() > 0.98 * self.travel_mm
        assert x[-1] < 0.5 * self.travel_mm
        assert press.velocity_mm_s == self.speed_mm_s

    def test_a_press_holds_what_the_rig_sensed_and_did(self) -> None:
        """Every optional column is there, and ticks are one period apart."""
        device = self.make()
        press = self.pressed(device)
        columns = (press.sensed_mm, press.sensed_cN, press.commanded_cN, press.saturated, press.tick)
        assert all(column is not None for column in columns)
        assert press.tick is not None
        assert np.allclose(np.diff(press.t_s[press.tick]), device.info().tick_s, rtol=1e-6)
        assert press.simulated == device.info().simulated


def refused(call: Callable[[], object]) -> None:
    """Fail unless the call raises DeviceError with one line of text."""
    text = ""
    try:
        call()
    except DeviceError as error:
        text = str(error)
    assert text, "expected a DeviceError with a text, the call was accepted"
    assert "\n" not in text
