"""The device page: connect, upload, press, stop, and the telemetry of the device."""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable

from fdvv.device.remote import Remote
from fdvv.errors import InputError
from fdvv.protocol.tables import Part, SelfTestResult
from fdvv.rendering.actuation_file import load_actuation
from fdvv_studio.live.tick_bins import TickBinner, TickBins, TickPiece
from fdvv_studio.studio.contract import ChannelKind, Empty, Message, Tell, call
from fdvv_studio.studio.device_findings import CellCheck, PressSeen
from fdvv_studio.studio.device_session import DeviceConnect, DeviceSession, DeviceStatus, DeviceUpload
from fdvv_studio.studio.devices import device_names
from fdvv_studio.studio.jobs.file import result_file
from fdvv_studio.studio.rounding import finite_row, round_row
from fdvv_studio.studio.studio import Studio


class DevicePress(Message):
    """Have the simulated person press once."""

    velocity_mm_s: float


class DeviceFact(Message):
    """Something to know of a device."""

    name: str
    value: str


class DeviceFacts(Message):
    """All that is to know of a device."""

    facts: tuple[DeviceFact, ...]


class PartVerdict(Message):
    """How a part of a device did in its test of itself."""

    part: str
    verdict: str
    value: int


class SelfTest(Message):
    """The test of all parts; note says why there is none."""

    parts: tuple[PartVerdict, ...]
    note: str


class WatchScope(Message, tag="watch_scope"):
    """Send the minima and maxima of ticks in bins of bin_s, and the device's status."""

    bin_s: float


class ScopeFrame(Message, tag="scope"):
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


LEAST_bin_s, MOST_bin_s = 0.0005, 1.0  # 2 ticks at 4 kHz: less saves nothing; 10 min on 600 columns (assumed)


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
            self._end = self._devices.subscribe(self._ticks, self._tell)

    def close(self) -> None:
        if self._end:
            self._end()

    def _ticks(self, piece: TickPiece) -> None:
        binner = self._binner
        bins = binner.add(piece)
        if bins.number.size:
            self._tell(scope_frame(bins, binner.bin_s))


def scope_frame(bins: TickBins, bin_s: float) -> ScopeFrame:
    low, high = bins.low, bins.high
    return ScopeFrame(
        bin_s,
        tuple(bins.number.tolist()),
        round_row(low[0]),
        round_row(high[0]),
        finite_row(low[1]),
        finite_row(high[1]),
        round_row(low[2]),
        round_row(high[2]),
        tuple(bins.state.tolist()),
        tuple(bins.cut.tolist()),
        tuple(bins.ticks.tolist()),
    )


@call("device.connect")
def connect(session: DeviceSession, ask: DeviceConnect) -> DeviceStatus:
    return session.connect(ask, device_names())


@call("device.disconnect")
def disconnect(session: DeviceSession, _ask: Empty) -> DeviceStatus:
    return session.disconnect()


@call("device.upload")
def upload(studio: Studio, ask: DeviceUpload) -> DeviceStatus:
    model = studio.catalog.model(ask.button)
    file = result_file(studio.project, "actuation", ask.actuation) if ask.actuation else None
    return studio.part(DeviceSession).upload(ask, model, load_actuation(file) if file else None)


@call("device.press")
def press(session: DeviceSession, ask: DevicePress) -> DeviceStatus:
    return session.press(ask.velocity_mm_s)


@call("device.arm")
def arm(session: DeviceSession, _ask: Empty) -> DeviceStatus:
    return session.do(lambda remote: remote.client.arm())


@call("device.stop")
def stop(session: DeviceSession, _ask: Empty) -> DeviceStatus:
    return session.do(lambda remote: remote.stop())


@call("device.clear_fault")
def clear_fault(session: DeviceSession, _ask: Empty) -> DeviceStatus:
    return session.do(lambda remote: remote.clear_fault())


@call("device.check_cell")
def check_cell(session: DeviceSession, _ask: Empty) -> CellCheck:
    return session.check_cell()


@call("device.standing")
def status(session: DeviceSession, _ask: Empty) -> DeviceStatus:
    return session.refresh()


@call("device.facts")
def facts(session: DeviceSession, _ask: Empty) -> DeviceFacts:
    held = session.thread()
    texts = {name: _text_of(value) for name, value in dataclasses.asdict(held.device.info()).items()}
    if held.remote:
        remote = held.remote
        texts |= held.do(lambda: _firmware(remote))
    return DeviceFacts(tuple(DeviceFact(name.replace("_", " "), value) for name, value in texts.items()))


def _text_of(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _firmware(remote: Remote) -> dict[str, str]:
    hello = remote.client.hello
    version = ".".join(str(hello.firmware >> shift & 255) for shift in (16, 8, 0))
    counters = dataclasses.asdict(remote.client.counters())
    known = {"firmware": version, "protocol": f"{hello.hash:08x}", "serial": str(hello.serial)}
    return known | {name: str(value) for name, value in counters.items()}


@call("device.selftest")
def selftest(session: DeviceSession, _ask: Empty) -> SelfTest:
    held = session.thread()
    if not held.remote:
        return SelfTest((), "there is no firmware in this device, so there is nothing to test")
    reply = held.do(held.remote.client.selftest)
    values = struct.unpack("<8h", reply.values)
    parts = (
        PartVerdict(p.name.lower(), SelfTestResult(reply.verdicts[p]).name.lower(), values[p]) for p in Part
    )
    return SelfTest(tuple(parts), "")


CHANNEL = ChannelKind("scope", (WatchScope,), (DeviceStatus, ScopeFrame, PressSeen), ScopeChannel)
