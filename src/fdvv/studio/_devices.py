"""The device that a person has connected on the page, and who looks on."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable

from fdvv.device import Remote, open_device
from fdvv.errors import DeviceError, FdvvError, InputError
from fdvv.model import FDVVModel
from fdvv.studio._device_told import press_seen, put_button, with_faults
from fdvv.studio._held_device import HeldDevice, mode_of
from fdvv.studio._job_order import RIGS, check_speeds
from fdvv.studio._jobs import SharedLeases
from fdvv.studio._messages_device import DeviceConnect, DeviceStanding, DeviceUpload, PressSeen
from fdvv.studio._studio import Studio
from fdvv.twin import load_rig
from fdvv.workflow import (
    CompensationResult,
    TickPiece,
)

HOLDER = "the device view"
NONE = "no device is connected"


class Look:
    """One page that looks on. ticks, standing and press are called from the device's thread."""

    def __init__(
        self,
        ticks: Callable[[TickPiece], None],
        standing: Callable[[DeviceStanding], None],
        press: Callable[[PressSeen], None],
    ) -> None:
        self.ticks, self.standing, self.press = ticks, standing, press


class Devices:
    """Holds one device open for the page. Any thread may ask; zero force once nobody looks on any more."""

    def __init__(self, studio: Studio) -> None:
        self._leases = studio.part(SharedLeases)
        # never held while the device's thread is waited for, which takes it too
        self._lock = threading.RLock()
        self._held: HeldDevice | None = None
        self._standing = DeviceStanding()
        self._model: FDVVModel | None = None
        self._looks: list[Look] = []

    def connect(self, ask: DeviceConnect, devices: tuple[str, ...]) -> DeviceStanding:
        """Open a device of the list. InputError, DeviceError."""
        if ask.device not in devices:
            raise InputError("device", "device", f"there is no {ask.device[:80]!r}", "choose one of the list")
        if ask.rig not in RIGS:
            raise InputError("rig", "rig", f"there is no {ask.rig[:80]!r}", f"use one of {', '.join(RIGS)}")
        with self._lock:
            if self._held:
                reason = f"{self._standing.device} is connected"
                raise InputError("device", "device", reason, "disconnect it first")
            self._leases.take(ask.device, HOLDER)
            try:
                rig = load_rig(ask.rig) if ask.rig != "default" else None
                self._held = HeldDevice(open_device(ask.device, rig, None, ask.seed), self._ticks, self._lost)
            except BaseException:
                self._leases.give_back(ask.device)
                raise
            self._standing = DeviceStanding(ask.device)
        return self.refresh("")

    def disconnect(self) -> DeviceStanding:
        """Let the device fall to zero force and go; nothing is done if there is none."""
        with self._lock:
            held, self._held, self._model = self._held, None, None
            device, self._standing = self._standing.device, DeviceStanding()
        if held:
            held.close()
            self._leases.give_back(device)
        return self._changed()

    def held(self) -> HeldDevice:
        """Give the device that is connected. DeviceError if there is none."""
        with self._lock:
            if not self._held:
                raise DeviceError(f"{NONE}; connect one first")
            return self._held

    def upload(
        self, ask: DeviceUpload, model: FDVVModel, learned: CompensationResult | None
    ) -> DeviceStanding:
        """Make a button the device's program, with what was learned for it or its own force. FdvvError."""
        held = self.held()
        check_speeds(ask.velocities_mm_s, 5.0)
        held.do(lambda: put_button(held, model, learned, sorted(ask.velocities_mm_s)))
        self._model = model
        return self.refresh(f"{model.name}{f', {ask.actuation}' if ask.actuation else ''}")

    def press(self, velocity_mm_s: float) -> DeviceStanding:
        """Have the simulated person press; whoever looks on sees it. DeviceError."""
        held = self.held()
        check_speeds((velocity_mm_s,), 5.0)
        if not held.device.info().simulated:
            raise DeviceError("a person presses this device; arm it and press")
        try:
            press = held.do(lambda: held.press(velocity_mm_s))
        finally:
            self.refresh()
        if self._model:
            seen = press_seen(press, self._model, velocity_mm_s)
            for look in self._all():
                look.press(seen)
        return self._standing

    def do(self, work: Callable[[Remote], None]) -> DeviceStanding:
        """Have something done with a device that has the firmware in it. DeviceError."""
        held = self.held()
        if not held.remote:
            raise DeviceError("there is no firmware in this device: it makes whole presses only")
        remote = held.remote
        held.do(lambda: work(remote))
        return self.refresh()

    def refresh(self, programmed: str | None = None) -> DeviceStanding:
        """Read how the device is, and tell whoever looks on."""
        with self._lock:
            held, known = self._held, self._standing
        if held:
            found = self._read(held, known.device, known.programmed if programmed is None else programmed)
            with self._lock:
                if self._held is held:
                    self._standing = found
        return self._changed()

    def look(self, look: Look) -> Callable[[], None]:
        """Tell ticks and standings until what is given back is called."""
        with self._lock:
            self._looks.append(look)
        look.standing(self._standing)

        def end() -> None:
            with self._lock:
                if look in self._looks:
                    self._looks.remove(look)
                alone = not self._looks
            if alone:
                self._let_go()

        return end

    def close(self) -> None:
        """Let the device go."""
        self.disconnect()

    def _let_go(self) -> None:
        """Fall to zero force: nobody looks on."""
        # there may be none, or one that holds no force between presses
        with contextlib.suppress(FdvvError):
            self.do(lambda remote: remote.stop())

    def _read(self, held: HeldDevice, device: str, programmed: str) -> DeviceStanding:
        info, remote = held.device.info(), held.remote
        common = DeviceStanding(
            device,
            info.name,
            info.simulated,
            remote is not None,
            not info.simulated,
            bool(held.device.settings().force_gain_q14) or remote is None,
            info.tick_s,
            programmed=programmed,
            travel_mm=self._model.travel_mm if self._model else None,
        )
        return held.do(lambda: with_faults(common, remote)) if remote else common

    def _ticks(self, piece: TickPiece) -> None:
        for look in self._all():
            look.ticks(piece)
        with self._lock:
            held, mode = self._held, self._standing.mode
        # a mode that changes by itself is told at once: a fault, heat
        if held and held.remote and mode and mode_of(held.remote) != mode:
            self.refresh()

    def _lost(self, error: DeviceError) -> None:
        """Tell that the device is gone; its lease ends."""
        with self._lock:
            device, self._held = self._standing.device, None
            self._standing = DeviceStanding(fault=str(error))
        self._leases.give_back(device)
        self._changed()

    def _changed(self) -> DeviceStanding:
        for look in self._all():
            look.standing(self._standing)
        return self._standing

    def _all(self) -> tuple[Look, ...]:
        with self._lock:
            return tuple(self._looks)
