"""The device view, as the page asks for it and looks on."""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable

from fdvv.device import Remote
from fdvv.errors import InputError
from fdvv.protocol import Part, Verdict
from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._devices import Devices, Look
from fdvv.studio._drawn import partly, rounded
from fdvv.studio._job_results import kept_file
from fdvv.studio._messages_device import (
    DeviceAsk,
    DeviceConnect,
    DeviceFact,
    DeviceFacts,
    DevicePress,
    DeviceStanding,
    DeviceUpload,
    PartVerdict,
    PressSeen,
    ScopeTold,
    SelfTest,
    WatchScope,
)
from fdvv.studio._studio import Studio
from fdvv.studio._work_choices import device_names
from fdvv.workflow import TickBinner, TickBins, TickPiece, load_actuation

LEAST_bin_s, MOST_bin_s = 0.0005, 1.0


class ScopeChannel:
    """One page that looks on."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._devices, self._tell = studio.part(Devices), tell
        self._end: Callable[[], None] | None = None
        self._binner = TickBinner(MOST_bin_s)

    def receive(self, ask: WatchScope) -> None:
        """Begin to look on, or with bins of another width. InputError."""
        if not LEAST_bin_s <= ask.bin_s <= MOST_bin_s:
            reason = f"cannot be {ask.bin_s:g}"
            raise InputError("bin_s", "bin_s", reason, f"use {LEAST_bin_s:g} to {MOST_bin_s:g} s")
        self._binner = TickBinner(ask.bin_s)
        if self._end is None:
            self._end = self._devices.look(Look(self._ticks, self._tell, self._tell))

    def close(self) -> None:
        """Look on no more."""
        if self._end:
            self._end()

    def _ticks(self, piece: TickPiece) -> None:
        binner = self._binner
        found = binner.add(piece)
        if found.number.size:
            self._tell(scope_told(found, binner.bin_s))


def scope_told(found: TickBins, bin_s: float) -> ScopeTold:
    """Give the message of some bins."""
    low, high = found.low, found.high
    return ScopeTold(
        bin_s,
        tuple(found.number.tolist()),
        rounded(low[0]),
        rounded(high[0]),
        partly(low[1]),
        partly(high[1]),
        rounded(low[2]),
        rounded(high[2]),
        tuple(found.state.tolist()),
        tuple(found.cut.tolist()),
        tuple(found.ticks.tolist()),
    )


def connect(studio: Studio, ask: DeviceConnect) -> DeviceStanding:
    """Connect a device."""
    return studio.part(Devices).connect(ask, device_names())


def disconnect(studio: Studio, _ask: DeviceAsk) -> DeviceStanding:
    """Let it go, at zero force."""
    return studio.part(Devices).disconnect()


def upload(studio: Studio, ask: DeviceUpload) -> DeviceStanding:
    """Make a button its program."""
    model = studio.shelf.model(ask.button)
    file = kept_file(studio.project, "actuation", ask.actuation) if ask.actuation else None
    return studio.part(Devices).upload(ask, model, load_actuation(file) if file else None)


def press(studio: Studio, ask: DevicePress) -> DeviceStanding:
    """Have the simulated person press it."""
    return studio.part(Devices).press(ask.velocity_mm_s)


def arm(studio: Studio, _ask: DeviceAsk) -> DeviceStanding:
    """Have it render its program until it is stopped."""
    return studio.part(Devices).do(lambda remote: remote.client.arm())


def stop(studio: Studio, _ask: DeviceAsk) -> DeviceStanding:
    """Have it fall to zero force."""
    return studio.part(Devices).do(lambda remote: remote.stop())


def clear_fault(studio: Studio, _ask: DeviceAsk) -> DeviceStanding:
    """Clear its latched fault."""
    return studio.part(Devices).do(lambda remote: remote.clear_fault())


def standing(studio: Studio, _ask: DeviceAsk) -> DeviceStanding:
    """Read how it is now."""
    return studio.part(Devices).refresh()


def facts(studio: Studio, _ask: DeviceAsk) -> DeviceFacts:
    """Tell all that is to know of it."""
    held = studio.part(Devices).held()
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


def selftest(studio: Studio, _ask: DeviceAsk) -> SelfTest:
    """Have it test its parts."""
    held = studio.part(Devices).held()
    if not held.remote:
        return SelfTest((), "there is no firmware in this device, so there is nothing to test")
    reply = held.do(held.remote.client.selftest)
    values = struct.unpack("<8h", reply.values)
    parts = (PartVerdict(p.name.lower(), Verdict(reply.verdicts[p]).name.lower(), values[p]) for p in Part)
    return SelfTest(tuple(parts), "")


CALLS = (
    Call("device.connect", DeviceConnect, DeviceStanding, connect),
    Call("device.disconnect", DeviceAsk, DeviceStanding, disconnect),
    Call("device.upload", DeviceUpload, DeviceStanding, upload),
    Call("device.press", DevicePress, DeviceStanding, press),
    Call("device.arm", DeviceAsk, DeviceStanding, arm),
    Call("device.stop", DeviceAsk, DeviceStanding, stop),
    Call("device.clear_fault", DeviceAsk, DeviceStanding, clear_fault),
    Call("device.standing", DeviceAsk, DeviceStanding, standing),
    Call("device.facts", DeviceAsk, DeviceFacts, facts),
    Call("device.selftest", DeviceAsk, SelfTest, selftest),
)
CHANNELS = (ChannelKind("scope", (WatchScope,), (DeviceStanding, ScopeTold, PressSeen), ScopeChannel),)
