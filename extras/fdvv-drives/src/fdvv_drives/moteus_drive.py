"""A moteus on a fdcanusb: position mode without gains, so that only the feedforward torque acts.

mjbots' Python library makes and reads the frames (multiplex protocol, CAN-FD); the lines ``can send`` and
``rcv`` are those of the fdcanusb. The library's own transport is made for asyncio; a loop of one drive waits
for one answer anyway.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from fdvv.errors import BuildError, DeviceError
from fdvv_drives.drive import LostAnswerError, Reading, SerialLine

if TYPE_CHECKING:
    from collections.abc import Iterator

POSITION_MODE, TIMEOUT_MODE = 10, 11
SIZES = (*range(9), 12, 16, 20, 24, 32, 48, 64)
"""Bytes that a CAN-FD frame can hold."""
PADDING = 0x50
"""A multiplex subframe that does nothing."""
FAULTS = {
    1: "DMA stream transfer",
    2: "DMA stream FIFO",
    3: "UART overrun",
    4: "UART framing",
    5: "UART noise",
    6: "UART buffer overrun",
    7: "UART parity",
    32: "calibration",
    33: "motor driver",
    34: "over-voltage",
    35: "encoder",
    36: "motor not configured",
    37: "PWM cycle overrun",
    38: "over-temperature",
    39: "started outside its position limits",
    40: "under-voltage",
    41: "configuration changed",
    42: "no valid commutation encoder",
    43: "no valid output encoder",
    44: "driver enable",
    45: "stop position without limits",
    46: "timing violation",
}
"""Of the register 0x00f, from mjbots' reference manual."""


class MoteusPart(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The table [moteus]: port of the fdcanusb, CAN id, and the watchdog that every command carries."""

    port: str
    id: int = 1
    watchdog_ms: float = 50.0


class Answer(NamedTuple):
    mode: int
    position: float
    torque: float
    fault: int


class _Frame(NamedTuple):
    arbitration_id: int
    data: bytes


class MoteusDrive:
    """A drive as in fdvv_drives.drive.Drive; positions in rev, torques in Nm at the output."""

    def __init__(self, part: MoteusPart, torque_limit: float, answer_s: float) -> None:
        try:
            import moteus
        except ImportError:
            raise BuildError("the moteus needs mjbots' library; pip install 'fdvv-drives[moteus]'") from None
        self.name = f"moteus {part.id}"
        self.watchdog_s: float | None = part.watchdog_ms / 1000
        self._register, self._part = moteus.Register, part
        self._controller: Any = moteus.Controller(id=part.id)
        self._torque_limit, self._answer_s = torque_limit, answer_s
        self.line = SerialLine(part.port, 115200)  # USB: the rate is not used

    def enable(self) -> None:
        # also clears a latched fault or timeout
        answer = self._ask(self._controller.make_stop(query=True), tries=5)
        if answer.fault:
            raise DeviceError(self._in_fault(answer))
        self.exchange(0.0)

    def exchange(self, torque: float) -> Reading:
        answer = self._ask(self._position(torque))
        if answer.mode != POSITION_MODE or answer.fault:
            raise DeviceError(self._in_fault(answer))
        return Reading(answer.position, answer.torque)

    def _position(self, torque: float) -> Any:
        """Return the command: no gain, no integral; torque cut once more, by the drive."""
        return self._controller.make_position(
            position=math.nan,
            velocity=0.0,
            feedforward_torque=torque,
            kp_scale=0.0,
            kd_scale=0.0,
            ilimit_scale=0.0,
            maximum_torque=self._torque_limit,
            watchdog_timeout=self.watchdog_s,
            query=True,
        )

    def _in_fault(self, answer: Answer) -> str:
        if answer.fault:
            known = FAULTS.get(answer.fault, "see mjbots' reference manual")
            return f"{self.name}: reports fault {answer.fault} ({known}); mend its cause"
        if answer.mode == TIMEOUT_MODE:
            return f"{self.name}: its watchdog ended the torque; the host was silent too long"
        return f"{self.name}: is in mode {answer.mode}, not in position mode; is another host commanding it?"

    def _ask(self, command: Any, tries: int = 1) -> Answer:
        for attempt in range(tries):
            self.line.drop()
            self._send(command)
            for frame in self._frames(time.perf_counter() + self._answer_s * (attempt + 1)):
                if (answer := self._answer(command, frame)) is not None:
                    return answer
        raise LostAnswerError(
            f"{self.name}: no answer on {self.line.name} in {1000 * self._answer_s:g} ms"
            f"{self.line.what_came()}"
        )

    def _send(self, command: Any) -> None:
        data = command.data
        size = next(size for size in SIZES if size >= len(data))
        padded = data + bytes([PADDING]) * (size - len(data))
        identifier = self._part.id | (0x8000 if command.reply_required else 0)
        self.line.write(f"can send {identifier:04x} {padded.hex()} BF\n".encode())

    def _frames(self, until_s: float) -> Iterator[_Frame]:
        for line in self.line.lines(until_s):
            words = line.split()
            if words[:1] == [b"ERR"]:
                raise DeviceError(
                    f"{self.name}: the fdcanusb refuses the frame ({line.decode('ascii', 'replace')})"
                )
            if len(words) < 3 or words[0] != b"rcv":
                continue
            try:
                yield _Frame(int(words[1], 16), bytes.fromhex(words[2].decode("ascii")))
            except ValueError:
                continue  # damaged on the way

    def _answer(self, command: Any, frame: _Frame) -> Answer | None:
        """Return what a frame answers; None if it is another's, or damaged."""
        if frame.arbitration_id >> 8 & 0x7F != self._part.id or frame.arbitration_id & 0xFF:
            return None
        try:
            values = command.parse(frame).values
            register = self._register
            mode, fault = int(values[register.MODE]), int(values[register.FAULT])
            position, torque = float(values[register.POSITION]), float(values[register.TORQUE])
        except Exception:  # whatever the library makes of damaged bytes
            return None
        return Answer(mode, position, torque, fault) if math.isfinite(position + torque) else None

    def has_fallen(self) -> bool:
        return self._ask(self._controller.make_query(), tries=5).mode != POSITION_MODE

    def stop(self) -> None:
        self._send(self._controller.make_stop())

    def close(self) -> None:
        self.line.close()
