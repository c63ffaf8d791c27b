"""The device page: connect, upload, press, stop, and the telemetry of the device."""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable

import msgspec

from fdvv.device.remote import Remote
from fdvv.errors import InputError
from fdvv.live.tick_bins import TickBinner, TickBins, TickPiece
from fdvv.protocol.tables import Part, SelfTestResult
from fdvv.rendering.actuation_file import load_actuation
from fdvv.studio.contract import Call, ChannelKind, Empty, Tell
from fdvv.studio.device_session import (
    DeviceConnect,
    DeviceSession,
    DeviceStatus,
    DeviceUpload,
    PressSeen,
    TelemetrySubscriber,
)
from fdvv.studio.devices import device_names
from fdvv.studio.jobs.file import result_file
from fdvv.studio.rounding import finite_row, rounded
from fdvv.studio.studio import Studio


class DevicePress(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Have the simulated person press once."""

    velocity_mm_s: float


class DeviceFact(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Something to know of a device."""

    name: str
    value: str


class DeviceFacts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All that is to know of a device."""

    facts: tuple[DeviceFact, ...]


class PartVerdict(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How a part of a device did in its test of itself."""

    part: str
    verdict: str
    value: int


class SelfTest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The test of all parts; note says why there is none."""

    parts: tuple[PartVerdict, ...]
    note: str


class WatchScope(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="watch_scope"):
    """Send the minima and maxima of ticks in bins of bin_s, and the device's status."""

    bin_s: float


class ScopeFrame(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="scope"):
    """Bins of ticks, every column (m,); a bin begins at bin * bin_s on the device's clock.

    bin : numbers of the bins; those without a tick are not among them.
    force_low_cN, force_high_cN : None where there is no sensor.
    state : of the program. cut : the command was cut to a limit. ticks : how many there are in the bin.
    """

    bin_s: float
    bin: tuple[int, ...]
    displacement_low_mm: tuple[float, ...]
    displacement_high_mm: tuple[float, ...]
    force_low_cN: tuple[float | None, ...]
    force_high_cN: tuple[float | None, ...]
    commanded_low_cN: tuple[float, ...]
    commanded_high_cN: tuple[float, ...]
    state: tuple[int, ...]
    cut: tuple[bool, ...]
    ticks: tuple[int, ...]


LEAST_bin_s, MOST_bin_s = 0.0005, 1.0


class ScopeChannel:
    """One page that looks on."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._devices, self._tell = studio.part(DeviceSession), tell
        self._end: Callable[[], None] | None = None
        self._binner = TickBinner(MOST_bin_s)

    def receive(self, ask: WatchScope) -> None:
        """Begin to look on, or with bins of another width. InputError."""
        if not LEAST_bin_s <= ask.bin_s <= MOST_bin_s:
            reason = f"cannot be {ask.bin_s:g}"
            raise InputError("bin_s", "bin_s", reason, f"use {LEAST_bin_s:g} to {MOST_bin_s:g} s")
        self._binner = TickBinner(ask.bin_s)
        if self._end is None:
            self._end = self._devices.subscribe(TelemetrySubscriber(self._ticks, self._tell, self._tell))

    def close(self) -> None:
        if self._end:
            self._end()

    def _ticks(self, piece: TickPiece) -> None:
        binner = self._binner
        found = binner.add(piece)
        if found.number.size:
            self._tell(scope_frame(found, binner.bin_s))


def scope_frame(found: TickBins, bin_s: float) -> ScopeFrame:
    """Return the message of some bins."""
    low, high = found.low, found.high
    return ScopeFrame(
        bin_s,
        tuple(found.number.tolist()),
        rounded(low[0]),
        rounded(high[0]),
        finite_row(low[1]),
        finite_row(high[1]),
        rounded(low[2]),
        rounded(high[2]),
        tuple(found.state.tolist()),
        tuple(found.cut.tolist()),
        tuple(found.ticks.tolist()),
    )


def connect(studio: Studio, ask: DeviceConnect) -> DeviceStatus:
    return studio.part(DeviceSession).connect(ask, device_names())


def disconnect(studio: Studio, _ask: Empty) -> DeviceStatus:
    return studio.part(DeviceSession).disconnect()


def upload(studio: Studio, ask: DeviceUpload) -> DeviceStatus:
    model = studio.catalog.model(ask.button)
    file = result_file(studio.project, "actuation", ask.actuation) if ask.actuation else None
    return studio.part(DeviceSession).upload(ask, model, load_actuation(file) if file else None)


def press(studio: Studio, ask: DevicePress) -> DeviceStatus:
    return studio.part(DeviceSession).press(ask.velocity_mm_s)


def arm(studio: Studio, _ask: Empty) -> DeviceStatus:
    return studio.part(DeviceSession).do(lambda remote: remote.client.arm())


def stop(studio: Studio, _ask: Empty) -> DeviceStatus:
    return studio.part(DeviceSession).do(lambda remote: remote.stop())


def clear_fault(studio: Studio, _ask: Empty) -> DeviceStatus:
    return studio.part(DeviceSession).do(lambda remote: remote.clear_fault())


def status(studio: Studio, _ask: Empty) -> DeviceStatus:
    return studio.part(DeviceSession).refresh()


def facts(studio: Studio, _ask: Empty) -> DeviceFacts:
    held = studio.part(DeviceSession).held()
    found = {name: str(value) for name, value in dataclasses.asdict(held.device.info()).items()}
    if held.remote:
        remote = held.remote
        found |= held.do(lambda: _firmware(remote))
    return DeviceFacts(tuple(DeviceFact(name.replace("_", " "), value) for name, value in found.items()))


def _firmware(remote: Remote) -> dict[str, str]:
    hello = remote.client.hello
    version = ".".join(str(hello.firmware >> shift & 255) for shift in (16, 8, 0))
    counters = dataclasses.asdict(remote.client.counters())
    known = {"firmware": version, "protocol": f"{hello.hash:08x}", "serial": str(hello.serial)}
    return known | {name: str(value) for name, value in counters.items()}


def selftest(studio: Studio, _ask: Empty) -> SelfTest:
    held = studio.part(DeviceSession).held()
    if not held.remote:
        return SelfTest((), "there is no firmware in this device, so there is nothing to test")
    reply = held.do(held.remote.client.selftest)
    values = struct.unpack("<8h", reply.values)
    parts = (
        PartVerdict(p.name.lower(), SelfTestResult(reply.verdicts[p]).name.lower(), values[p]) for p in Part
    )
    return SelfTest(tuple(parts), "")


CALLS = (
    Call("device.connect", DeviceConnect, DeviceStatus, connect),
    Call("device.disconnect", Empty, DeviceStatus, disconnect),
    Call("device.upload", DeviceUpload, DeviceStatus, upload),
    Call("device.press", DevicePress, DeviceStatus, press),
    Call("device.arm", Empty, DeviceStatus, arm),
    Call("device.stop", Empty, DeviceStatus, stop),
    Call("device.clear_fault", Empty, DeviceStatus, clear_fault),
    Call("device.standing", Empty, DeviceStatus, status),
    Call("device.facts", Empty, DeviceFacts, facts),
    Call("device.selftest", Empty, SelfTest, selftest),
)

CHANNELS = (ChannelKind("scope", (WatchScope,), (DeviceStatus, ScopeFrame, PressSeen), ScopeChannel),)
