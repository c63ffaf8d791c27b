"""What readers hand on: samples in the order of the file, in mm and cN, not yet split or repaired."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy.typing as npt

from fdvv.model import Stroke
from fdvv.units import FloatArray


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


@dataclass(frozen=True, eq=False)
class Reading:
    """Everything a reader found in one file."""

    format: str
    name: str
    cycles: Sequence[RawCycle]


@dataclass
class Notes:
    """Collects what was repaired: single sentences, and tallies that become one sentence each."""

    sentences: list[str] = field(default_factory=list)
    tallies: dict[str, list[tuple[str, float]]] = field(default_factory=dict)

    def say(self, sentence: str) -> None:
        """Add one sentence, once."""
        if sentence not in self.sentences:
            self.sentences.append(sentence)

    def tally(self, template: str, where: str, amount: float) -> None:
        """Count one more place; ``template`` has {places} and {most}, the greatest amount."""
        self.tallies.setdefault(template, []).append((where, amount))

    def lines(self) -> tuple[str, ...]:
        """Give every sentence, tallies last."""
        told = [
            template.format(
                places=", ".join(dict.fromkeys(where for where, _ in found)),
                most=max(amount for _, amount in found),
            )
            for template, found in self.tallies.items()
        ]
        return (*self.sentences, *told)


def stroke_name(stroke: Stroke, label: str) -> str:
    """Name one stroke of a cycle for messages."""
    return f"{stroke.value} of {label}" if label else stroke.value
