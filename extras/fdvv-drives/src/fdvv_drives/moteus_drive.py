"""A moteus on a fdcanusb: position mode without gains, so that only the feedforward torque acts.

mjbots' Python library makes and reads the frames (multiplex protocol, CAN-FD); the lines ``can send`` and
``rcv`` are those of the fdcanusb. The library's own transport is made for asyncio; a loop of one drive waits
for one answer anyway.
"""

from __future__ import annotations

import math
import re
import time
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from fdvv.errors import BuildError, DeviceError
from fdvv_drives.drive import LostAnswerError, Reading, SerialLine, check_watchdog

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


INPUT = re.compile(r"aux([12])\.([1-5])")
ANALOG_INPUTS = {"1": 0x060, "2": 0x068}
"""Registers of the first analog input of each auxiliary port; they read from 0 to 1."""


class MoteusPart(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The table [moteus]: port of the fdcanusb, CAN id, and the watchdog that every command carries.

    force_input : the analog input of a load cell's amplifier, "aux1.1" to "aux2.5"; "" without one.
    force_zero : its reading at no force, from 0 to 1. force_span_N : force against the finger that raises it
        by 1; negative if it falls.
    """

    port: str
    id: int = 1
    watchdog_ms: float = 50.0
    force_input: str = ""
    force_zero: float = 0.5
    force_span_N: float = 0.0

    def __post_init__(self) -> None:
        check_watchdog(self.watchdog_ms, may_be_off=False)
        if not 1 <= self.id <= 126:
            raise ValueError(f"id is {self.id}, write 1 to 126")
        has_scale = self.force_span_N and 0.0 <= self.force_zero <= 1.0
        if self.force_input and not (INPUT.fullmatch(self.force_input) and has_scale):
            needed = "force_input aux1.1 to aux2.5, force_span_N and a force_zero from 0 to 1"
            raise ValueError(f"a load cell needs {needed}")

    def force_register(self) -> int | None:
        """Return the register of the analog input; None without one."""
        found = INPUT.fullmatch(self.force_input)
        return None if found is None else ANALOG_INPUTS[found[1]] + int(found[2]) - 1


class Answer(NamedTuple):
    mode: int
    position: float
    torque: float
    fault: int
    force_N: float | None


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
        self._force_register = part.force_register()
        self.senses_force = self._force_register is not None
        asked = moteus.QueryResolution()
        asked._extra = {} if self._force_register is None else {self._force_register: moteus.INT16}
        self._controller: Any = moteus.Controller(id=part.id, query_resolution=asked)
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
        return Reading(answer.position, answer.torque, answer.force_N)

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
            force_N = self._force_N(values)
        except Exception:  # whatever the library makes of damaged bytes
            return None
        is_whole = math.isfinite(position + torque + (force_N or 0.0))
        return Answer(mode, position, torque, fault, force_N) if is_whole else None

    def _force_N(self, values: dict[int, float]) -> float | None:
        if self._force_register is None:
            return None
        return self._part.force_span_N * (values[self._force_register] - self._part.force_zero)

    def has_fallen(self) -> bool:
        return self._ask(self._controller.make_query(), tries=5).mode != POSITION_MODE

    def stop(self) -> None:
        self._send(self._controller.make_stop())

    def close(self) -> None:
        self.line.close()
