"""The text of a capture microcontroller as takes: from a file at once, or from the board as it comes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import reduce
from operator import xor
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.recording.reading import Reading, counted, refusal, rising, unlike
from fdvv.recording.table import Title, read_title
from fdvv.recording.types import Bench, Mark, Quantity, Stage, Stream, Take
from fdvv.units import FloatArray

FORMAT, VERSION = "fdvv-capture", 1
TURN_us = 2**32
"""The board counts microseconds in 32 bits; the counter begins anew every 71.6 minutes."""
CLOCK = "board"
REMEDY = "compare with docs/reference/capture-serial.md"

_SAMPLE = re.compile(r"([A-Z]{1,8}) (\d{1,10})((?: -?\d{1,10}){1,8})\Z", re.ASCII)
_EVENT = re.compile(r"! (\d{1,10}) (\S.*)\Z", re.ASCII)
_SUMMED = re.compile(r"(.*)\*([0-9A-Fa-f]{2})\Z", re.ASCII)
_PAIR = re.compile(r"(\w+)=(\S+)", re.ASCII)


@dataclass
class SerialHead:
    """What the head says so far: the version, title, scale and zero of each channel, and the bench."""

    version: int | None = None
    titles: dict[str, tuple[str, float, float]] = field(default_factory=dict)
    bench: dict[str, float] = field(default_factory=dict)


@dataclass
class Body:
    """What the lines below it hold.

    Attributes
    ----------
    us : the board's counter at each line that bears a time.
    at, value : of each channel, places in us and counts.
    events : places in us and what happened.
    """

    us: list[int] = field(default_factory=list)
    at: dict[str, list[int]] = field(default_factory=dict)
    value: dict[str, list[int]] = field(default_factory=dict)
    events: list[tuple[int, str]] = field(default_factory=list)


def is_serial(head: Sequence[str]) -> bool:
    """Recognise such a text by its head, or by samples where the head was missed."""
    if any(line.startswith(f"# {FORMAT} ") for line in head):
        return True
    good = [line for line in head[1:] if _SAMPLE.match(line.partition("*")[0]) or _EVENT.match(line)]
    return len(good) >= max(3, 0.9 * (len(head) - 1))


def read_line(line: str, head: SerialHead, body: Body) -> bool:
    """Read a line into head or body; False if it is garbled."""
    summed = _SUMMED.match(line)
    if summed:
        if int(summed[2], 16) != checksum(summed[1]):
            return False
        line = summed[1].rstrip()
    if line.startswith("#"):
        return _read_head(head, line[1:].split())
    event = _EVENT.match(line)
    if event and int(event[1]) < TURN_us:
        body.events.append((len(body.us), event[2]))
        body.us.append(int(event[1]))
        return True
    return _read_sample(body, line)


def _read_sample(body: Body, line: str) -> bool:
    sample = _SAMPLE.match(line)
    if sample is None or int(sample[2]) >= TURN_us:
        return False
    values = [int(text) for text in sample[3].split()]
    if len(values) != len(sample[1]) or len(set(sample[1])) != len(values):
        return False
    for channel, value in zip(sample[1], values, strict=True):
        body.at.setdefault(channel, []).append(len(body.us))
        body.value.setdefault(channel, []).append(value)
    body.us.append(int(sample[2]))
    return True


def checksum(text: str) -> int:
    """Return the exclusive or of all bytes, as NMEA 0183 does."""
    return reduce(xor, text.encode(), 0)


def _read_head(head: SerialHead, words: Sequence[str]) -> bool:
    pairs: dict[str, float] = {}
    for word in words:
        pair = _PAIR.fullmatch(word)
        try:
            pairs |= {pair[1]: float(pair[2])} if pair else {}
        except ValueError:
            return words[:1] not in (["channel"], ["bench"])
    if words[:1] == [FORMAT] and len(words) > 1:
        # a repeated line that differs was garbled on its way
        if not words[1].isdecimal() or head.version not in (None, int(words[1])):
            return False
        head.version = int(words[1])
    elif words[:1] == ["channel"] and len(words) > 2 and re.fullmatch("[A-Z]", words[1]):
        scale, zero = pairs.get("scale", 1.0), pairs.get("zero", 0.0)
        if not (np.isfinite([scale, zero]).all() and scale):
            return False
        head.titles[words[1]] = (words[2], scale, zero)
    elif words[:1] == ["bench"]:
        known = {f.name for f in fields(Bench)} - {"clocks_go_on"}
        head.bench |= {key: value for key, value in pairs.items() if key in known}
    return True


class SerialCapture:
    """What a capture board writes, cut into takes while it goes on; its clock runs through all of them.

    Attributes
    ----------
    warnings : what could not be read or is not known, so far.
    """

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self._head, self._body = SerialHead(), Body()
        self._lines = 0
        self._garbled: list[int] = []
        self._last: tuple[int, float] | None = None

    def feed(self, line: str) -> bool:
        """Read a line; False if it is garbled, which is counted. ModelError on a newer version."""
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
        """Return the bench that the head describes. Raises ModelError."""
        numbers: dict[str, Any] = self._head.bench
        return Bench(**numbers)

    def take(
        self, number: int, stage: Stage = Stage.UNKNOWN, velocity_mm_s: float | None = None, made: str = ""
    ) -> Take:
        """Return what came since the last take: channels as streams, events as marks.

        Seconds count from the first line that bore a time. A line that has not come whole belongs to no take.
        """
        body, self._body = self._body, Body()
        t_s = self._seconds(np.array(body.us, dtype=np.int64))
        self._tell()
        streams = unlike(self._stream(body, channel, t_s) for channel in body.at)
        marks = tuple(Mark(name, CLOCK, float(t_s[at])) for at, name in body.events)
        return Take(number, streams, marks, stage, velocity_mm_s, made)

    def _seconds(self, us: npt.NDArray[np.int64]) -> FloatArray:
        """Return seconds since the first time, with the counter's overflow unwrapped."""
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
        parsed = read_title(title) if title else None
        if parsed is None or not parsed.unit_is_known:
            if self._head.version is not None:
                why = f"is called {title!r:.30}, which names no unit" if title else "is not in the head"
                self._say(f"channel {channel} {why}; its numbers are kept as counts")
            parsed, scale, zero = Title(title or channel, Quantity.COUNTS, 1.0), 1.0, 0.0
        # what a file would hold in eight bytes mostly fits in four
        small = raw.astype(np.int32) if np.abs(raw).max(initial=0) < 2**31 else raw
        name = f"{parsed.name}_{parsed.axis}" if parsed.axis else parsed.name
        quantity = Quantity.DISPLACEMENT if parsed.axis else parsed.quantity
        return Stream(name, quantity, CLOCK, t_s[at][keep], small[keep], scale * parsed.scale, zero)


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
