"""An ODrive behind a CAN adapter that speaks slcan, written from the CANSimple pages; it uses no CAN library.

slcan: ``tIIILDD…`` is a data frame, ``rIIIL`` a remote one, ``O``, ``C`` and ``S8`` open, close and set the
rate; each command is answered by a carriage return. Simulated.
"""

from __future__ import annotations

import struct

from fdvv_drives.testing.far_end import FaultKind

IDLE, CLOSED_LOOP = 1, 8
WATCHDOG, OVER_TEMPERATURE = 0x1000000, 0x2000
HEARTBEAT_s = 0.1


class FarODrive:
    """One axis, node 3; watchdog_s is None where enable_watchdog is off.

    Attributes
    ----------
    torque : in Nm.
    """

    NODE = 3

    def __init__(self, watchdog_s: float | None) -> None:
        self.torque = self.finger_N = 0.0
        self.watchdog_s = watchdog_s
        self.state, self.error = IDLE, 0
        self._input, self._modes = 0.0, (3, 1)  # position control, as delivered
        self._heard_s = self._beat_s = 0.0
        self._open, self._waiting, self._position = False, b"", 0.0

    def fail(self, kind: FaultKind) -> None:
        self.error = OVER_TEMPERATURE if kind == "error" else 0
        if kind:
            self.state = IDLE

    def look(self, position: float, now_s: float) -> bytes:
        self._position = position
        if self.state == CLOSED_LOOP and self._is_silent(now_s):
            self.state, self.error = IDLE, self.error | WATCHDOG
        in_torque_control = self._modes == (1, 1)
        self.torque = self._input if self.state == CLOSED_LOOP and in_torque_control else 0.0
        if not self._open or now_s - self._beat_s < HEARTBEAT_s:
            return b""
        self._beat_s = now_s
        return self._sent(0x01, struct.pack("<IBBBB", self.error, self.state, 0, 0, 0))

    def _is_silent(self, now_s: float) -> bool:
        return self.watchdog_s is not None and now_s - self._heard_s > self.watchdog_s

    def answer(self, data: bytes, position: float, now_s: float) -> bytes:
        *commands, self._waiting = (self._waiting + data).split(b"\r")
        replies = b""
        for command in commands:
            replies += self._command(command.decode("ascii"), now_s)
            replies += self.look(position, now_s)
        return replies

    def _command(self, text: str, now_s: float) -> bytes:
        if text[:1] in ("O", "C"):
            self._open = text[0] == "O"
        if text[:1] not in ("t", "r"):
            return b"\r"
        identifier, length = int(text[1:4], 16), int(text[4])
        if identifier >> 5 != self.NODE or not self._open:
            return b"z\r"
        self._heard_s = now_s  # any message to the axis feeds its watchdog
        if text[0] == "r":
            return b"z\r" + self._estimate(identifier & 31)
        body = bytes.fromhex(text[5:])
        if len(body) != length:
            return b"\a"
        self._carry_out(identifier & 31, body)
        return b"z\r"

    def _carry_out(self, command: int, body: bytes) -> None:
        if command == 0x0E:
            (self._input,) = struct.unpack("<f", body)
        elif command == 0x0B:
            self._modes = struct.unpack("<II", body)
        elif command == 0x18:
            self.error &= OVER_TEMPERATURE  # comes back at once
        elif command == 0x07:
            (state,) = struct.unpack("<I", body)
            self.state = IDLE if state == CLOSED_LOOP and self.error else state

    def _estimate(self, command: int) -> bytes:
        if command == 0x03:
            return self._sent(command, struct.pack("<II", self.error, 0))
        if command == 0x09:
            return self._sent(command, struct.pack("<ff", self._position, 0.0))
        if command == 0x1C:
            return self._sent(command, struct.pack("<ff", self._input, self.torque))
        return b""

    def _sent(self, command: int, body: bytes) -> bytes:
        return f"t{self.NODE << 5 | command:03X}{len(body)}{body.hex().upper()}\r".encode()
