"""What a file of force curves holds once it is read: cycles of press and release, and what was repaired."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.model import MeasuredCurve


@dataclass(frozen=True, eq=False)
class Cycle:
    """One press with its release, either of which a source may lack.

    Attributes
    ----------
    press, release : as measured, in the file's own displacement (mm) and force converted to cN.
    actuation_mm, reset_mm : where the electrical contact closed and opened, in the same displacement;
        None if the file does not tell or the contact chattered.
    label : how the file names it ("Press 3", "run 1").
    """

    press: MeasuredCurve | None
    release: MeasuredCurve | None
    actuation_mm: float | None = None
    reset_mm: float | None = None
    label: str = ""


@dataclass(frozen=True, eq=False)
class ForceFile:
    """Everything one file holds.

    Attributes
    ----------
    name : of the switch, from inside the file or from the file's name.
    format : which reader took it ("thereminGoat-tidy", "haata", "plain-csv" ...).
    cycles : at least one, in the file's order.
    warnings : one sentence per repair, with its place and what was done; empty if the file was clean.
    """

    name: str
    format: str
    cycles: tuple[Cycle, ...]
    warnings: tuple[str, ...] = ()
