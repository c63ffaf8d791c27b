"""Modes that a housing rings in at every pace, and rings told again with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.units import FloatArray
from fdvv.vibration._pool import MeasuredVibration, SAME_ratio, known_rings
from fdvv.vibration._ring import Ring, refit_ring
from fdvv.vibration._snap import NotFound

FLOOR_ratio = (0.005, 0.02)
"""No frequency and no decay of one pace is weighed as known better: drives are in no standard error."""


@dataclass(frozen=True)
class SharedMode:
    """A mode of the housing as several paces tell it: weighted medians and their standard errors."""

    frequency_Hz: float
    decay_1_s: float
    frequency_sd_Hz: float
    decay_sd_1_s: float
    paces: int


def shared_mode(rings: Sequence[Ring]) -> SharedMode | None:
    """Give the principal mode that rings of one housing share; None if fewer than two tell the same.

    What frequency and decay a plate rings at does not depend on how fast a finger presses; what a drive that
    goes on does to them does. The weighted median over paces is not moved by one of them.
    """
    modes = [ring.mode for ring in rings]
    if len(modes) < 2:
        return None
    middle, _ = _middle([m.frequency_Hz for m in modes], [m.frequency_sd_Hz for m in modes], FLOOR_ratio[0])
    modes = [m for m in modes if abs(m.frequency_Hz / middle - 1) <= SAME_ratio]
    if len(modes) < 2:
        return None
    f, f_sd = _middle([m.frequency_Hz for m in modes], [m.frequency_sd_Hz for m in modes], FLOOR_ratio[0])
    d, d_sd = _middle([m.decay_1_s for m in modes], [m.decay_sd_1_s for m in modes], FLOOR_ratio[1])
    return SharedMode(f, d, f_sd, d_sd, len(modes))


def shared_rings(rings: Sequence[Ring]) -> tuple[tuple[float, float], ...]:
    """Give frequency and decay of two modes at most that searches of all paces can build on.

    The principal one that is known best, and of the others that most rings tell of.
    """
    told = [known_rings(ring) for ring in rings]
    first = [
        (ring.mode.frequency_sd_Hz / ring.mode.frequency_Hz, t[0])
        for ring, t in zip(rings, told, strict=True)
        if t
    ]
    if not first:
        return ()
    others = [mode for t in told for mode in t[1:]]
    votes = [sum(abs(other[0] / mode[0] - 1) <= SAME_ratio for other in others) for mode in others]
    second = others[int(np.argmax(votes))] if others else None
    return (min(first)[1], second) if second else (min(first)[1],)


def with_shared(found: MeasuredVibration, mode: SharedMode) -> MeasuredVibration:
    """Tell a ring again with the principal mode that the paces share: its amplitudes, and the other modes.

    As it was where its own is another mode, or where what the shared one leaves is no longer noise.
    """
    ring = found.ring
    if isinstance(ring, NotFound) or abs(ring.mode.frequency_Hz / mode.frequency_Hz - 1) > SAME_ratio:
        return found
    again = refit_ring(found.heard, found.snaps, (mode.frequency_Hz, mode.decay_1_s))
    if again is None:
        return found
    first = replace(
        again.mode,
        frequency_sd_Hz=mode.frequency_sd_Hz,
        decay_sd_1_s=mode.decay_sd_1_s,
        frequency_spread_Hz=ring.mode.frequency_spread_Hz,
        decay_spread_1_s=ring.mode.decay_spread_1_s,
    )
    return replace(found, ring=replace(again, mode=first, modes=(first, *again.modes[1:])))


def _middle(values: Sequence[float], sds: Sequence[float], floor_ratio: float) -> tuple[float, float]:
    """Give the weighted median of values and its standard error, from the errors or from the scatter."""
    order = np.argsort(values)
    value: FloatArray = np.asarray(values, dtype=np.float64)[order]
    sd = np.maximum(np.asarray(sds, dtype=np.float64)[order], floor_ratio * np.median(value))
    weight = 1 / sd**2
    share = (np.cumsum(weight) - 0.5 * weight) / weight.sum()
    middle = float(np.interp(0.5, share, value))
    scatter = float(np.sqrt(np.sum(weight * (value - middle) ** 2) / weight.sum() / (value.size - 1)))
    return middle, max(scatter, float(weight.sum() ** -0.5))
