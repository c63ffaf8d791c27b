"""What readers of log files return, and the checks they share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, count

import numpy as np
import numpy.typing as npt

from fdvv.errors import InputError
from fdvv.recording.types import Bench, Mark, Stream
from fdvv.units import FloatArray

REMEDY = "give one of the formats of docs/reference/log-files.md"
LARGEST = 1e15
"""No instrument counts further; what is larger is a fault."""


@dataclass(frozen=True, eq=False)
class Reading:
    format: str
    streams: Sequence[Stream]
    marks: Sequence[Mark] = ()
    warnings: Sequence[str] = ()
    made: str = ""
    remark: str = ""
    bench: Bench = field(default_factory=Bench)


def refusal(source: object, place: str, reason: str, remedy: str = REMEDY) -> InputError:
    return InputError(source, place, reason, remedy)


def number(text: str) -> float:
    """Read a cell as a number; NaN for a blank or text."""
    try:
        found = float(text) if "_" not in text else np.nan
    except ValueError:
        return np.nan
    return found if abs(found) < LARGEST else np.nan


def rising(t: FloatArray) -> npt.NDArray[np.bool_]:
    """Select the samples whose times rise strictly; of a single leap ahead only that sample is dropped."""
    keep = np.isfinite(t)
    at = np.flatnonzero(keep)
    falls = np.flatnonzero(np.diff(t[at]) < 0)
    leapt = falls[(falls > 0) & (t[at[falls + 1]] > t[at[falls - 1]])]
    keep[at[leapt]] = False
    at = np.flatnonzero(keep)
    if at.size:
        keep[at[1:]] = t[at[1:]] > np.maximum.accumulate(t[at])[:-1]
    return keep


def distinct(name: str, met: set[str]) -> str:
    """Return a name with a number behind it if it was met before, and add it to those met."""
    new = next(found for found in chain([name], (f"{name} {i}" for i in count(2))) if found not in met)
    met.add(new)
    return new


def unlike(streams: Iterable[Stream]) -> tuple[Stream, ...]:
    """Make the names of streams distinct by a number behind repeated ones."""
    met: set[str] = set()
    return tuple(replace(stream, name=distinct(stream.name, met)) for stream in streams)


def counted(number: int, noun: str) -> str:
    """Write a number of things: 1 line, 2 lines."""
    return f"{number} {noun if number == 1 else noun + 's'}"


def counted_warning(number: int, noun: str, fault: str) -> list[str]:
    """Return a warning of so many things; none if there are none."""
    return [f"{counted(number, noun)} {fault}"] if number else []
