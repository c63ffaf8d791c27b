"""The text of a capture microcontroller as takes: from a file at once, or from the board as it comes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.recording._reading import Reading, counted, refusal, rising, unlike
from fdvv.recording._serial_lines import FORMAT, VERSION, Body, Head, TURN_us, read_line
from fdvv.recording._titles import Title, read_title
from fdvv.recording._types import Bench, Mark, Quantity, Stage, Stream, Take
from fdvv.units import FloatArray

CLOCK = "board"
REMEDY = "compare with docs/reference/capture-serial.md"


class SerialCapture:
    """What a capture board writes, cut into takes while it goes on; its clock runs through all of them.

    Attributes
    ----------
    warnings : what could not be read or is not known, so far.
    """

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self._head, self._body = Head(), Body()
        self._lines = 0
        self._garbled: list[int] = []
        self._last: tuple[int, float] | None = None

    def feed(self, line: str) -> bool:
        """Take in a line; False if it is garbled, which is counted. ModelError on a version to come."""
        self._lines += 1
        fine = not line.strip() or read_line(line.strip(), self._head, self._body)
        if not fine:
            self._garbled.append(self._lines)
        if self._head.version not in (None, VERSION):
            reason = f"version {self._head.version} of {FORMAT}, this fdvv reads version {VERSION}"
            raise ModelError(reason)
        return fine

    @property
    def bench(self) -> Bench:
        """Give what the head says of the bench. ModelError if that cannot be."""
        numbers: dict[str, Any] = self._head.bench
        return Bench(**numbers)

    def take(
        self, number: int, stage: Stage = Stage.UNKNOWN, velocity_mm_s: float | None = None, made: str = ""
    ) -> Take:
        """Give what came since the last take: channels as streams, events as marks.

        Seconds count from the first line that bore a time. A line that has not come whole belongs to no take.
        """
        body, self._body = self._body, Body()
        t_s = self._seconds(np.array(body.us, dtype=np.int64))
        self._tell()
        streams = unlike(self._stream(body, channel, t_s) for channel in body.at)
        marks = tuple(Mark(name, CLOCK, float(t_s[at])) for at, name in body.events)
        return Take(number, streams, marks, stage, velocity_mm_s, made)

    def _seconds(self, us: npt.NDArray[np.int64]) -> FloatArray:
        """Give seconds since the first time; a step is the shorter way round the counter's turn."""
        if not us.size:
            return np.empty(0)
        before_us, before_s = self._last or (int(us[0]), 0.0)
        half = TURN_us // 2
        steps = (np.diff(us, prepend=before_us) + half) % TURN_us - half
        seconds: FloatArray = np.cumsum(steps) * 1e-6 + before_s
        self._last = (int(us[-1]), float(seconds[-1]))
        return seconds

    def _tell(self) -> None:
        if self._head.version is None:
            self._say("the head was missed; channels without one are kept as counts")
        if self._garbled:
            first = f"line {self._garbled[0]}"
            several = f"{len(self._garbled)} lines, {first} the first,"
            self._say(f"{first if len(self._garbled) == 1 else several} garbled and left out")
            self._garbled = []

    def _say(self, warning: str) -> None:
        if warning not in self.warnings:
            self.warnings.append(warning)

    def _stream(self, body: Body, channel: str, t_s: FloatArray) -> Stream:
        at, raw = np.array(body.at[channel]), np.array(body.value[channel], dtype=np.int64)
        keep = rising(t_s[at])
        if not keep.all():
            dropped = counted(int(keep.size - keep.sum()), "sample")
            self._say(f"channel {channel}: {dropped} left out: the times do not rise")
        title, scale, zero = self._head.titles.get(channel, ("", 1.0, 0.0))
        told = read_title(title) if title else None
        if told is None or not told.unit_is_known:
            if self._head.version is not None:
                why = f"is called {title!r:.30}, which names no unit" if title else "is not in the head"
                self._say(f"channel {channel} {why}; its numbers are kept as counts")
            told, scale, zero = Title(title or channel, Quantity.COUNTS, 1.0), 1.0, 0.0
        small = raw.astype(np.int32) if np.abs(raw).max(initial=0) < 2**31 else raw
        name = f"{told.name}_{told.axis}" if told.axis else told.name
        quantity = Quantity.DISPLACEMENT if told.axis else told.quantity
        return Stream(name, quantity, CLOCK, t_s[at][keep], small[keep], scale * told.scale, zero)


def read_serial(source: Path, lines: Sequence[str]) -> Reading:
    """Read a whole text as one take.

    Lines that are garbled, as the first and the last of a log often are, are left out and counted.
    Raises InputError.
    """
    capture = SerialCapture()
    try:
        for line in lines:
            capture.feed(line)
        take, bench = capture.take(1), capture.bench
    except ModelError as error:
        raise refusal(source, "head", str(error), REMEDY) from None
    if not take.streams:
        raise refusal(source, "whole file", "it holds no sample", REMEDY)
    return Reading(FORMAT, take.streams, take.marks, capture.warnings, bench=bench)
