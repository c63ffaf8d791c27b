"""A board with SimpleFOC's commander on a serial port: ``commander.add('M', ...)`` with ``commander.motor``.

Commands and their answers are those of src/communication/Commander.cpp (Arduino-FOC 2.3 and 2.4): every
command of a motor begins with its letter, ``M0.5`` sets the target and repeats it, ``MMG6`` asks for the
angle, ``MMG3`` for the current, ``MMG1`` for the voltage.
"""

from __future__ import annotations

import math
import time
from typing import Literal

import msgspec

from fdvv.errors import DeviceError
from fdvv_drives.drive import LostAnswerError, Reading, SerialLine, check_watchdog
from fdvv_drives.stage import TorqueUnit

BOOT_s = 4.0
"""Many boards reset when their port is opened, and align their motor then."""
DECIMALS = 5
TORQUE_TYPES = {"voltage": "volt", "dc_current": "dc curr", "foc_current": "foc curr"}
"""What the commander answers to MT."""
LOOK_EVERY = 50
"""Cycles between two looks whether the motor is still enabled."""


class SimpleFOCPart(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The table [simplefoc].

    letter : under which the motor was added to the commander. torque : its torque controller.
    watchdog_ms : after so long without a command the sketch disables the motor; 0 if it does not: SimpleFOC
        has no watchdog of its own.
    """

    port: str
    watchdog_ms: float
    baud: int = 115200
    letter: str = "M"
    torque: Literal["voltage", "dc_current", "foc_current"] = "foc_current"

    def __post_init__(self) -> None:
        check_watchdog(self.watchdog_ms, may_be_off=True)
        if not (len(self.letter) == 1 and "A" <= self.letter <= "z"):
            raise ValueError(f"letter is {self.letter!r}, write the one of command.add")

    @property
    def torque_unit(self) -> TorqueUnit:
        return "V" if self.torque == "voltage" else "A"


class SimpleFOCDrive:
    """A drive as in fdvv_drives.drive.Drive, without a load cell; positions in rad, torques in V or A."""

    senses_force = False

    def __init__(self, part: SimpleFOCPart, torque_limit: float, answer_s: float) -> None:
        self.watchdog_s = part.watchdog_ms / 1000 or None
        self.name = f"simplefoc {part.letter}" + ("" if self.watchdog_s else ", no watchdog")
        self._part, self._limit, self._answer_s = part, torque_limit, answer_s
        self._cycles = 0
        self.line = SerialLine(part.port, part.baud)
        try:
            self._begin()
        except BaseException:
            self.line.close()
            raise

    def _begin(self) -> None:
        """Have values alone answered, with enough decimals; refuse another torque controller."""
        until_s = time.perf_counter() + BOOT_s
        while self._ask("@1", 0.3) != "on!":
            if time.perf_counter() > until_s:
                raise DeviceError(
                    f"{self.name}: no commander answers on {self._part.port} in {BOOT_s:g} s"
                    f"{self.line.what_came()}; check port, baud and that loop() calls command.run()"
                )
        self._expect(f"#{DECIMALS}", str(DECIMALS), "the commander cannot set its decimals")
        self._expect(
            self._motor("T"),
            TORQUE_TYPES[self._part.torque],
            f"its torque controller is not {self._part.torque}",
        )
        limit = self._motor(f"L{'U' if self._part.torque == 'voltage' else 'C'}{self._limit:.4f}")
        self._expect(limit, f"{self._limit:.4f}", "does not take the limit of torque")

    def _motor(self, rest: str) -> str:
        return self._part.letter + rest

    def _ask(self, command: str, wait_s: float) -> str | None:
        self.line.drop()
        self.line.write(f"{command}\n".encode())
        for line in self.line.lines(time.perf_counter() + wait_s):
            return line.decode("ascii", "replace")
        return None

    def _expect(self, command: str, wanted: str, otherwise: str) -> None:
        for attempt in range(3):
            answer = self._ask(command, max(0.1, self._answer_s) * (attempt + 1))
            if answer is not None and (answer == wanted or _is_near(answer, wanted)):
                return
        found = f"; it answers {answer[:40]!r} to {command}" if answer else f"; {command} is not answered"
        raise DeviceError(f"{self.name}: {otherwise}{found}")

    def enable(self) -> None:
        self._expect(self._motor("C0"), "torque", "cannot be set to torque control")
        self._expect(self._motor("0"), "0", "does not take a target")
        self._expect(self._motor("E1"), "1", "the motor cannot be enabled")
        self._cycles = 0

    def exchange(self, torque: float) -> Reading:
        self._cycles += 1
        self.line.drop()
        target = f"{torque:.{DECIMALS}f}"
        asked = [target, "MG6", "MG1" if self._part.torque == "voltage" else "MG3"]
        if self._cycles % LOOK_EVERY == 0:
            asked.append("E")
        self.line.write("".join(f"{self._motor(command)}\n" for command in asked).encode())
        answers: list[float] = []
        for line in self.line.lines(time.perf_counter() + self._answer_s):
            if not self._is_next(line, answers, float(target)):
                continue  # what an older command has left, or damaged: then too few follow
            answers.append(float(line))
            if len(answers) == len(asked):
                return self._reading(answers)
        raise LostAnswerError(
            f"{self.name}: no answer on {self.line.name} in {1000 * self._answer_s:g} ms"
            f"{self.line.what_came()}"
        )

    @staticmethod
    def _is_next(line: bytes, answers: list[float], target: float) -> bool:
        """Return whether a line is a number, and the first of them the target that was just sent."""
        try:
            value = float(line)
        except ValueError:
            return False
        return math.isfinite(value) and (bool(answers) or abs(value - target) < 2 * 10.0**-DECIMALS)

    def _reading(self, answers: list[float]) -> Reading:
        if answers[3:] == [0.0]:
            raise DeviceError(f"{self.name}: the board has disabled the motor")
        return Reading(answers[1], answers[2])

    def has_fallen(self) -> bool:
        for _ in range(3):
            answer = self._ask(self._motor("E"), max(0.1, self._answer_s))
            if answer in ("0", "1"):
                return answer == "0"
        raise DeviceError(f"{self.name}: does not say whether the motor is enabled")

    def stop(self) -> None:
        self.line.write(f"{self._motor('0')}\n{self._motor('E0')}\n".encode())

    def close(self) -> None:
        self.line.close()


def _is_near(answer: str, wanted: str) -> bool:
    try:
        return math.isclose(float(answer), float(wanted), rel_tol=1e-3, abs_tol=1e-3)
    except ValueError:
        return False
