from dataclasses import replace

import numpy as np
import pytest

from fdvv.device.contract import Device
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError
from fdvv.model.surface import ForceSurface
from fdvv.testing.conformance import DeviceConformance, plain_surface
from fdvv.testing.scripted import ScriptedDevice
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import silence
from fdvv.twin.pace import mean_speed_mm_s, solve_program_pace
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.twin.simulate import simulate_program


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


def test_the_same_seed_gives_the_same_bits_and_another_seed_does_not() -> None:
    presses = []
    for seed in (7, 7, 8):
        device = TwinDevice(seed=seed)
        device.upload(plain_surface(), 4.0)
        presses.append([device.press(v).force_cN.tobytes() for v in (50.0, 100.0, 100.0)])
    assert presses[0] == presses[1]
    assert presses[0] != presses[2]
    assert presses[0][1] != presses[0][2]


def test_a_speed_beyond_what_a_finger_does_is_refused_with_the_limits() -> None:
    device = TwinDevice()
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match=r"0\.5 to 500 mm/s"):
        device.press(2000.0)


DRAG = {"predictor_q16": 30000, "lead_us": 1000, "brake_lead_us": 1000, "drag_q13": 3000}


def test_repeated_presses_of_the_twin_are_those_of_the_program_before() -> None:
    device = TwinDevice(seed=3)
    device.upload(plain_surface(), 4.0)
    made = [device.press(100.0) for _ in range(3)]
    device.upload(plain_surface(), 4.0)
    device.repeat_presses()
    again = [device.press(100.0) for _ in range(4)]
    for one, other in zip(made, again, strict=False):
        np.testing.assert_array_equal(one.displacement_mm, other.displacement_mm)
    fresh = again[3].displacement_mm
    assert all(fresh.size != one.displacement_mm.size or (fresh != one.displacement_mm).any() for one in made)


def test_the_twin_configured_as_it_is_gives_the_same_bits() -> None:
    presses = []
    for again in (False, True):
        device = TwinDevice(seed=3)
        if again:
            device.configure(device.settings())
        device.upload(plain_surface(), 4.0)
        presses.append(device.press(100.0).force_cN.tobytes())
    assert presses[0] == presses[1]


def test_what_the_twin_is_configured_with_is_at_work() -> None:
    device = TwinDevice(seed=3)
    device.configure(replace(device.settings(), **DRAG))
    device.upload(plain_surface(), 4.0)
    press = device.press(200.0)
    bottom = int(np.argmax(press.displacement_mm > 3.9))
    assert press.commanded_cN is not None
    # 3000 / 8192 cN64 per mm_s16 at some 200 mm/s are 18 cN
    down = (press.displacement_mm > 1) & (np.arange(press.t_s.size) < bottom)
    taken = plain_surface().press_cN[0, 20] - np.median(press.commanded_cN[down])
    assert 9 < taken < 32


def test_the_pace_is_found_under_what_is_configured() -> None:
    rig, finger, image = Rig(), Finger(), image_of(plain_surface(), 4.0).image
    with_drag = replace(settings_of(rig), **DRAG)
    speeds = []
    for settings in (with_drag, None):
        gesture = plan(finger, 4e-3, solve_program_pace(rig, finger, image, 100.0, settings=settings))
        trace = simulate_program(
            rig, finger, gesture, image, silence(rig, gesture), 100.0, settings=with_drag
        )
        speeds.append(mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0))
    assert speeds[0] == pytest.approx(100, rel=0.01)
    assert abs(speeds[1] - 100) > 2


def test_a_tick_that_is_not_the_rigs_is_refused() -> None:
    device = TwinDevice()
    with pytest.raises(DeviceError, match="tick_us is 1000 in this rig and cannot be 500"):
        device.configure(replace(device.settings(), tick_us=500))


def test_a_paced_table_goes_by_the_announced_speed_and_another_by_the_decided_one() -> None:
    x = np.linspace(0.0, 4.0, 41)
    # steeper than a hand is steady: a row of its own for every speed
    table = np.repeat([[20.0], [30.0], [40.0]], 41, axis=1)
    surface = ForceSurface(x, np.array([80.0, 100.0, 120.0]), table, table)
    commands = {}
    for paced in (True, False):
        device = TwinDevice(seed=5)
        device.upload(surface, 4.0, paced)
        found = [device.press(100.0).commanded_cN for _ in range(4)]
        commands[paced] = np.concatenate([c for c in found if c is not None])
    np.testing.assert_allclose(commands[True], 30.0, atol=0.02)
    assert np.ptp(commands[False]) > 2
