"""How much of a rendering a finger would notice, in just noticeable differences (fdvv.model.noticeable)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fdvv.units import FloatArray


@dataclass(frozen=True)
class Noticed:
    """Errors in JNDs over the places of a stroke and over presses.

    Attributes
    ----------
    above_ratio : part of the stroke that is off by more than one JND.
    excess_JND : mean of what exceeds one JND; places below it count as 0.
    mean_JND, largest_JND : mean, and median over presses of the largest.
    """

    above_ratio: float
    excess_JND: float
    mean_JND: float
    largest_JND: float

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


def summarize(steps_JND: FloatArray) -> Noticed:
    """Sum up errors, (presses, n); all is 0 where there is no place."""
    if not steps_JND.size:
        return Noticed(0.0, 0.0, 0.0, 0.0)
    return Noticed(
        float((steps_JND > 1).mean()),
        float(np.clip(steps_JND - 1, 0.0, None).mean()),
        float(steps_JND.mean()),
        float(np.median(steps_JND.max(axis=1))),
    )


def overall(curves: Sequence[Noticed]) -> Noticed:
    """Return the mean over curves, each of the same weight."""
    rows = np.array([list(asdict(curve).values()) for curve in curves])
    return Noticed(*(float(value) for value in rows.mean(axis=0)))
