"""Lines that a capture microcontroller writes, one by one; docs/reference/capture-serial.md defines them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, fields

import numpy as np

from fdvv.recording._types import Bench

FORMAT, VERSION = "fdvv-capture", 1
TURN_us = 2**32
"""The board counts microseconds in 32 bits; the counter begins anew every 71.6 minutes."""

_SAMPLE = re.compile(r"([A-Z]{1,8}) (\d{1,10})((?: -?\d{1,10}){1,8})\Z", re.ASCII)
_EVENT = re.compile(r"! (\d{1,10}) (\S.*)\Z", re.ASCII)
_SUMMED = re.compile(r"(.*)\*([0-9A-Fa-f]{2})\Z", re.ASCII)
_PAIR = re.compile(r"(\w+)=(\S+)", re.ASCII)


@dataclass
class Head:
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
    """Tell such a text by its head, or by samples where the head was missed."""
    if any(line.startswith(f"# {FORMAT} ") for line in head):
        return True
    good = [line for line in head[1:] if _SAMPLE.match(line.partition("*")[0]) or _EVENT.match(line)]
    return len(good) >= max(3, 0.9 * (len(head) - 1))


def read_line(line: str, head: Head, body: Body) -> bool:
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
    """Give the exclusive or of all bytes, as NMEA 0183 does."""
    found = 0
    for byte in text.encode():
        found ^= byte
    return found


def _read_head(head: Head, words: Sequence[str]) -> bool:
    """Read a line of the head; one that is not known is a remark of the board."""
    pairs: dict[str, float] = {}
    for word in words:
        pair = _PAIR.fullmatch(word)
        try:
            pairs |= {pair[1]: float(pair[2])} if pair else {}
        except ValueError:
            return words[:1] not in (["channel"], ["bench"])
    if words[:1] == [FORMAT] and len(words) > 1:
        # one that is told again and differs did not come through whole
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
