"""A device whose loop runs here: the drive says where it is, the core looks up the force to make."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import Protocol, Self

from fdvv.device.contract import DeviceInfo, FaultReport, check_speed, check_table, check_travel
from fdvv.device.remote import surface_image
from fdvv.errors import DeviceError, ModelError
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import CN64_PER_cN, travel_mm_of
from fdvv.protocol.tables import Settings
from fdvv_drives.controller import Controller
from fdvv_drives.drive import Drive, LostAnswerError, Reading
from fdvv_drives.record import LoopLog, PressFinder
from fdvv_drives.stage import Stage

SILENCE_RATIO, SILENCE_MORE_s = 1.5, 0.05
"""How long, of the watchdog's time and beside it, it must stay silent before it is asked whether it fell."""
ARMED_s = 0.3
"""Time for the cap to come up before whoever presses hears that the device is ready."""


class Clock(Protocol):
    """Time as a loop needs it: this computer's, or a simulated one."""

    def now_s(self) -> float:
        """Return a clock that never goes back."""

    def sleep(self, duration_s: float) -> None:
        """Wait."""


class RealClock:
    def now_s(self) -> float:
        return time.perf_counter()

    def sleep(self, duration_s: float) -> None:
        time.sleep(duration_s)


class DriveDevice:
    """A stage and its drive, as a device (fdvv.device.contract.ProgramDevice); a person presses.

    Vibrations of a program are not played, and its stop is not set: there is neither exciter nor limiter.

    Parameters
    ----------
    stage : its mechanics and limits. drive : in torque mode once enabled.
    force_cN : reads a sensor at the cap, positive against the finger; None without one, or where the drive
        has it.
    armed : called in the loop with travel and speed as soon as the cap is up: for a simulated hand.

    Attributes
    ----------
    log : of the last press, with true times.
    force_is_estimated : a press holds the force of the torque that the drive reports, without friction and
        mass of the mover; nothing can be learned from it.
    """

    def __init__(
        self,
        stage: Stage,
        drive: Drive,
        force_cN: Callable[[], float] | None = None,
        armed: Callable[[float, float], None] | None = None,
        clock: Clock | None = None,
    ) -> None:
        self._clock = RealClock() if clock is None else clock
        self.stage, self.drive, self.armed = stage, drive, armed
        self._force_cN = force_cN
        has_sensor = force_cN is not None or drive.senses_force
        self.force_is_estimated = not has_sensor
        self.log = LoopLog()
        self._controller = Controller(stage, has_sensor)
        self._travel_mm: float | None = None
        self._idle_since_s = self._clock.now_s()
        self._closed = False
        try:
            self._zero = self._check_drive()
        except BaseException:
            self.close()
            raise

    def _check_drive(self) -> float:
        """Enable the drive at zero torque, let its watchdog end that, and return its position at the top."""
        drive, watchdog_s = self.drive, self.drive.watchdog_s
        try:
            drive.enable()
            position = self._first_reading().position
            if watchdog_s is not None:
                self._clock.sleep(SILENCE_RATIO * watchdog_s + SILENCE_MORE_s)
                if not drive.has_fallen():
                    raise DeviceError(
                        f"{drive.name}: its watchdog does not end the torque after "
                        f"{1000 * watchdog_s:g} ms of silence; switch it on, see docs/how-to/use-a-drive.md"
                    )
        finally:
            with suppress(DeviceError):
                drive.stop()
        return position if self.stage.zero is None else self.stage.zero

    def _first_reading(self) -> Reading:
        for _ in range(self.stage.limits.lost_answers):
            with suppress(LostAnswerError):
                return self.drive.exchange(0.0)
        return self.drive.exchange(0.0)

    def info(self) -> DeviceInfo:
        stage = self.stage
        return DeviceInfo(
            f"{stage.mechanics.name} on {self.drive.name}",
            stage.mechanics.simulated,
            self.settings().force_limit_cN64 / CN64_PER_cN,
            stage.mechanics.travel_mm,
            stage.period_s,
        )

    def settings(self) -> Settings:
        return self._controller.settings

    def configure(self, settings: Settings) -> None:
        self._controller.configure(settings)
        self._travel_mm = None

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        check_table(self.info(), surface, travel_mm)
        self.upload_program(surface_image(surface, travel_mm, paced))

    def upload_program(self, image: bytes) -> None:
        """Make a program the active one, whole or not at all; DeviceError as a board refuses it."""
        travel_mm = _travel_mm(image)
        check_travel(self.info(), travel_mm)
        self._controller.activate(image)
        self._travel_mm = travel_mm

    def press(self, velocity_mm_s: float) -> Press:
        """Render until someone has pressed; DeviceError, at zero torque, on a fault or if nobody does."""
        if self._closed:
            raise DeviceError(f"{self.drive.name}: is closed; open the device again")
        if self._travel_mm is None:
            raise DeviceError(f"{self.drive.name}: press before upload; upload a surface first")
        check_speed(self.drive.name, velocity_mm_s)
        self._controller.announce(velocity_mm_s)
        self.log = log = LoopLog()
        finder = PressFinder(self._travel_mm)
        try:
            self._begin()
            self._loop(log, finder, self._travel_mm, velocity_mm_s)
        except LostAnswerError as error:
            raise DeviceError(f"{error}; the drive's torque is off, or falls with its watchdog") from error
        finally:
            self._end()
        simulated = self.stage.mechanics.simulated
        return log.press(finder.first, len(log) - 1, self.stage.period_s, velocity_mm_s, simulated)

    def _begin(self) -> None:
        """Enable the drive, let the core know how long nothing was commanded, and arm it."""
        self._look()
        self._controller.arm()

    def _look(self) -> None:
        """Have the core see where the cap is, at zero torque."""
        self.drive.enable()
        reading = self._first_reading()
        x_mm = self.stage.displacement_mm(reading.position, self._zero)
        idle_ticks = round((self._clock.now_s() - self._idle_since_s) / (self.stage.tick_us * 1e-6))
        self._controller.step(x_mm, self._sensed_cN(reading), idle_ticks, round(1e6 * self._clock.now_s()))

    def _end(self) -> None:
        self._controller.disarm()
        self._idle_since_s = self._clock.now_s()
        with suppress(DeviceError):  # it is gone: then only its own watchdog can act
            self.drive.stop()

    def _loop(self, log: LoopLog, finder: PressFinder, travel_mm: float, velocity_mm_s: float) -> None:
        begin_s, lost, force_cN = self._clock.now_s(), 0, 0.0
        armed = self.armed
        while True:
            sent_s = self._clock.now_s()
            try:
                reading = self.drive.exchange(self.stage.torque(0.01 * force_cN))
            except LostAnswerError:
                log.lost, lost = log.lost + 1, lost + 1
                if lost > self.stage.limits.lost_answers:
                    raise
                continue
            received_s, lost = self._clock.now_s(), 0
            force_cN = self._step(log, reading, sent_s, received_s, begin_s)
            if finder.feed(log.displacement_mm[-1]):
                return
            if armed is not None and received_s - begin_s > ARMED_s:
                armed(travel_mm, velocity_mm_s)
                armed = None
            self._wait(begin_s)

    def _step(
        self, log: LoopLog, reading: Reading, sent_s: float, received_s: float, begin_s: float
    ) -> float:
        """Return the new command in cN for an answer, and log both; DeviceError if a guard acts."""
        stage, controller = self.stage, self._controller
        tick_s = stage.tick_us * 1e-6
        before_s = log.received_s[-1] if len(log) else begin_s
        # counted from the start, so that what is rounded off does not add up
        ticks = round((received_s - begin_s) / tick_s) - round((before_s - begin_s) / tick_s)
        x_mm, sensed_cN = stage.displacement_mm(reading.position, self._zero), self._sensed_cN(reading)
        step = controller.step(x_mm, sensed_cN, ticks, round(1e6 * received_s))
        if len(log):  # a position is at least as old as its answer, and no older than its question
            moved_mm = step.displacement_mm - log.displacement_mm[-1]
            controller.check_speed(moved_mm, received_s - log.sent_s[-1])
        if controller.has_failed:
            raise DeviceError(f"{self.drive.name}: fell to zero force, {controller.report()}")
        log.note(sent_s, received_s, step.displacement_mm, sensed_cN, step.commanded_cN, step.limited)
        return step.commanded_cN

    def _wait(self, begin_s: float) -> None:
        """Sleep until the next cycle; DeviceError once nobody has pressed for long."""
        now_s, period_s = self._clock.now_s() - begin_s, self.stage.period_s
        if now_s > self.stage.loop.patience_s:
            waited = f"nobody pressed within {self.stage.loop.patience_s:g} s"
            raise DeviceError(f"{self.drive.name}: {waited}; press the button fully")
        self._clock.sleep(period_s - now_s % period_s)

    def _sensed_cN(self, reading: Reading) -> float:
        """Return the force of the sensor, or that of the reported torque."""
        if self._force_cN is not None:
            return self._force_cN()
        return 100 * (self.stage.force_N(reading.torque) if reading.force_N is None else reading.force_N)

    def stop(self) -> None:
        """Fall to zero force at once; allowed at any time."""
        self._controller.disarm()
        if not self._closed:
            self.drive.stop()

    def fault(self) -> FaultReport:
        """Return the latched fault of the core; what the drive itself reports is not latched here."""
        return self._controller.report()

    def clear_fault(self) -> None:
        """Clear the latched fault; DeviceError while its cause lasts."""
        try:
            self._look()
        finally:
            self._end()
        self._controller.clear()

    def close(self) -> None:
        """Switch the torque off and let the drive go; a second time does nothing."""
        if self._closed:
            return
        self._closed = True
        with suppress(DeviceError):
            self.drive.stop()
        with suppress(DeviceError):
            self.drive.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _travel_mm(image: bytes) -> float:
    try:
        return travel_mm_of(image)
    except ModelError as error:
        raise DeviceError(str(error)) from error
