"""Scores of a study as one complete array: people first, then the factors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray

FEWEST = 3
"""People below which nothing is tested: with two, one difference is all that is known of the spread."""


def complete_scores(scores: npt.ArrayLike, axes: Sequence[str]) -> FloatArray:
    """Check scores with one axis per name, people first, and give them as an array.

    Repeated measures have no answer for a missing cell: the person must be left out or measured again. Raises
    ModelError that names the first cell without a finite score; also on an axis too many or too few, too few
    people and a factor of one level.
    """
    found = np.asarray(scores, dtype=np.float64)
    if found.ndim != len(axes):
        raise ModelError(f"scores need the axes {', '.join(axes)}, got the shape {found.shape}")
    if found.shape[0] < FEWEST:
        raise ModelError(f"repeated measures need at least {FEWEST} people, got {found.shape[0]}")
    for name, size in zip(axes[1:], found.shape[1:], strict=True):
        if size < 2:
            raise ModelError(f"the factor {name} needs at least 2 levels, got {size}")
    missing = np.argwhere(~np.isfinite(found))
    if missing.size:
        cell = ", ".join(f"{name} {place + 1}" for name, place in zip(axes, missing[0], strict=True))
        raise ModelError(
            f"{len(missing)} of {found.size} scores are missing, the first at {cell} (counted from 1); "
            "measure it, or leave that person out"
        )
    return found


def averaged_rounds(observations: npt.ArrayLike) -> FloatArray:
    """Average the last axis, the rounds of one person: people are counted, not their rounds."""
    return np.asarray(np.mean(np.asarray(observations, dtype=np.float64), axis=-1))


def rounds_as_people(observations: npt.ArrayLike) -> FloatArray:
    """Turn (people, ..., rounds) into (people * rounds, ...), as if every round were another person's.

    The paper's F(5, 95) counts so: 10 people of 2 rounds as 20. Rounds of one person are more alike than
    people are, so that p comes out too small; for comparison only.
    """
    found = np.moveaxis(np.asarray(observations, dtype=np.float64), -1, 1)
    return found.reshape(-1, *found.shape[2:])
