"""The rules of the link: kept by the firmware, and each planted fault is named by the rule that it breaks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.own_rig import OwnRigPerson, RigNumbers
from fdvv.device.plant import Inputs, Outputs
from fdvv.device.twin import SimulatedPerson
from fdvv.protocol.frame import Frame, crc16, encode, stuff, unstuff
from fdvv.protocol.messages import REPLY
from fdvv.protocol.tables import Message, PingReply, RecordsRequest, Settings, TickRecord
from fdvv.testing.link_checks import CHECKS, check_link
from fdvv.twin.rig import Rig
from tests.support.plain_rig import PlainRig


class FaultyBoard(LibraryBoard):
    """The firmware with its requests, replies and readings changed on their way."""

    def asked(self, frame: Frame) -> Frame | None:
        """Return the request that the firmware gets; None: none."""
        return frame

    def answered(self, frame: Frame) -> Frame | None:
        """Return what the host gets."""
        return frame

    def sensed(self, inputs: Inputs) -> Inputs:
        return inputs

    def write(self, data: bytes) -> None:
        super().write(b"".join(self._changed(part, self.asked) for part in _parts(data)))

    def read(self) -> bytes:
        return b"".join(self._changed(part, self.answered) for part in _parts(super().read()))

    def tick(self, inputs: Inputs) -> Outputs:
        return super().tick(self.sensed(inputs))

    @staticmethod
    def _changed(part: bytes, change: Callable[[Frame], Frame | None]) -> bytes:
        data = unstuff(part)
        if len(data) < 4 or crc16(data[:-2]) != int.from_bytes(data[-2:], "little"):
            return part + b"\0"
        found = change(Frame(data[0], data[1], data[2:-2]))
        return encode(found) if found else b""


def _parts(data: bytes) -> list[bytes]:
    """Cut at the zeros; the firmware and the client here write whole frames."""
    return [part for part in data.split(b"\0") if part]


class LosesEveryTenth(FaultyBoard):
    asked_so_far = 0

    def asked(self, frame: Frame) -> Frame | None:
        self.asked_so_far += 1
        return None if self.asked_so_far % 10 == 0 else frame


class CountsRepliesItself(FaultyBoard):
    """Numbers its replies as it likes where the host would not notice: those of raw requests."""

    def answered(self, frame: Frame) -> Frame:
        is_probe = frame.sequence >= 201 and frame.message == REPLY + Message.PING
        return replace(frame, sequence=(frame.sequence + 1) % 256) if is_probe else frame


class ChecksNoChecksum(FaultyBoard):
    def write(self, data: bytes) -> None:
        whole = b""
        for part in _parts(data):
            body = unstuff(part)[:-2]
            whole += stuff(body + crc16(body).to_bytes(2, "little")) + b"\0"
        LibraryBoard.write(self, whole)


class IgnoresStrangers(FaultyBoard):
    def asked(self, frame: Frame) -> Frame | None:
        return None if frame.message > Message.REFUSED - 3 else frame


class FastClock(FaultyBoard):
    def answered(self, frame: Frame) -> Frame:
        if frame.message != REPLY + Message.PING:
            return frame
        reply = PingReply.unpack(frame.payload)
        return replace(frame, payload=replace(reply, device_us=2 * reply.device_us % 2**32).pack())


class ForgetsTheLead(FaultyBoard):
    def asked(self, frame: Frame) -> Frame:
        if frame.message != Message.WRITE_SETTINGS:
            return frame
        return replace(frame, payload=replace(Settings.unpack(frame.payload), lead_us=0).pack())


class TakesAllSettings(FaultyBoard):
    def answered(self, frame: Frame) -> Frame:
        refused = frame.message == REPLY + Message.REFUSED and frame.payload[0] == Message.WRITE_SETTINGS
        return Frame(REPLY + Message.WRITE_SETTINGS, frame.sequence) if refused else frame


class TakesAllPrograms(FaultyBoard):
    def answered(self, frame: Frame) -> Frame:
        later = (Message.COMMIT, Message.ACTIVATE)
        refused = frame.message == REPLY + Message.REFUSED and frame.payload[0] in later
        return Frame(REPLY + frame.payload[0], frame.sequence) if refused else frame


class Records(FaultyBoard):
    """Changes the telemetry's records."""

    def answered(self, frame: Frame) -> Frame | None:
        if frame.message != Message.RECORDS:
            return frame
        size, step = RecordsRequest.length_bytes(), TickRecord.length_bytes()
        head, rows = RecordsRequest.unpack(frame.payload[:size]), frame.payload[size:]
        ticks = [TickRecord.unpack(rows[i : i + step]) for i in range(0, len(rows), step)]
        return self.changed(frame, head, ticks)

    def changed(self, frame: Frame, head: RecordsRequest, ticks: list[TickRecord]) -> Frame | None:
        raise NotImplementedError


class CommandsAlways(Records):
    def changed(self, frame: Frame, head: RecordsRequest, ticks: list[TickRecord]) -> Frame:
        pushed = [replace(tick, commanded_cN64=tick.commanded_cN64 or 640) for tick in ticks]
        return replace(frame, payload=head.pack() + b"".join(tick.pack() for tick in pushed))


class HalfTheForce(Records):
    def changed(self, frame: Frame, head: RecordsRequest, ticks: list[TickRecord]) -> Frame:
        weak = [replace(tick, commanded_cN64=tick.commanded_cN64 // 2) for tick in ticks]
        return replace(frame, payload=head.pack() + b"".join(tick.pack() for tick in weak))


class LosesRecords(Records):
    count = 0

    def changed(self, frame: Frame, head: RecordsRequest, ticks: list[TickRecord]) -> Frame | None:
        self.count += 1
        return None if self.count % 7 == 0 else frame


class HearsAHostAlways(FaultyBoard):
    """Has a host of its own that pings on, so that a silent one is never noticed."""

    ticks_so_far, own = 0, 250

    def answered(self, frame: Frame) -> Frame | None:
        return None if (frame.message, frame.sequence) == (REPLY + Message.PING, self.own) else frame

    def tick(self, inputs: Inputs) -> Outputs:
        self.ticks_so_far += 1
        if self.ticks_so_far % 400 == 0:
            LibraryBoard.write(self, encode(Frame(Message.PING, self.own, bytes(4))))
        return super().tick(inputs)


class NoSensor(FaultyBoard):
    def sensed(self, inputs: Inputs) -> Inputs:
        return inputs._replace(force_counts=2048)


class ReversedSensor(FaultyBoard):
    def sensed(self, inputs: Inputs) -> Inputs:
        return inputs._replace(force_counts=4096 - inputs.force_counts)


class ShiftedPosition(FaultyBoard):
    def sensed(self, inputs: Inputs) -> Inputs:
        moved = 400
        return inputs._replace(
            sum=inputs.sum + 25 * moved, lowest=inputs.lowest + moved, highest=inputs.highest + moved
        )


PLANTED = (
    (LosesEveryTenth, "requests are answered"),
    (CountsRepliesItself, "a reply has the number of its request"),
    (ChecksNoChecksum, "a damaged frame is left out"),
    (IgnoresStrangers, "an unknown message is refused"),
    (FastClock, "the clock counts microseconds"),
    (ForgetsTheLead, "settings are kept as written"),
    (TakesAllSettings, "settings at odds are refused"),
    (TakesAllPrograms, "a damaged program is refused"),
    (CommandsAlways, "idle, it commands no force"),
    (LosesRecords, "every tick is reported"),
    (HalfTheForce, "armed, it commands what the table asks"),
    (ShiftedPosition, "armed, the cap comes up to 0 mm"),
    (HearsAHostAlways, "a silent host ends the force"),
    (NoSensor, "the force sensor feels the finger"),
    (ReversedSensor, "the force sensor feels the finger"),
)


def own_rig(board: LibraryBoard | None = None) -> LinkedDevice:
    return LinkedDevice(board or LibraryBoard(), OwnRigPerson(PlainRig, 1))


def weak_rig() -> PlainRig:
    """A rig of 0.5 N and 2 mm at 20 kHz."""
    rig = PlainRig()
    few = {"supply_V": 3.0, "tick_us": 50, "travel_mm": 2.0, "force_sensor_N": 0.6}
    rig.numbers = RigNumbers("weak", 0.5, 0.45, **few)  # type: ignore[arg-type]
    return rig


@pytest.mark.parametrize("rig", ["own", "twin", "recommended twin", "weak"])
def test_the_firmware_keeps_every_rule(rig: str) -> None:
    person = (
        SimulatedPerson(Rig()) if "twin" in rig else OwnRigPerson({"own": PlainRig, "weak": weak_rig}[rig], 1)
    )
    device = LinkedDevice(LibraryBoard(), person)
    before = device.settings()
    results = list(check_link(device))
    assert [result for result in results if not result.passed] == []
    assert [result.name for result in results] == [check.name for check in CHECKS]
    assert device.client.read_settings() == before


@pytest.mark.slow
@pytest.mark.parametrize(("board", "rule"), PLANTED, ids=lambda one: getattr(one, "__name__", None))
def test_a_planted_fault_is_named_by_the_rule_that_it_breaks(board: type[LibraryBoard], rule: str) -> None:
    broken = [result for result in check_link(own_rig(board())) if not result.passed]
    assert rule in [result.name for result in broken]
    assert all(result.found and result.mend for result in broken)
    assert broken[0].name == rule, broken


def test_without_a_person_the_rules_of_a_press_are_left_out() -> None:
    results = list(check_link(own_rig(), pressed=False))
    assert len(results) == len(CHECKS) - 2
