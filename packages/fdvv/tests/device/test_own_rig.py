"""A rig of one's own: its numbers are the firmware's settings, a hand presses it, its sensors read true."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.compensation.presses import split_strokes
from fdvv.device.boards import LibraryBoard
from fdvv.device.lacking import NO_FORCE_SENSOR, NO_LIMITER, NO_VIBRATION, lacking
from fdvv.device.linked import LinkedDevice
from fdvv.device.own_rig import OwnRigPerson, RigNumbers, find_rig
from fdvv.device.twin import TwinDevice
from fdvv.errors import BuildError, InputError, ModelError
from fdvv.testing.conformance import ProgramConformance, plain_surface
from tests.support.plain_rig import PlainRig


class TestOwnRig(ProgramConformance):
    def make(self) -> LinkedDevice:
        return LinkedDevice(LibraryBoard(), OwnRigPerson(PlainRig, 1))


def test_what_the_sensors_read_is_what_happens_within_their_noise() -> None:
    device = TestOwnRig().make()
    device.upload(plain_surface(), 4.0)
    press = device.press(100.0)
    assert press.sensed_mm is not None
    assert press.sensed_cN is not None
    assert np.abs(press.sensed_mm - press.displacement_mm).max() < 0.1
    assert np.abs(press.sensed_cN - press.force_cN).max() < 1.0
    assert press.simulated


def test_the_hand_finds_the_speed_that_is_asked_for() -> None:
    device = TestOwnRig().make()
    device.upload(plain_surface(), 4.0)
    for velocity_mm_s in (50.0, 200.0):
        presses = [device.press(velocity_mm_s) for _ in range(6)]
        achieved = []
        for press in presses[2:]:
            down, _ = split_strokes(press.displacement_mm, 4.0)
            x_mm, t_s = press.displacement_mm[down], press.t_s[down]
            inside = (x_mm > 0.4) & (x_mm < 3.6)
            achieved.append(np.ptp(x_mm[inside]) / np.ptp(t_s[inside]))
        assert np.median(achieved) == pytest.approx(velocity_mm_s, rel=0.2)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("full_duty_N", 0.4),
        ("supply_V", 60.0),
        ("tick_us", 40),
        ("force_sensor_N", 20.0),
        ("travel_mm", 25.0),
    ],
)
def test_numbers_that_the_firmware_cannot_hold_are_refused_by_name(field: str, value: float) -> None:
    numbers = {"name": "mine", "full_duty_N": 6.0, "force_limit_N": 4.0, field: value}
    with pytest.raises(ModelError, match=f"mine: {field} is {value:g}, the firmware takes"):
        RigNumbers(**numbers)  # type: ignore[arg-type]


def test_no_more_force_than_the_motor_has_may_be_commanded() -> None:
    with pytest.raises(ModelError, match=r"weak: force_limit_N is 4\.4, at full duty the motor gives 0\.5"):
        RigNumbers("weak", 0.5, 4.4)


def test_a_sensor_that_is_too_wide_for_the_firmware_is_refused() -> None:
    with pytest.raises(ModelError, match=r"wide: sensor_mm is \(0.0, 40.0\), the firmware takes 25 mm"):
        RigNumbers("wide", 6.0, 4.4, sensor_mm=(0.0, 40.0))


def smallest() -> PlainRig:
    """A rig like a small voice coil at 20 kHz, without stop and vibration board."""
    rig = PlainRig()
    rig.numbers = RigNumbers("small", 0.5, 0.45, supply_V=3.0, tick_us=50, travel_limiter=False)
    return rig


def deepest() -> PlainRig:
    """A strong rig at 250 Hz, whose stop goes to 20 mm."""
    rig = PlainRig()
    rig.numbers = RigNumbers(
        "deep", 50.0, 5.0, supply_V=48.0, tick_us=4000, sensor_mm=(-2.0, 28.0), travel_mm=20.0
    )
    return rig


def test_a_rig_of_any_size_is_built_pressed_and_reads_true() -> None:
    for make, travel_mm, force_cN in ((smallest, 4.0, 8.0), (deepest, 18.0, 60.0)):
        device = LinkedDevice(LibraryBoard(), OwnRigPerson(make, 1))
        assert device.info().travel_limit_mm == pytest.approx(make().numbers.travel_mm, abs=0.02)
        device.upload(plain_surface(force_cN, travel_mm), travel_mm)
        press = device.press(100.0)
        assert press.sensed_mm is not None
        assert press.displacement_mm.max() > 0.95 * travel_mm
        # one tick of a hand that moves at 0.3 m/s
        assert np.abs(press.sensed_mm - press.displacement_mm).max() < 0.05


def test_what_a_rig_lacks_is_said_with_what_still_works() -> None:
    small = LinkedDevice(LibraryBoard(), OwnRigPerson(smallest))
    assert lacking(small) == (NO_FORCE_SENSOR, NO_LIMITER, NO_VIBRATION)
    assert lacking(small, vibrating=False) == (NO_FORCE_SENSOR, NO_LIMITER)
    assert lacking(LinkedDevice(LibraryBoard(), OwnRigPerson(PlainRig))) == (NO_VIBRATION,)
    assert lacking(TwinDevice()) == ()


def test_full_duty_is_the_force_that_the_rig_says() -> None:
    settings = PlainRig.numbers.settings()
    force_cN64 = 64 * 100 * PlainRig.numbers.full_duty_N
    assert force_cN64 * settings.duty_gain_q16 / 2**16 == pytest.approx(2**15, rel=1e-4)


def test_what_is_no_rig_is_refused_in_a_line(tmp_path: Path) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text("import nowhere_at_all\n")
    empty = tmp_path / "empty.py"
    empty.write_text("")
    with pytest.raises(BuildError, match=r"broken\.py: cannot be imported: ModuleNotFoundError"):
        find_rig(f"{broken}:Rig")
    with pytest.raises(InputError, match="is no class or function"):
        find_rig(f"{empty}:Rig")
    with pytest.raises(InputError, match="is no file of Python"):
        find_rig(f"{tmp_path / 'absent.py'}:Rig")
    with pytest.raises(InputError, match="names no rig"):
        find_rig("nothing")


def test_a_rig_whose_physics_diverges_is_named() -> None:
    class Diverging(PlainRig):
        def step(self, motor_N: float, finger_N: float, stop_mm: float, dt_s: float) -> float:
            return float("nan")

    with pytest.raises(InputError, match="plain: returned nan mm; use a shorter step"):
        LinkedDevice(LibraryBoard(), OwnRigPerson(Diverging))
