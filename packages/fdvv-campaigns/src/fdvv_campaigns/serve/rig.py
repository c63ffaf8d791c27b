"""The device of a server: one client owns it, and it falls to zero force when that client goes."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection
from dataclasses import asdict
from threading import Event, RLock

import numpy as np
from msgspec import Struct

from fdvv.device.remote import TOP_mm
from fdvv.errors import InputError
from fdvv.program.library import MAKERS, load_shipped
from fdvv.program.program import Program
from fdvv.rendering.actuation_file import load_actuation
from fdvv_campaigns.serve import answers as a
from fdvv_campaigns.serve import messages as m
from fdvv_campaigns.serve.runs import model_of
from fdvv_studio.live.tick_bins import TickBinner, TickPiece
from fdvv_studio.project.programs import read_program
from fdvv_studio.studio.api.device import scope_frame
from fdvv_studio.studio.contract import message_of
from fdvv_studio.studio.device_session import DeviceConnect, DeviceSession, DeviceStatus, DeviceUpload
from fdvv_studio.studio.device_thread import KeyChange
from fdvv_studio.studio.devices import device_names, require_listed
from fdvv_studio.studio.jobs.file import result_file
from fdvv_studio.studio.studio import Studio

UP_mm = 0.1
"""A cap that was deeper than TOP_mm is back up above this."""
LEAVES_s = 5.0
"""A device whose owner is going is waited for so long: a page that is loaded again asks at once."""
UP, DOWN, BETWEEN = 0, 1, 2  # names of three states: compared for equality only
Send = Callable[[Struct], None]


class RigOwnership:
    """Who owns the device of a server: one client at most.

    also : devices that may be opened beside those that are found; a client cannot name a file.
    """

    def __init__(self, studio: Studio, also: Collection[str] = ()) -> None:
        self.studio, self.also = studio, tuple(also)
        self.session = studio.part(DeviceSession)
        self.owner: RigClient | None = None
        self.lock = RLock()

    def devices(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys((*self.also, *device_names())))


class RigClient:
    """One client's hold of the device. send : takes events, from any thread. gone : it has left."""

    def __init__(self, rig: RigOwnership, send: Send) -> None:
        self._rig, self._send = rig, send
        self._end: Callable[[], None] = lambda: None
        self._turn, self.gone, self._released = RLock(), False, Event()
        self._begin(DeviceStatus())

    def _begin(self, status: DeviceStatus) -> None:
        self._binner: TickBinner | None = None
        self._touch, self._level = Touch(), 0
        self._last, self._simulated = status, status.simulated

    def answer(self, ask: m.Request) -> object:
        """Do what a request of DEVICE_REQUESTS asks. FdvvError, OSError."""
        if isinstance(ask, m.Stop):
            return self._answer_owner(ask)
        with self._turn:
            return self._open(ask) if isinstance(ask, m.OpenDevice) else self._answer_owner(ask)

    def close(self) -> None:
        """Fall to zero force and let the device go, for good; nothing happens without one."""
        self.gone = True
        self._release()
        self._released.set()

    def _release(self) -> None:
        if self._rig.owner is not self:
            return
        # at once, whatever this client still waits for; then in its turn, so that nothing comes after
        self._end()
        with self._turn, self._rig.lock:
            try:
                self._rig.session.disconnect()
            finally:
                self._rig.owner = None

    def _answer_owner(self, ask: m.Request) -> object:
        if self._rig.owner is not self:
            reason = "another client owns the device" if self._rig.owner else "you have opened no device"
            raise InputError(_call(ask), "device", reason, "open it, once it is free")
        return self._answer(ask)

    def _open(self, ask: m.OpenDevice) -> a.DeviceIs:
        require_listed("device.open", ask.device, self._rig.devices())
        if (owner := self._rig.owner) and owner.gone:
            owner._released.wait(LEAVES_s)
        with self._rig.lock:
            if self._rig.owner or self.gone:
                reason = (
                    "you own one already" if self._rig.owner is self else "another client owns the device"
                )
                raise InputError("device.open", "device", reason, "wait until it is closed")
            devices = self._rig.devices()
            status = self._rig.session.connect(DeviceConnect(ask.device, ask.rig, ask.seed), devices)
            self._begin(status)
            self._rig.owner = self
            self._end = self._rig.session.subscribe(self._ticks, self._tell, self._key)
        return device_is(status)

    def _answer(self, ask: m.Request) -> object:
        session = self._rig.session
        match ask:
            case m.DeviceFacts():
                info = session.thread().device.info()
                limits = {key: asdict(info)[key] for key in ("force_limit_cN", "travel_limit_mm")}
                return message_of(a.DeviceInformation, session.refresh(), **limits)
            case m.Upload():
                return device_is(self._upload(ask))
            case m.Arm():
                return device_is(session.do(lambda remote: remote.client.arm()))
            case m.Stop():
                return self._stop()
            case m.ClearFault():
                return device_is(session.do(lambda remote: remote.clear_fault()))
            case m.Press():
                return device_is(session.press(ask.velocity_mm_s))
            case m.Watch():
                self._binner = TickBinner(1.0 / ask.rate_Hz) if ask.rate_Hz else None
                return device_is(session.refresh())
            case _:
                self._release()
                return device_is(DeviceStatus())

    def _stop(self) -> a.DeviceIs:
        session = self._rig.session
        if session.thread().remote is None:
            return device_is(session.refresh())  # it makes whole presses: between them there is no force
        return device_is(session.do(lambda remote: remote.stop()))

    def _upload(self, ask: m.Upload) -> DeviceStatus:
        session, studio = self._rig.session, self._rig.studio
        if (ask.button is None) == (ask.program is None):
            reason, remedy = "either a button or a program is uploaded", "give one of the two"
            raise InputError("device.upload", "button", reason, remedy)
        if ask.program is not None:
            return session.upload_program(_program(studio, ask.program))
        assert ask.button is not None
        model = model_of(studio, ask.button)
        table = result_file(studio.project, "actuation", ask.actuation) if ask.actuation else None
        order = DeviceUpload(model.name, ask.actuation)
        return session.upload(order, model, load_actuation(table) if table else None)

    # -- in the device's thread ----------------------------------------------------------------------------

    def _key(self, change: KeyChange) -> None:
        before, self._level = self._level, change.level
        kind: a.PressKind = "reset" if not change.level else "level" if before else "actuation"
        self._send(a.PressEvent(kind, change.t_s, change.host_s, change.level, self._simulated))

    def _ticks(self, piece: TickPiece) -> None:
        for kind, t_s, x_mm in self._touch.changes(piece):
            host_s = self._rig.session.thread().host_s(t_s)
            self._send(a.PressEvent(kind, t_s, host_s, self._level, self._simulated, x_mm))
        binner = self._binner
        if binner and (bins := binner.add(piece)).number.size:
            frame = scope_frame(bins, binner.bin_s)
            self._send(message_of(a.TelemetryEvent, frame))

    def _tell(self, status: Struct) -> None:
        if not isinstance(status, DeviceStatus):
            return
        before, self._last = self._last, status
        if status.fault and status.fault != before.fault:
            self._send(a.FaultEvent(status.fault, not status.device))
        if device_is(status) != device_is(before):
            self._send(message_of(a.StatusEvent, status))


class Touch:
    """When a cap leaves its rest and is back, from ticks in rising time."""

    def __init__(self) -> None:
        self._down: bool | None = None

    def changes(self, piece: TickPiece) -> list[tuple[a.PressKind, float, float]]:
        """Return each kind, time (s) and displacement (mm); nothing while nothing is rendered.

        A cap that is deep at first has sunk: it counts once it was up.
        """
        x, changes = piece.displacement_mm, list[tuple[a.PressKind, float, float]]()
        deep = np.where(x > TOP_mm, DOWN, np.where(x < UP_mm, UP, BETWEEN))
        for row in np.flatnonzero((deep != BETWEEN) | ~piece.rendered).tolist():
            down = bool(deep[row] == DOWN)
            if not piece.rendered[row]:
                self._down = None
            elif self._down is None:
                self._down = None if down else False
            elif down != self._down:
                changes.append(("down" if down else "up", float(piece.t_s[row]), float(x[row])))
                self._down = down
        return changes


def device_is(status: DeviceStatus) -> a.DeviceIs:
    return message_of(a.DeviceIs, status)


def _program(studio: Studio, program: m.Button) -> Program:
    if isinstance(program, dict):
        return read_program(json.dumps(program), "program")
    return load_shipped(program) if program in MAKERS else studio.programs.program(program)


def _call(ask: m.Request) -> str:
    return str(type(ask).__struct_config__.tag)
