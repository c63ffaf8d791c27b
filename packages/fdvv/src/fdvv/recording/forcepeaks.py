"""Serial logs of the ForcePeaks experiment: beats, taps, and force in counts after each tap.

``S n ms`` is a beat, ``R n ms`` a tap, ``V i adc`` a sample; the samples of all taps run together. What
their times are follows from the experiment's published program (an Arduino Mega), and where force begins in
the logs bears it out: it samples once per change of its millisecond counter, every 1.024 ms, for 100 ms after
each tap, from the sixth beat on; behind the samples of each tap, of earlier ones too, it counts one that it
never takes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.recording.reading import Reading, counted_warning, refusal
from fdvv.recording.types import Mark, Quantity, Stream
from fdvv.units import FloatArray

CLOCK, LOOSE_CLOCK = "board", "samples"
MARKS = {"S": "beat", "R": "tap"}
STEP_s = 1.024e-3
"""The board's millisecond counter advances once every 1024 µs."""
WINDOW_s = 0.1  # for so long the published program samples after a tap
FIRST_BEAT = 5  # it samples from the sixth beat on; beats are numbered from 0

_LINE = re.compile(r"([SRV]) (\d{1,9}) (\d{1,10})\s*\Z", re.ASCII)
Counts = npt.NDArray[np.int16]


def is_forcepeaks(head: Sequence[str]) -> bool:
    """Recognise such a log by lines that all begin with S, R or V, numbered one after another."""
    found = [_LINE.match(line) for line in head[1:]]
    whole = [match for match in found if match]
    beats = [int(match[2]) for match in whole if match[1] == "S"]
    steady = all(later == one + 1 for one, later in pairwise(beats))
    return len(whole) >= max(3, 0.9 * len(found)) and steady and any(beats)


def read_forcepeaks(source: Path, lines: Sequence[str]) -> Reading:
    """Read beats and taps as marks, force as counts. Raises InputError."""
    found = [_LINE.match(line) for line in lines if line.strip() and line.strip() != "E"]
    rows: dict[str, list[tuple[int, int]]] = {"S": [], "R": [], "V": []}
    for match in found:
        if match:
            rows[match[1]].append((int(match[2]), int(match[3])))
    warnings = counted_warning(found.count(None), "line", "garbled and left out")
    if not rows["S"]:
        raise refusal(source, "whole file", "it holds no beat")
    marks = [Mark(name, CLOCK, ms / 1000) for letter, name in MARKS.items() for _, ms in rows[letter]]
    streams, notes = _force(rows)
    return Reading("forcepeaks", streams, marks, [*warnings, *notes])


def _force(rows: dict[str, list[tuple[int, int]]]) -> tuple[list[Stream], list[str]]:
    if not rows["V"]:
        return [], ["the log holds no force; the taps, if any, came before the sixth beat"]
    counts = np.array([value for _, value in rows["V"]], dtype=np.int64)
    scale = "force is in counts of a converter whose scale nobody stated"
    if counts.max() > np.iinfo(np.int16).max or [i for i, _ in rows["V"]] != list(range(counts.size)):
        return [_loose(counts)], [scale, "samples are missing or garbled; their clock knows no pauses"]
    raw = counts.astype(np.int16)
    taps_s = np.array([ms for _, ms in rows["R"]]) / 1000
    sixth_s = next((ms / 1000 for number, ms in rows["S"] if number == FIRST_BEAT), np.inf)
    placed = _placed(raw, taps_s, sixth_s)
    if placed is None:
        why = "the samples do not fit the taps and run together; their clock knows no pauses"
        return [_loose(raw)], [scale, why]
    starts, lengths = placed
    if not starts.size:
        return [], [scale, "the log holds no sample: no tap came after the sixth beat"]
    picks = np.concatenate([np.arange(at, at + n) for at, n in zip(starts, lengths, strict=True)])
    begun_s = np.maximum(taps_s[-starts.size :], sixth_s)
    steps: FloatArray = np.concatenate([STEP_s * np.arange(n) for n in lengths])
    t_s: FloatArray = np.repeat(begun_s, lengths) + steps
    how = "times of samples are not in the log: they are counted from their tap, one each 1.024 ms"
    return [Stream("force", Quantity.COUNTS, CLOCK, t_s, raw[picks])], [scale, how]


def _loose(raw: npt.NDArray[Any]) -> Stream:
    t_s = STEP_s * np.arange(raw.size, dtype=np.float64)
    return Stream("force", Quantity.COUNTS, LOOSE_CLOCK, t_s, raw)


def _placed(
    raw: Counts, taps_s: FloatArray, sixth_s: float
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]] | None:
    ends_s = taps_s + WINDOW_s
    early = int(np.sum(ends_s <= sixth_s))
    at, starts, lengths = early, [], []
    if raw[:early].any():
        return None
    windows_s = (ends_s - np.maximum(taps_s, sixth_s))[early:]
    for left, window_s in zip(range(windows_s.size, 0, -1), windows_s, strict=True):
        taken = _taken(raw, at, window_s / STEP_s + 1, left == 1)
        if taken is None:
            return None
        starts.append(at)
        # the last tap may be broken off by the end of the trial, before the sample that is never taken
        lengths.append(taken - 1 if left > 1 or not raw[at + taken - 1] else taken)
        at += taken
    return (np.array(starts, np.int64), np.array(lengths, np.int64)) if at == raw.size else None


def _taken(raw: Counts, at: int, expected: float, last: bool) -> int | None:
    """Count the samples of one tap and the one never taken: behind that the next tap begins with force."""
    if last:
        return raw.size - at if 0 < raw.size - at <= expected + 2 else None
    lengths = sorted(range(max(1, int(expected) - 1), int(expected) + 3), key=lambda n: abs(n - expected))
    fits = (n for n in lengths if at + n < raw.size and not raw[at + n - 1] and raw[at + n])
    return next(fits, None)
