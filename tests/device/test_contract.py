import numpy as np
import pytest

from fdvv.device import Device, TwinDevice
from fdvv.errors import DeviceError
from fdvv.testing import DeviceConformance, ScriptedDevice, plain_surface
from fdvv.twin import mean_speed_mm_s


class TestScriptedDevice(DeviceConformance):
    def make(self) -> Device:
        return ScriptedDevice(gain=0.8, offset_cN=3.0, drag_cN_s_mm=0.05, noise_cN=1.0, noise_mm=0.005)


class TestTwinDevice(DeviceConformance):
    def make(self) -> Device:
        return TwinDevice(seed=4)


def test_a_scripted_device_feels_gain_times_command_plus_offset_and_drag() -> None:
    device = ScriptedDevice(gain=0.8, offset_cN=3.0, drag_cN_s_mm=0.05)
    device.upload(plain_surface(), 4.0)
    press = device.press(100.0)
    assert press.commanded_cN is not None
    down = press.t_s < 0.039
    assert press.force_cN[down] == pytest.approx(0.8 * press.commanded_cN[down] + 3 + 5)


def test_presses_of_the_twin_are_simulated_and_say_so() -> None:
    device = TwinDevice(seed=1)
    device.upload(plain_surface(), 4.0)
    assert device.info().simulated
    assert device.press(100.0).simulated


def test_the_same_seed_gives_the_same_bits_and_another_seed_does_not() -> None:
    presses = []
    for seed in (7, 7, 8):
        device = TwinDevice(seed=seed)
        device.upload(plain_surface(), 4.0)
        presses.append([device.press(v).force_cN.tobytes() for v in (50.0, 100.0, 100.0)])
    assert presses[0] == presses[1]
    assert presses[0] != presses[2]
    assert presses[0][1] != presses[0][2]


def test_presses_vary_in_pace_as_the_habit_of_the_finger_says() -> None:
    device = TwinDevice(seed=2)
    device.upload(plain_surface(), 4.0)
    presses = [device.press(100.0) for _ in range(60)]
    speeds = np.array([mean_speed_mm_s(p.t_s, p.displacement_mm, 4.0) for p in presses])
    assert 0.05 < speeds.std() / speeds.mean() < 0.25
    assert speeds.mean() == pytest.approx(100.0, rel=0.1)


def test_a_speed_beyond_what_a_finger_does_is_refused_with_the_limits() -> None:
    device = TwinDevice()
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match=r"0\.5 to 500 mm/s"):
        device.press(2000.0)
