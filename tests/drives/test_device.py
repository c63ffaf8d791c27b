"""What ends a press on a drive in zero torque, in simulated time."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from fdvv.errors import DeviceError
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Fault
from fdvv.rendering.compensate import check_force_sensor
from fdvv.testing.conformance import plain_surface
from fdvv_drives.device import DriveDevice
from fdvv_drives.stage import Coil, Limits, Loop, Mechanics, Stage
from fdvv_drives.testing.direct import DirectDrive, VirtualClock, direct_device, direct_stage


class Pressing:
    """A device in the middle of a press, at which something then happens."""

    def __init__(self, stage: object = None, force_cN: float = 40.0) -> None:
        self.device, self.drive, self.clock = direct_device(stage)  # type: ignore[arg-type]
        self.device.upload(plain_surface(force_cN, 4.0), 4.0)

    def press(self) -> str:
        """Press, and return the one line in which it ends."""
        with pytest.raises(DeviceError) as error:
            self.device.press(100.0)
        assert "\n" not in str(error.value)
        assert self.drive.calls[-1] == "stop"
        assert self.drive.torque == 0.0
        return str(error.value)

    def when_down(self, act: object) -> None:
        """Do something once the cap is 1 mm down."""
        exchange = self.drive.exchange
        done: list[bool] = []

        def watched(torque: float) -> object:
            if self.drive.plant.x_mm > 1.0 and not done:
                done.append(True)
                act()  # type: ignore[operator]
            return exchange(torque)

        self.drive.exchange = watched  # type: ignore[method-assign, assignment]


def test_the_torque_is_that_of_the_table_at_the_displacement_one_cycle_before() -> None:
    device, drive, _clock = direct_device()
    device.upload(plain_surface(40.0, 4.0), 4.0)
    press = device.press(100.0)
    log = device.log
    # 500 N/Nm, against the finger is the negative direction
    sent = -100 * 500.0 * np.array(drive.commanded[-len(log) :])
    assert np.allclose(sent[1:], log.commanded_cN[:-1], atol=0.02)
    x_mm, commanded_cN = np.array(log.displacement_mm), np.array(log.commanded_cN)
    turn = int(np.argmax(x_mm))
    down = np.arange(x_mm.size) < turn
    deep = (x_mm > 0.2) & (x_mm < 3.9)
    assert np.allclose(commanded_cN[deep & down], 40 + 5 * x_mm[deep & down], atol=0.2)
    assert np.allclose(commanded_cN[deep & ~down], 35 + 5 * x_mm[deep & ~down], atol=0.2)
    assert press.commanded_cN is not None


def test_a_lost_answer_or_two_are_passed_over() -> None:
    pressing = Pressing()
    pressing.when_down(lambda: setattr(pressing.drive, "lose", 2))
    assert pressing.device.press(100.0).displacement_mm.max() > 3.9
    assert pressing.device.log.lost == 2


def test_more_lost_answers_in_a_row_end_the_press() -> None:
    pressing = Pressing()
    pressing.when_down(lambda: setattr(pressing.drive, "lose", 3))
    assert "no answer" in pressing.press()


def test_a_loop_that_was_held_up_falls_to_zero() -> None:
    pressing = Pressing()
    pressing.when_down(lambda: pressing.clock.sleep(0.03))
    assert "late: 3" in pressing.press()
    assert pressing.device.fault().fault is Fault.LATE


@pytest.mark.parametrize("in_answer", [False, True])
def test_a_hold_up_below_the_limit_does_not_and_is_not_taken_for_speed(in_answer: bool) -> None:
    # in 15 ms the cap moves some 2 mm: at this limit four times what it may in one cycle
    pressing = Pressing(direct_stage(velocity_mm_s=400.0))
    if in_answer:
        pressing.when_down(lambda: setattr(pressing.drive, "held_s", 0.015))
    else:
        pressing.when_down(lambda: pressing.clock.sleep(0.015))
    pressing.device.press(100.0)


def test_a_position_beyond_the_travel_falls_to_zero() -> None:
    pressing = Pressing()
    pressing.when_down(lambda: setattr(pressing.drive, "drift_mm", 0.2))  # slower than the limit of speed
    assert "position_high" in pressing.press()


@pytest.mark.parametrize(("moved_mm", "fault"), [(7.5, Fault.POSITION_HIGH), (-7.5, Fault.POSITION_LOW)])
def test_a_press_does_not_begin_beyond_the_travel(moved_mm: float, fault: Fault) -> None:
    pressing = Pressing()
    pressing.drive.moved_mm = moved_mm
    assert fault.name.lower() in pressing.press()
    assert set(pressing.drive.commanded) == {0.0}


def test_a_cap_that_is_too_fast_falls_to_zero() -> None:
    pressing = Pressing(direct_stage(velocity_mm_s=500.0))
    pressing.when_down(lambda: setattr(pressing.drive, "moved_mm", 0.7))  # within one cycle of 1 ms
    assert "position_jump" in pressing.press()


def test_an_exception_in_the_loop_stops_the_drive_and_goes_on() -> None:
    pressing = Pressing()

    def interrupt() -> None:
        raise KeyboardInterrupt

    pressing.when_down(interrupt)
    with pytest.raises(KeyboardInterrupt):
        pressing.device.press(100.0)
    assert pressing.drive.calls[-1] == "stop"
    assert pressing.drive.torque == 0.0


def test_nobody_who_presses_ends_in_zero_torque() -> None:
    pressing = Pressing()
    pressing.device.armed = None
    assert "nobody pressed within 3 s" in pressing.press()


def test_no_command_is_beyond_the_limit_of_force_whatever_the_core_says() -> None:
    stage = direct_stage(force_N=1.0)
    for force_N in (-1e9, -1.1, 1.1, 50.0):
        assert stage.torque(force_N) == pytest.approx(-np.sign(force_N) * 1.0 / 500.0)
    for force_N in (float("nan"), float("inf"), -float("inf")):
        assert stage.torque(force_N) == 0.0
    device, drive, _clock = direct_device(stage)
    device.upload(plain_surface(75.0, 4.0), 4.0)
    device.press(100.0)
    assert 0.9 / 500.0 < np.abs(drive.commanded).max() <= 1.0 / 500.0


def test_a_coil_that_gets_too_warm_falls_to_zero_where_the_file_knows_it() -> None:
    coil = Coil(rise_K=100.0, at_N=0.3, time_s=0.5, limit_K=20)
    hot = Pressing(direct_stage(coil), force_cN=250.0)
    hot.device.armed = None
    assert "over_heat" in hot.press()
    unknown = Pressing(direct_stage(), force_cN=250.0)
    unknown.device.armed = None
    assert "nobody pressed" in unknown.press()


def test_a_latched_fault_refuses_presses_until_it_is_cleared() -> None:
    pressing = Pressing()
    pressing.when_down(lambda: pressing.clock.sleep(0.03))
    pressing.press()
    assert "late" in pressing.press()
    pressing.device.clear_fault()
    # the finger is away when the cap comes up again
    pressing.drive.plant.release()
    assert pressing.device.press(100.0).displacement_mm.max() > 3.9


def test_a_watchdog_that_is_not_on_is_found_when_the_device_is_opened() -> None:
    clock, stage = VirtualClock(), direct_stage()
    drive = DirectDrive(clock, stage)
    drive.has_watchdog = False
    with pytest.raises(DeviceError, match="its watchdog does not end the torque after 50 ms"):
        DriveDevice(stage, drive, clock=clock)
    assert drive.calls[-2:] == ["stop", "close"]
    assert set(drive.commanded) == {0.0}


def test_a_press_without_a_sensor_says_so_and_nothing_is_learned_from_it() -> None:
    device, _drive, _clock = direct_device()
    assert device.force_is_estimated
    assert device.settings().force_gain_q14 == 0
    for truth_counts in (False, True):
        with pytest.raises(DeviceError, match="no force sensor"):
            check_force_sensor(device, truth_counts)


def test_a_force_sensor_is_what_a_press_holds() -> None:
    stage, clock = direct_stage(), VirtualClock()
    drive = DirectDrive(clock, stage)
    device = DriveDevice(stage, drive, force_cN=lambda: 12.5, armed=drive.plant.press, clock=clock)
    device.upload(plain_surface(), 4.0)
    assert np.all(device.press(100.0).force_cN == 12.5)
    check_force_sensor(device)


def test_a_force_sensor_beyond_its_bound_falls_to_zero() -> None:
    stage, clock = direct_stage(), VirtualClock()
    drive = DirectDrive(clock, stage)
    bound_cN = DriveDevice(stage, drive, force_cN=lambda: 0.0, clock=clock).settings().over_force_cN64 / 64
    device = DriveDevice(stage, drive, force_cN=lambda: bound_cN + 1, armed=drive.plant.press, clock=clock)
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match="over_force"):
        device.press(100.0)


def test_settings_that_would_loosen_the_stage_are_refused() -> None:
    device, _drive, _clock = direct_device()
    limit = device.settings().force_limit_cN64
    own = device.settings()
    looser = {
        "force_limit_cN64": limit + 64,
        "tick_us": 500,
        "force_gain_q14": 100,
        "reading_low": own.reading_low - 1,
        "reading_high": own.reading_high + 1,
        "late_ticks": own.late_ticks + 1,
    }
    for name, value in looser.items():
        with pytest.raises(DeviceError):
            device.configure(replace(own, **{name: value}))
        assert device.settings() == own
    device.configure(replace(own, late_ticks=own.late_ticks - 1, reading_high=own.reading_high - 100))


def test_a_closed_device_has_stopped_its_drive_and_presses_no_more() -> None:
    device, drive, _clock = direct_device()
    device.upload(plain_surface(), 4.0)
    with device:
        pass
    assert drive.calls[-2:] == ["stop", "close"]
    with pytest.raises(DeviceError, match="is closed"):
        device.press(100.0)


@pytest.mark.parametrize("direction", [1, -1])
def test_without_a_zero_the_cap_is_at_the_top_as_the_device_is_opened(direction: Literal[1, -1]) -> None:
    mechanics = Mechanics(travel_mm=6.0, lead_mm_rev=10.0, force_N_Nm=500.0, direction=direction)
    stage = Stage(mechanics, Limits(3.0))
    clock = VirtualClock()
    drive = DirectDrive(clock, stage)
    drive.moved_mm = 1234.5  # an encoder that was switched on somewhere
    device = DriveDevice(stage, drive, armed=drive.plant.press, clock=clock)
    device.upload(plain_surface(), 4.0)
    press = device.press(100.0)
    assert press.displacement_mm.max() == pytest.approx(drive.plant.travel_mm, abs=0.2)
    # against the finger, which is down in the drive's direction
    assert np.sign(np.median(drive.commanded)) == -direction


@pytest.mark.parametrize("rate_Hz", [1000.0, 250.0])
def test_the_row_of_the_table_is_that_of_the_speed_decided_in_the_press(rate_Hz: float) -> None:
    mechanics = Mechanics(travel_mm=6.0, lead_mm_rev=10.0, force_N_Nm=500.0, zero_rev=0.0)
    device, _drive, _clock = direct_device(Stage(mechanics, Limits(3.0), loop=Loop(rate_Hz=rate_Hz)))
    x_mm = np.linspace(0.0, 4.0, 41)
    rows = np.array([[40.0] * 41, [120.0] * 41])  # at 50 and 250 mm/s
    device.upload(ForceSurface(x_mm, np.array([50.0, 250.0]), rows, rows), 4.0)
    device.press(100.0)
    log = device.log
    position_mm, times_s = np.array(log.displacement_mm), log.times_s()
    down = slice(0, int(np.argmax(position_mm)))
    crossed_s = np.interp([0.5, 1.0], position_mm[down][-400:], times_s[down][-400:])
    # the mean speed of a stroke is 1.2 of that between 0.5 and 1 mm (velocity_scale_q12)
    velocity_mm_s = 1.2 * 0.5 / np.diff(crossed_s)[0]
    decided = (position_mm[down] > 1.5) & (position_mm[down] < 3.9)
    expected_cN = 40.0 + 0.4 * (velocity_mm_s - 50.0)
    assert np.median(np.array(log.commanded_cN)[down][decided]) == pytest.approx(expected_cN, abs=8.0)
    assert 50.0 < expected_cN < 110.0
