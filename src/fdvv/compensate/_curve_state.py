"""What a law of one curve knows while it learns, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Best:
    """The press of a round whose command came closest, as the rig measured it."""

    error_cN: float
    mean_error_cN: float
    max_error_cN: float
    command_cN: FloatArray


@dataclass(frozen=True, eq=False)
class State:
    """What the law knows about one curve.

    Attributes
    ----------
    grid_mm, target_cN, command_cN : (n,) bins, the force wanted, the table to press next.
    limit_cN : bound on the size of a command.
    errors_cN : error_k of every press so far, all rounds.
    best : of the round that runs; None before its first press.
    rounds : the best of every finished round.
    """

    grid_mm: FloatArray
    target_cN: FloatArray
    command_cN: FloatArray
    limit_cN: float
    errors_cN: tuple[float, ...] = ()
    best: Best | None = None
    rounds: tuple[Best, ...] = ()


@dataclass(frozen=True, eq=False)
class Learned:
    """What came of one curve.

    Attributes
    ----------
    command_cN : (n,) the table to render with.
    errors_cN : error_k of every press, as the rig measured it while it learned.
    mean_error_cN, max_error_cN : of the best press of each round, averaged over the rounds. Picked for
        being small and measured by the rig's own lagging sensors: the probe tells the truth.
    sentence : how it went.
    """

    command_cN: FloatArray
    errors_cN: tuple[float, ...]
    mean_error_cN: float
    max_error_cN: float
    sentence: str


def better(state: State, measured_cN: FloatArray, error: float) -> Best:
    """Keep the round's best command; a worse press never replaces it."""
    if state.best is not None and state.best.error_cN <= error:
        return state.best
    deviation = np.abs(state.target_cN - measured_cN)
    return Best(error, float(np.nanmean(deviation)), float(np.nanmax(deviation)), state.command_cN)


def frozen(values: FloatArray) -> FloatArray:
    """Copy an array and lock it."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
