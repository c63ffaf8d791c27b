"""A board with SimpleFOC's commander, written from Commander.cpp; in current control, motor M; simulated."""

from __future__ import annotations

from fdvv_drives.testing.far_end import FaultKind

COUNTS_RAD = 2**14 / 6.283185307179586


class FarSimpleFOC:
    """The sketch of docs/how-to/use-a-drive.md, whose loop disables the motor after some silence.

    watchdog_s : of the sketch; None for one without.

    Attributes
    ----------
    torque : in A.
    """

    def __init__(self, watchdog_s: float | None) -> None:
        self.torque = self.finger_N = 0.0
        self.watchdog_s = watchdog_s
        self.enabled, self.verbose, self.decimals = True, 2, 3
        self.motion, self.target, self.limit = "angle", 0.0, 0.2
        self._heard_s, self._waiting, self._position, self._failed = 0.0, b"", 0.0, ""

    def fail(self, kind: FaultKind) -> None:
        self._failed = kind
        if kind == "error":
            self.enabled = False
        if kind == "mode":
            self.motion, self.target, self.enabled = "velocity", 0.0, False

    def look(self, position: float, now_s: float) -> bytes:
        self._position = position
        if self.watchdog_s is not None and now_s - self._heard_s > self.watchdog_s:
            self.enabled = False
        acts = self.enabled and self.motion == "torque"
        self.torque = min(self.limit, max(-self.limit, self.target)) if acts else 0.0
        return b""

    def answer(self, data: bytes, position: float, now_s: float) -> bytes:
        self._position = position
        *commands, self._waiting = (self._waiting + data).split(b"\n")
        replies = ""
        for command in commands:
            text = command.decode("ascii")
            if text[:1] == "M":
                self._heard_s = now_s
            replies += self._run(text)
            self.look(position, now_s)
        return replies.encode()

    def _run(self, text: str) -> str:
        if text[:1] == "@":
            self.verbose = int(text[1:] or self.verbose)
            return self._line("Verb:", "on!")
        if text[:1] == "#":
            self.decimals = int(text[1:] or self.decimals)
            return self._line("Decimal:", str(self.decimals))
        return self._motor(text[1:]) if text[:1] == "M" else ""

    def _motor(self, text: str) -> str:
        head, rest = text[:1], text[1:]
        if head in "+-0123456789":
            self.target = float(text)
            return self._line("Target: ", self._number(self.target))
        if head == "C":
            if rest and not self._failed:
                self.motion = ("torque", "velocity", "angle")[int(float(rest))]
            return self._line("Motion:", "vel" if self.motion == "velocity" else self.motion)
        if head == "T":
            return self._line("Torque: ", "foc curr")
        if head == "E":
            if rest:
                self.enabled = bool(float(rest)) and not self._failed
            return self._line("Status: ", str(int(self.enabled)))
        if text[:2] == "LC":
            self.limit = float(text[2:] or self.limit)
            return self._line("Limits| curr: ", self._number(self.limit))
        if text[:2] == "MG":
            return self._monitored(int(text[2:]))
        return self._line("unknown cmd ", "err")

    def _monitored(self, variable: int) -> str:
        angle = round(self._position * COUNTS_RAD) / COUNTS_RAD
        values = (self.target, 0.0, 0.0, self.torque, 0.0, 0.0, angle)
        names = ("target", "Vq", "Vd", "Cq", "Cd", "vel", "angle")
        return self._line(f"Monitor | {names[variable]}: ", self._number(values[variable]))

    def _number(self, value: float) -> str:
        return f"{value:.{self.decimals}f}"

    def _line(self, words: str, value: str) -> str:
        return "" if self.verbose == 0 else f"{words if self.verbose == 2 else ''}{value}\r\n"
