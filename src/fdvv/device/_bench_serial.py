"""A capture bench on a serial port: a microcontroller that writes lines, and a person who presses."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime

from fdvv.device._bench import BenchInfo, Cue
from fdvv.device._port import Port
from fdvv.errors import DeviceError, ModelError
from fdvv.recording import Mark, SerialCapture, Stage, Take

HEAD_s = 12.0
"""Time in which a bench must tell what it is; boards that do not answer do so every ten seconds."""
BODY = 20
"""So many lines of samples in a row, and the head is over."""
SILENT_s = 1.0
"""A bench that writes nothing for so long is not running."""
GLANCE_s = 0.004
"""Time between two looks at the cue."""
AFTER_s = 0.8
"""Recorded after the cue, for a person who is late."""
ANCHOR_us = 20 * 60 * 1_000_000
"""The board's counter turns every 71.6 minutes; times so far apart leave no doubt how often it did."""
TURN_us = 2**32
ASK, BLINK = b"?\n", b"L\n"
"""What the host sends: write your head again; blink the light before a press."""
ANCHOR = "session"
MAGIC = "# fdvv-capture "
_TIME = re.compile(r"(?:[A-Z]{1,8}|!) (\d{1,10}) \S", re.ASCII)


class SerialBench:
    """A bench that writes the text of docs/reference/capture-serial.md, and a person who follows the cue.

    Times run on from the first line that was heard, through all takes; takes after another start of the
    program are on a clock of their own.

    Parameters
    ----------
    port : an open line; closed if the bench does not answer.

    Raises DeviceError if nothing comes or something else.
    """

    def __init__(self, port: Port) -> None:
        self._port, self._rest, self._cut, self._clock = port, b"", True, ""
        self._capture = SerialCapture()
        try:
            self._feed(self._heard())
            self._capture.take(1)
            self._bench = self._capture.bench
        except ModelError as error:
            port.close()
            raise DeviceError(f"{port.name}: {error}") from error
        except BaseException:
            port.close()
            raise

    def facts(self) -> BenchInfo:
        """Tell who this is, as its head says."""
        return BenchInfo(self._port.name, False, self._bench)

    def take(self, number: int, stage: Stage, velocity_mm_s: float | None, cue: Cue) -> Take:
        """Record while the cue is shown and a little longer. Raises DeviceError."""
        self._clock = self._clock or ("board" if number == 1 else f"board from take {number}")
        made = datetime.now(UTC).isoformat(timespec="seconds")
        self._drain()
        self._feed(self._anchors())
        known = len(self._capture.warnings)
        self._port.write(BLINK)
        self._feed(self._recorded(cue))
        take = self._capture.take(number, stage, velocity_mm_s, made)
        if not any(stream.t_s.size for stream in take.streams):
            raise DeviceError(f"{self._port.name}: no sample came; check the board's program")
        begun_s = min(float(stream.t_s[0]) for stream in take.streams if stream.t_s.size)
        marks = [replace(mark, clock=self._clock) for mark in take.marks if mark.name != ANCHOR]
        marks += [Mark(name, self._clock, begun_s + t_s) for name, t_s in cue.events]
        streams = tuple(replace(stream, clock=self._clock) for stream in take.streams)
        return replace(
            take, streams=streams, marks=tuple(marks), remark="; ".join(self._capture.warnings[known:])
        )

    def close(self) -> None:
        """Let the port go."""
        self._port.close()

    def _heard(self) -> list[str]:
        """Listen until the head and some samples have come; give them."""
        self._port.write(ASK)
        until_s, lines, heard, body = self._port.now_s() + HEAD_s, list[str](), False, 0
        while self._port.now_s() < until_s:
            data = self._port.read(self._port.now_s() + GLANCE_s)
            heard |= bool(data)
            for line in self._lines(data):
                lines = [line] if line.startswith(MAGIC) else [*lines, line] if lines else []
                body = body + 1 if lines and _TIME.match(line) else 0
                if body == BODY:
                    return lines
        found = "something else than a capture bench writes there" if heard else "no answer"
        raise DeviceError(
            f"{self._port.name}: {found}; check the port's name, the cable and the board's program"
        )

    def _recorded(self, cue: Cue) -> list[str]:
        begun_s = heard_s = self._port.now_s()
        lines: list[str] = []
        while (now_s := self._port.now_s()) < begun_s + cue.length_s + AFTER_s:
            cue.show(min(now_s - begun_s, cue.length_s))
            found = self._lines(self._port.read(now_s + GLANCE_s))
            heard_s = now_s if found else heard_s
            if now_s - heard_s > SILENT_s:
                raise DeviceError(f"{self._port.name}: the bench fell silent; check its power and its cable")
            lines += found
        return lines

    def _lines(self, data: bytes) -> list[str]:
        """Cut what came into whole lines; the last, which is not, waits, and one that was cut is left out."""
        *whole, self._rest = (self._rest + data).split(b"\n")
        if self._cut and whole:
            whole, self._cut = whole[1:], False
        return [text for line in whole if (text := line.decode("ascii", "replace").strip())]

    def _drain(self) -> None:
        """Let go of what came while nobody listened."""
        until_s = self._port.now_s() + SILENT_s
        while self._port.now_s() < until_s and self._port.read(self._port.now_s()):
            pass
        self._rest, self._cut = b"", True

    def _feed(self, lines: Sequence[str]) -> None:
        """Hand lines on, and remember the last time among them and when it was heard."""
        for line in lines:
            if self._capture.feed(line) and (timed := _TIME.match(line)):
                self._last_us, self._last_s = int(timed[1]), self._port.now_s()

    def _anchors(self) -> list[str]:
        """Write events that lead the board's counter over the time in which nobody listened."""
        count = int((self._port.now_s() - self._last_s) * 1e6) // ANCHOR_us
        return [f"! {(self._last_us + i * ANCHOR_us) % TURN_us} {ANCHOR}" for i in range(1, count + 1)]
