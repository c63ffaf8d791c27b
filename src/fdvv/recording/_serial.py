"""The text that a capture microcontroller writes; docs/reference/capture-serial.md defines it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording._reading import Reading, counted, refusal, rising, unlike
from fdvv.recording._titles import Title, read_title
from fdvv.recording._types import Bench, Mark, Quantity, Stream
from fdvv.units import FloatArray

CLOCK = "board"
FORMAT, VERSION = "fdvv-capture", 1
TURN_us = 2**32
"""The board counts microseconds in 32 bits; the counter begins anew every 71.6 minutes."""
REMEDY = "compare with docs/reference/capture-serial.md"

_SAMPLE = re.compile(r"([A-Z]{1,8}) (\d{1,10})((?: -?\d{1,10}){1,8})\Z", re.ASCII)
_EVENT = re.compile(r"! (\d{1,10}) (\S.*)\Z", re.ASCII)
_PAIR = re.compile(r"(\w+)=(\S+)", re.ASCII)


@dataclass
class Found:
    """What the lines hold so far.

    Attributes
    ----------
    at, value : of each channel, line numbers of its samples and the samples themselves.
    us : the board's counter at each line that bears a time, and events with their place among these.
    """

    version: int | None = None
    titles: dict[str, tuple[str, float, float]] = field(default_factory=dict)
    bench: dict[str, Any] = field(default_factory=dict)
    us: list[int] = field(default_factory=list)
    at: dict[str, list[int]] = field(default_factory=dict)
    value: dict[str, list[int]] = field(default_factory=dict)
    events: list[tuple[int, str]] = field(default_factory=list)
    garbled: list[int] = field(default_factory=list)


def is_serial(head: Sequence[str]) -> bool:
    """Tell such a text by its head, or by samples where the head was missed."""
    if any(line.startswith(f"# {FORMAT} ") for line in head):
        return True
    good = [line for line in head[1:] if _SAMPLE.match(line.partition("*")[0]) or _EVENT.match(line)]
    return len(good) >= max(3, 0.9 * (len(head) - 1))


def read_serial(source: Path, lines: Sequence[str]) -> Reading:
    """Read channels as streams and events as marks, all on the board's clock, 0 at the first line's time.

    Lines that are garbled, as the first and the last of a log often are, are left out and counted.
    Raises InputError.
    """
    found = Found()
    for index, line in enumerate(lines):
        if line.strip() and not _line(found, line.strip()):
            found.garbled.append(index + 1)
    if found.version not in (None, VERSION):
        reason = f"version {found.version} of {FORMAT}, this fdvv reads version {VERSION}"
        raise refusal(source, "line 1", reason, "install a newer fdvv")
    if not found.at:
        raise refusal(source, "whole file", "it holds no sample", REMEDY)
    warnings = _told(found)
    t_s = _unrolled_s(np.array(found.us, dtype=np.int64))
    streams = [_stream(found, channel, t_s, warnings) for channel in found.at]
    marks = [Mark(name, CLOCK, float(t_s[at])) for at, name in found.events]
    try:
        bench = Bench(**found.bench)
    except ModelError as error:
        raise refusal(source, "# bench", str(error), REMEDY) from None
    return Reading(FORMAT, unlike(streams), marks, warnings, bench=bench)


def _line(found: Found, line: str) -> bool:
    """Read a line; False if it is garbled."""
    body, star, told = line.rpartition("*")
    if star and not line.startswith("#"):
        if told.lower() != f"{_checksum(body):02x}":
            return False
        line = body.rstrip()
    if line.startswith("#"):
        return _head(found, line[1:].split())
    event = _EVENT.match(line)
    if event and int(event[1]) < TURN_us:
        found.events.append((len(found.us), event[2]))
        found.us.append(int(event[1]))
        return True
    sample = _SAMPLE.match(line)
    if sample is None or int(sample[2]) >= TURN_us:
        return False
    values = [int(text) for text in sample[3].split()]
    if len(values) != len(sample[1]) or len(set(sample[1])) != len(values):
        return False
    for channel, value in zip(sample[1], values, strict=True):
        found.at.setdefault(channel, []).append(len(found.us))
        found.value.setdefault(channel, []).append(value)
    found.us.append(int(sample[2]))
    return True


def _checksum(text: str) -> int:
    """Give the exclusive or of all bytes, as NMEA 0183 does."""
    sum_ = 0
    for byte in text.encode():
        sum_ ^= byte
    return sum_


def _head(found: Found, words: Sequence[str]) -> bool:
    """Read a line of the head; one that is not known is a remark of the board."""
    pairs: dict[str, float] = {}
    for word in words:
        pair = _PAIR.fullmatch(word)
        try:
            pairs |= {pair[1]: float(pair[2])} if pair else {}
        except ValueError:
            return False
    if words[:1] == [FORMAT] and len(words) > 1:
        found.version = int(words[1]) if words[1].isdigit() else -1
    elif words[:1] == ["channel"] and len(words) > 2 and re.fullmatch("[A-Z]", words[1]):
        scale, zero = pairs.get("scale", 1.0), pairs.get("zero", 0.0)
        if not (np.isfinite([scale, zero]).all() and scale):
            return False
        found.titles[words[1]] = (words[2], scale, zero)
    elif words[:1] == ["bench"]:
        known = {f.name for f in fields(Bench)} - {"clocks_go_on"}
        found.bench |= {key: value for key, value in pairs.items() if key in known}
    return True


def _told(found: Found) -> list[str]:
    warnings = []
    if found.version is None:
        warnings.append("the head was missed; channels without one are kept as counts")
    if found.garbled:
        first = f"line {found.garbled[0]}"
        told = first if len(found.garbled) == 1 else f"{len(found.garbled)} lines, {first} the first,"
        warnings.append(f"{told} garbled and left out")
    return warnings


def _unrolled_s(us: np.ndarray[Any, np.dtype[np.int64]]) -> FloatArray:
    """Give seconds since the first time; a step is the shorter way round the counter's turn."""
    half = TURN_us // 2
    steps = (np.diff(us) + half) % TURN_us - half
    seconds: FloatArray = np.concatenate([[0], np.cumsum(steps)]) * 1e-6
    return seconds


def _stream(found: Found, channel: str, t_s: FloatArray, warnings: list[str]) -> Stream:
    at, raw = np.array(found.at[channel]), np.array(found.value[channel], dtype=np.int64)
    keep = rising(t_s[at])
    if not keep.all():
        dropped = int(keep.size - keep.sum())
        warnings.append(f"channel {channel}: {counted(dropped, 'sample')} left out: the times do not rise")
    title, scale, zero = found.titles.get(channel, ("", 1.0, 0.0))
    told = read_title(title) if title else None
    if told is None or not told.unit_is_known:
        if found.version is not None:
            why = f"is called {title!r:.30}, which names no unit" if title else "is not in the head"
            warnings.append(f"channel {channel} {why}; its numbers are kept as counts")
        told, scale, zero = Title(title or channel, Quantity.COUNTS, 1.0), 1.0, 0.0
    fits = np.abs(raw).max(initial=0) < 2**31
    raw = raw.astype(np.int32) if fits else raw
    name = f"{told.name}_{told.axis}" if told.axis else told.name
    quantity = Quantity.DISPLACEMENT if told.axis else told.quantity
    return Stream(name, quantity, CLOCK, t_s[at][keep], raw[keep], scale * told.scale, zero)
