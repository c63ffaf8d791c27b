"""The device that is connected on the page, and its subscribers."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import msgspec

from fdvv.compensation.method import UNTUNED
from fdvv.device.contract import FREE_CELL_cN
from fdvv.device.open import open_device
from fdvv.device.remote import Remote
from fdvv.errors import DeviceError, FdvvError, InputError
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.program import Program
from fdvv.program.surface import Limits
from fdvv.protocol.tables import Fault
from fdvv.rendering.compensate import CompensationResult
from fdvv.rendering.settings import PressSettings
from fdvv.rendering.tuning import tune
from fdvv.twin.files import FIRST_RIG, current_rig_name, load_rig
from fdvv_studio.live.tick_bins import TickPiece
from fdvv_studio.studio.contract import Message, Tell
from fdvv_studio.studio.device_findings import CellCheck, cell_check, press_seen
from fdvv_studio.studio.device_thread import DeviceThread, KeyChange, mode_of
from fdvv_studio.studio.devices import DeviceLocks, require_listed
from fdvv_studio.studio.jobs.check import RIGS
from fdvv_studio.studio.studio import Studio

STEP_mm = 0.05  # as `fdvv.rendering.tuning` has it: a board's table of 255 columns reaches 12.7 mm
HOLDER = "the device view"
NONE = "no device is connected"


class DeviceConnect(Message):
    """Connect a device of the list. rig, seed : of a simulated one."""

    device: str
    rig: str = FIRST_RIG
    seed: int = 0


class DeviceUpload(Message):
    """Make a button the device's program.

    actuation : name of a table that was learned for it; empty: its own force.
    """

    button: str
    actuation: str = ""
    velocities_mm_s: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)


class DeviceStatus(Message, tag="standing"):
    """What is connected, and how it is.

    device : as listed; empty if none is connected. name : as it calls itself.
    streams : it tells of every tick; else only presses are shown.
    programmed : name of the button that is its program; empty if it has none. travel_mm : of that.
    fault : why it fell to zero force; empty if it has not.
    loop : "open" or "closed", or why the force loop opened by itself; empty without a load cell.
    missing_ticks, late_ticks, missing_frames, lost_records : since something was last done with it.
    """

    device: str = ""
    name: str = ""
    simulated: bool = False
    streams: bool = False
    person: bool = False
    force_sensor: bool = False
    tick_s: float = 0.0
    mode: str = ""
    programmed: str = ""
    travel_mm: float | None = None
    fault: str = ""
    loop: str = ""
    missing_ticks: int = 0
    late_ticks: int = 0
    missing_frames: int = 0
    lost_records: int = 0


def with_faults(known: DeviceStatus, remote: Remote) -> DeviceStatus:
    """Add the mode, the latched fault and what is missing."""
    telemetry, report = remote.client.telemetry, remote.fault()
    return msgspec.structs.replace(
        known,
        mode="fault" if report.fault is not Fault.NONE else mode_of(remote),
        fault="" if report.fault is Fault.NONE else str(report),
        loop=remote.force_loop.state() if remote.load_cell else "",
        missing_ticks=telemetry.missing_ticks,
        late_ticks=telemetry.late_ticks,
        missing_frames=telemetry.missing_frames,
        lost_records=telemetry.lost_records,
    )


def put_button(
    held: DeviceThread, model: FDVVModel, learned: CompensationResult | None, speeds_mm_s: list[float]
) -> None:
    """Put a button on a device: what was learned under its tuning, or the button's own program.

    Tuning, loop included, belongs to what is learned: the button's own program is rendered without any.
    """
    device = held.device
    tune(device, learned.outcome.tuning if learned else UNTUNED)
    if learned:
        device.upload(learned.surface, learned.travel_mm, learned.outcome.tuning.paced)
        return
    if not model.of("press"):
        raise InputError(model.name, "curves", "it has no press, there is nothing to render", "give it one")
    program = button_program(model, ForceSurface.of_model(model, speeds_mm_s, STEP_mm))
    device.upload_program(compile_program(program).image)  # type: ignore[attr-defined]  # all that are listed do


@dataclass(frozen=True)
class UploadedButton:
    """What a device was made to render, to do it again."""

    model: FDVVModel
    learned: CompensationResult | None
    speeds_mm_s: list[float]

    @property
    def has_loop(self) -> bool:
        return self.learned is not None and self.learned.outcome.tuning.loop is not None

    def put(self, held: DeviceThread) -> None:
        put_button(held, self.model, self.learned, self.speeds_mm_s)


class Subscriber(NamedTuple):
    """One page that follows the device: what takes its ticks, status and presses, and its key."""

    ticks: Callable[[TickPiece], None]
    tell: Tell
    keys: Callable[[KeyChange], None]


class DeviceSession:
    """Holds one device open for the page. Any thread may ask; zero force once no page is subscribed."""

    def __init__(self, studio: Studio) -> None:
        self._studio, self._locks = studio, studio.part(DeviceLocks)
        # never held while the device's thread is waited for, which takes it too
        self._lock = threading.RLock()
        self._held: DeviceThread | None = None
        self._status = DeviceStatus()
        self._button: UploadedButton | None = None
        self._subscribers: list[Subscriber] = []

    def connect(self, ask: DeviceConnect, devices: tuple[str, ...]) -> DeviceStatus:
        """Open a device of the list. InputError, DeviceError."""
        require_listed("device", ask.device, devices, "choose one of the list")
        rig = str(current_rig_name(ask.rig))
        require_listed("rig", rig, RIGS)
        with self._lock:
            if self._held:
                reason = f"{self._status.device} is connected"
                raise InputError("device", "device", reason, "disconnect it first")
            with self._locks.hold(ask.device, HOLDER):
                device = open_device(ask.device, load_rig(rig), None, ask.seed)
                self._held = DeviceThread(device, self._ticks, self._drop, self._keys)
            self._status = DeviceStatus(ask.device)
        return self.refresh("")

    def disconnect(self) -> DeviceStatus:
        """Set zero force and close the device, if there is one."""
        with self._lock:
            held, self._held, self._button = self._held, None, None
            device, self._status = self._status.device, DeviceStatus()
        if held:
            held.close()
            self._locks.release(device)
        return self._broadcast()

    def thread(self) -> DeviceThread:
        """Return the device that is connected. DeviceError if there is none."""
        with self._lock:
            if not self._held:
                raise DeviceError(f"{NONE}; connect one first")
            return self._held

    def upload(self, ask: DeviceUpload, model: FDVVModel, learned: CompensationResult | None) -> DeviceStatus:
        """Make a button the device's program, with what was learned for it or its own force. FdvvError."""
        held = self.thread()
        PressSettings(velocities_mm_s=tuple(ask.velocities_mm_s))
        button = UploadedButton(model, learned, sorted(ask.velocities_mm_s))
        held.do(lambda: button.put(held))
        self._button = button
        return self.refresh(f"{model.name}{f', {ask.actuation}' if ask.actuation else ''}")

    def upload_program(self, program: Program) -> DeviceStatus:
        """Make a program of several states the device's. FdvvError."""
        held = self.thread()
        image = compile_program(program, Limits(held.device.settings())).image
        held.do(lambda: held.device.upload_program(image))  # type: ignore[attr-defined]  # as in put_button
        self._button = None
        return self.refresh(program.name)

    def press(self, velocity_mm_s: float) -> DeviceStatus:
        """Make one simulated press and send it to all subscribers. DeviceError, InputError."""
        held = self.thread()
        PressSettings(velocities_mm_s=(velocity_mm_s,))
        jnds = self._studio.jnds  # a broken file is said before anything moves
        if not held.device.info().simulated:
            raise DeviceError("a person presses this device; arm it and press")
        try:
            press = held.do(lambda: held.press(velocity_mm_s))
        finally:
            self.refresh()
        if self._button:
            self._tell(press_seen(press, self._button.model, velocity_mm_s, jnds))
        return self._status

    def check_cell(self) -> CellCheck:
        """Read the load cell of the free cap, at zero force; a sound one closes the loop that its button had.

        DeviceError without a cell.
        """
        held, button = self.thread(), self._button
        if not held.remote:
            raise DeviceError("there is no firmware in this device: its loop is closed anew for each press")
        remote = held.remote
        try:
            reads_cN = held.do(remote.free_cell_cN)
            closes = abs(reads_cN) <= FREE_CELL_cN and button is not None and button.has_loop
            if button and closes:
                remote.force_loop.forget()  # it may have opened by itself, which the host does not see
                held.do(lambda: button.put(held))
        finally:
            self.refresh()
        return cell_check(reads_cN, closes)

    def do(self, work: Callable[[Remote], None]) -> DeviceStatus:
        """Do something with a device that runs the firmware. DeviceError."""
        held = self.thread()
        if not held.remote:
            raise DeviceError("there is no firmware in this device: it makes whole presses only")
        remote = held.remote
        held.do(lambda: work(remote))
        return self.refresh()

    def refresh(self, programmed: str | None = None) -> DeviceStatus:
        """Read the state of the device and send it to all subscribers."""
        with self._lock:
            held, known = self._held, self._status
        if held:
            status = self._read(held, known.device, known.programmed if programmed is None else programmed)
            with self._lock:
                if self._held is held:
                    self._status = status
        return self._broadcast()

    def subscribe(
        self,
        ticks: Callable[[TickPiece], None],
        tell: Tell,
        keys: Callable[[KeyChange], None] = lambda _change: None,
    ) -> Callable[[], None]:
        """Send telemetry to a page until the returned function is called; all are called by any thread."""
        subscriber = Subscriber(ticks, tell, keys)
        with self._lock:
            self._subscribers.append(subscriber)
        tell(self._status)

        def end() -> None:
            with self._lock:
                if subscriber in self._subscribers:
                    self._subscribers.remove(subscriber)
                alone = not self._subscribers
            if alone:
                # there may be no device, or one that holds no force between presses
                with contextlib.suppress(FdvvError):
                    self.do(lambda remote: remote.stop())

        return end

    def close(self) -> None:
        self.disconnect()

    def _read(self, held: DeviceThread, device: str, programmed: str) -> DeviceStatus:
        info, remote = held.device.info(), held.remote
        common = DeviceStatus(
            device,
            info.name,
            info.simulated,
            remote is not None,
            not info.simulated,
            bool(held.device.settings().force_gain_q14) or remote is None,
            info.tick_s,
            programmed=programmed,
            travel_mm=self._button.model.travel_mm if self._button else None,
        )
        return held.do(lambda: with_faults(common, remote)) if remote else common

    def _ticks(self, piece: TickPiece) -> None:
        for subscriber in self._current_subscribers():
            subscriber.ticks(piece)
        with self._lock:
            held, mode = self._held, self._status.mode
        # a mode that changes by itself is sent at once: a fault, heat
        if held and held.remote and mode and mode_of(held.remote) != mode:
            self.refresh()

    def _keys(self, change: KeyChange) -> None:
        for subscriber in self._current_subscribers():
            subscriber.keys(change)

    def _drop(self, error: DeviceError) -> None:
        with self._lock:
            device, self._held = self._status.device, None
            self._status = DeviceStatus(fault=str(error))
        self._locks.release(device)
        self._broadcast()

    def _broadcast(self) -> DeviceStatus:
        self._tell(self._status)
        return self._status

    def _tell(self, message: Message) -> None:
        for subscriber in self._current_subscribers():
            subscriber.tell(message)

    def _current_subscribers(self) -> tuple[Subscriber, ...]:
        with self._lock:
            return tuple(self._subscribers)
