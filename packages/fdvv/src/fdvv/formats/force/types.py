"""What a file of force curves holds once it is read: cycles of press and release, and what was repaired."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy.typing as npt

from fdvv.force_text import force_text
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Cycle:
    """One press with its release, either of which a source may lack.

    Attributes
    ----------
    press, release : as measured, in the file's own displacement (mm) and force converted to cN.
    actuation_mm, reset_mm : where the electrical contact closed and opened, in the same displacement;
        None if the file does not state it or the contact chattered.
    label : how the file names it ("Press 3", "run 1").
    stated : whether the file states the velocity; else it was measured, or is unknown.
    """

    press: MeasuredCurve | None
    release: MeasuredCurve | None
    actuation_mm: float | None = None
    reset_mm: float | None = None
    label: str = ""
    stated: bool = False

    def of(self, stroke: Stroke) -> MeasuredCurve | None:
        return self.press if stroke is Stroke.PRESS else self.release


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


@dataclass(frozen=True, eq=False)
class Track:
    """Samples on one clock: a whole run (press, then release) or one stroke.

    Attributes
    ----------
    where : how messages name it ("run", "Press 3").
    x_mm, force_cN : (n,) in the order of the file.
    time_s, closed : (n,) if the file has them; closed is 1 while the electrical contact is made.
    """

    where: str
    x_mm: FloatArray
    force_cN: FloatArray
    time_s: FloatArray | None = None
    closed: FloatArray | None = None

    def take(self, pick: npt.NDArray[Any] | slice) -> Track:
        """Keep the samples that a mask, an index array or a slice picks."""
        return replace(
            self,
            x_mm=self.x_mm[pick],
            force_cN=self.force_cN[pick],
            time_s=None if self.time_s is None else self.time_s[pick],
            closed=None if self.closed is None else self.closed[pick],
        )


@dataclass(frozen=True, eq=False)
class RawCycle:
    """One cycle as a reader found it: either a whole run, or a press, a release or both."""

    label: str
    run: Track | None = None
    press: Track | None = None
    release: Track | None = None
    actuation_mm: float | None = None
    reset_mm: float | None = None
    velocity_mm_s: float | None = None

    def map(self, change: Callable[[Track], Track | None]) -> RawCycle:
        """Change every track that there is; None leaves it out."""
        run, press, release = (track and change(track) for track in (self.run, self.press, self.release))
        return replace(self, run=run, press=press, release=release)


def pair_up(mine: Sequence[RawCycle], theirs: Sequence[RawCycle]) -> list[RawCycle]:
    """Join presses and releases of the same velocity; others stay single."""
    rest = list(theirs)
    joined = []
    for cycle in mine:
        match = next((other for other in rest if _belong_together(cycle, other)), None)
        if match is not None:
            rest.remove(match)
            cycle = replace(cycle, press=cycle.press or match.press, release=cycle.release or match.release)
        joined.append(cycle)
    return joined + rest


def _belong_together(a: RawCycle, b: RawCycle) -> bool:
    both = (a.press is None) != (b.press is None) and (a.release is None) != (b.release is None)
    return both and a.velocity_mm_s == b.velocity_mm_s


@dataclass(frozen=True, eq=False)
class Reading:
    format: str
    name: str
    cycles: Sequence[RawCycle]


@dataclass
class Notes:
    """Collects what was repaired: single sentences, and tallies that become one sentence each."""

    sentences: list[str] = field(default_factory=list)
    tallies: dict[str, list[tuple[str, float]]] = field(default_factory=dict)

    def say(self, sentence: str) -> None:
        if sentence not in self.sentences:
            self.sentences.append(sentence)

    def tally(self, template: str, where: str, amount: float) -> None:
        """Count one more place; ``template`` has {places}, and the greatest amount as {most} or {force}."""
        self.tallies.setdefault(template, []).append((where, amount))

    def lines(self) -> tuple[str, ...]:
        """Return every sentence, tallies last."""
        counted = [
            template.format(
                places=", ".join(dict.fromkeys(where for where, _ in found)),
                most=max(amount for _, amount in found),
                force=force_text(max(amount for _, amount in found), ".1f"),
            )
            for template, found in self.tallies.items()
        ]
        return (*self.sentences, *counted)
