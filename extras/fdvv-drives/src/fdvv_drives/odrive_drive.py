"""An ODrive on CAN (CANSimple, firmware 0.6), by python-can: torque mode, asked by remote frames.

Numbers of messages, states and errors: the CANSimple pages and enumerations of ODrive's firmware 0.6.
"""

from __future__ import annotations

import math
import struct
import time
from collections.abc import Iterator
from enum import IntEnum, IntFlag
from typing import TYPE_CHECKING, Any

import msgspec

from fdvv.errors import BuildError, DeviceError
from fdvv_drives.drive import LostAnswerError, Reading, check_watchdog, line_errors

if TYPE_CHECKING:
    import can

IDLE, CLOSED_LOOP = 1, 8
TORQUE_CONTROL, PASSTHROUGH = 1, 1
HEARTBEAT_s = 1.0
"""Longest wait for a heartbeat; it comes every 100 ms unless configured otherwise."""

SYNC_s = 0.3
"""Longest wait for the answer after which everything older has been read."""


class CanCommand(IntEnum):
    """Lower five bits of an identifier; the node is in the upper six."""

    HEARTBEAT = 0x01
    GET_ERROR = 0x03
    SET_AXIS_STATE = 0x07
    GET_ENCODER_ESTIMATES = 0x09
    SET_CONTROLLER_MODE = 0x0B
    SET_INPUT_TORQUE = 0x0E
    CLEAR_ERRORS = 0x18
    GET_TORQUES = 0x1C


KNOWN = frozenset(map(int, CanCommand))


class AxisError(IntFlag):
    INITIALIZING = 0x1
    SYSTEM_LEVEL = 0x2
    TIMING_ERROR = 0x4
    MISSING_ESTIMATE = 0x8
    BAD_CONFIG = 0x10
    DRV_FAULT = 0x20
    MISSING_INPUT = 0x40
    DC_BUS_OVER_VOLTAGE = 0x100
    DC_BUS_UNDER_VOLTAGE = 0x200
    DC_BUS_OVER_CURRENT = 0x400
    DC_BUS_OVER_REGEN_CURRENT = 0x800
    CURRENT_LIMIT_VIOLATION = 0x1000
    MOTOR_OVER_TEMP = 0x2000
    INVERTER_OVER_TEMP = 0x4000
    VELOCITY_LIMIT_VIOLATION = 0x8000
    POSITION_LIMIT_VIOLATION = 0x10000
    REQUESTED_CURRENT_TOO_HIGH = 0x20000
    WATCHDOG_TIMER_EXPIRED = 0x1000000
    ESTOP_REQUESTED = 0x2000000
    SPINOUT_DETECTED = 0x4000000
    BRAKE_RESISTOR_DISARMED = 0x8000000
    THERMISTOR_DISCONNECTED = 0x10000000
    CALIBRATION_ERROR = 0x40000000


class ODrivePart(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The table [odrive]: python-can's interface and channel, the node, and the watchdog that it is set to.

    watchdog_ms : axis.config.watchdog_timeout of the drive, where enable_watchdog is on; 0 if it is off.
    """

    channel: str
    watchdog_ms: float
    interface: str = "socketcan"
    bitrate: int = 1_000_000
    node: int = 0

    def __post_init__(self) -> None:
        check_watchdog(self.watchdog_ms, may_be_off=True)
        if not 0 <= self.node <= 63:
            raise ValueError(f"node is {self.node}, write 0 to 63")


class ODriveDrive:
    """A drive as in fdvv_drives.drive.Drive, without a load cell; positions in rev, torques in Nm."""

    senses_force = False

    def __init__(self, part: ODrivePart, answer_s: float) -> None:
        self.watchdog_s = part.watchdog_ms / 1000 or None
        self.name = f"odrive {part.node}" + ("" if self.watchdog_s else ", no watchdog")
        self._part, self._answer_s = part, answer_s
        self._error, self._state, self._heartbeats = AxisError(0), 0, 0
        self._is_behind = False
        self._can, self._bus = _bus_of(part)
        if not self._hear_heartbeat():
            self.close()
            raise DeviceError(
                f"{self.name}: no heartbeat on {part.channel} in {HEARTBEAT_s:g} s; "
                "check power, node and bit rate"
            )

    def enable(self) -> None:
        if not self._catch_up(SYNC_s) or not self._hear_heartbeat():
            raise self._no_answer(SYNC_s)
        if self._error & AxisError.WATCHDOG_TIMER_EXPIRED:  # what silence before this session has left
            self._send(CanCommand.CLEAR_ERRORS, b"\0")
            self._hear_heartbeat()
        if self._error:
            raise DeviceError(self._in_error())
        modes = struct.pack("<II", TORQUE_CONTROL, PASSTHROUGH)
        self._send(CanCommand.SET_CONTROLLER_MODE, modes)
        self._command(0.0)
        self._send(CanCommand.SET_AXIS_STATE, struct.pack("<I", CLOSED_LOOP))
        until_s = time.perf_counter() + HEARTBEAT_s
        while self._state != CLOSED_LOOP or self._error:
            self._command(0.0)  # feeds the watchdog
            if self._error or time.perf_counter() > until_s:
                raise DeviceError(self._in_error())
            self._hear_heartbeat(0.01)

    def _in_error(self) -> str:
        if self._error:
            names = ", ".join(error.name.lower() for error in AxisError if error & self._error and error.name)
            return f"{self.name}: reports {names or f'error {int(self._error):#x}'}; mend its cause"
        return f"{self.name}: is in axis state {self._state}, not in closed-loop control; is it calibrated?"

    def exchange(self, torque: float) -> Reading:
        if self._is_behind and not self._catch_up(self._answer_s):
            raise self._no_answer(self._answer_s)
        self._command(torque)
        self._send(CanCommand.GET_ENCODER_ESTIMATES)
        self._send(CanCommand.GET_TORQUES)
        position = None
        for command, data in self._messages(time.perf_counter() + self._answer_s):
            if self._error or self._state != CLOSED_LOOP:
                raise DeviceError(self._in_error())
            if command == CanCommand.GET_ENCODER_ESTIMATES:
                position = struct.unpack_from("<f", data)[0]
            elif command == CanCommand.GET_TORQUES and position is not None:
                # asked for last: before it came all that was sent unasked, such as older positions
                return self._reading(position, struct.unpack_from("<f", data, 4)[0])
        self._is_behind = True
        raise self._no_answer(self._answer_s)

    def _no_answer(self, wait_s: float) -> LostAnswerError:
        return LostAnswerError(f"{self.name}: no answer on {self._part.channel} in {1000 * wait_s:g} ms")

    def _reading(self, position: float, torque: float) -> Reading:
        if not math.isfinite(position + torque):
            raise LostAnswerError(f"{self.name}: answers with a position or torque that is no number")
        return Reading(position, torque)

    def _catch_up(self, wait_s: float) -> bool:
        """Read all that came late, or while nobody listened; return whether the drive answers.

        Else every answer would be that to an older question. Messages arrive in order, and errors are asked
        for nowhere else: what comes after their answer is new.
        """
        self._send(CanCommand.GET_ERROR)
        for command, _ in self._messages(time.perf_counter() + wait_s):
            if command == CanCommand.GET_ERROR:
                self._is_behind = False
                return True
        return False

    def has_fallen(self) -> bool:
        # asking feeds the watchdog, but what it has ended does not come back by itself
        if not self._catch_up(SYNC_s) or not self._hear_heartbeat():
            raise self._no_answer(SYNC_s)
        return self._state != CLOSED_LOOP

    def stop(self) -> None:
        self._command(0.0)
        self._send(CanCommand.SET_AXIS_STATE, struct.pack("<I", IDLE))
        self._state = IDLE

    def close(self) -> None:
        with line_errors(self.name):
            self._bus.shutdown()

    def _command(self, torque: float) -> None:
        self._send(CanCommand.SET_INPUT_TORQUE, struct.pack("<f", torque))

    def _send(self, command: CanCommand, data: bytes | None = None) -> None:
        """Send a message, or with no data a remote frame that asks for one."""
        message = self._can.Message(
            arbitration_id=self._part.node << 5 | command,
            is_extended_id=False,
            is_remote_frame=data is None,
            dlc=8 if data is None else len(data),
            data=data,
        )
        with line_errors(self.name):
            self._bus.send(message)

    def _hear_heartbeat(self, wait_s: float = HEARTBEAT_s) -> bool:
        """Wait for the next heartbeat."""
        before = self._heartbeats
        return any(self._heartbeats > before for _ in self._messages(time.perf_counter() + wait_s))

    def _messages(self, until_s: float) -> Iterator[tuple[CanCommand, bytes]]:
        """Yield what the node sends until then; notes its heartbeats, which say state and error."""
        while (left_s := until_s - time.perf_counter()) > 0:
            with line_errors(self.name):
                message = self._bus.recv(timeout=left_s)
            if message is None or message.is_remote_frame or message.arbitration_id >> 5 != self._part.node:
                continue
            command, data = message.arbitration_id & 0x1F, bytes(message.data)
            if command not in KNOWN or len(data) < 8:
                continue
            if command == CanCommand.HEARTBEAT:
                error, self._state = struct.unpack_from("<IB", data)
                self._error, self._heartbeats = AxisError(error), self._heartbeats + 1
            yield CanCommand(command), data


def _bus_of(part: ODrivePart) -> tuple[Any, can.BusABC]:
    try:
        import can
    except ImportError:
        raise BuildError("the ODrive needs python-can; pip install 'fdvv-drives[odrive]'") from None
    # python-can waits 2 s for boards that reset as their port is opened; CAN adapters do not
    more: dict[str, Any] = {"sleep_after_open": 0.1} if part.interface == "slcan" else {}
    try:
        bus = can.Bus(interface=part.interface, channel=part.channel, bitrate=part.bitrate, **more)
    except Exception as error:  # each of its interfaces raises what its driver does
        reason = " ".join(str(error).split())
        raise DeviceError(
            f"{part.interface} {part.channel}: cannot be opened ({reason}); "
            "check adapter, channel and permissions"
        ) from error
    return can, bus
