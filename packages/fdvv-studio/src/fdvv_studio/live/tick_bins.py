"""Ticks of a device binned for a display: minimum and maximum of every pixel column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray

BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.int64]


class TickPiece(NamedTuple):
    """Some ticks in rising time, every column (n,).

    Attributes
    ----------
    t_s : on one clock through all pieces.
    displacement_mm, force_cN, commanded_cN : as the device has them; force as NaN where it has no sensor.
    state : of the program. cut : the command was cut, by a limit, its slew or heat. rendered : the device
        was armed; else a cap that nothing holds may sink.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    force_cN: FloatArray
    commanded_cN: FloatArray
    state: IntArray
    cut: BoolArray
    rendered: BoolArray


@dataclass(frozen=True, eq=False)
class TickBins:
    """Whole bins of time, every column (m,).

    Attributes
    ----------
    number : of the bin; it begins at number * bin_s. Bins without a tick are not among them.
    low, high : (3, m) of displacement, force and command.
    state : at the bin's last tick. cut : in any of them. ticks : how many.
    """

    number: IntArray
    low: FloatArray
    high: FloatArray
    state: IntArray
    cut: BoolArray
    ticks: IntArray


class TickBinner:
    """Collects pieces and returns complete bins: no peak is lost at any bin width.

    Parameters
    ----------
    bin_s : width of a bin, such as the time that one pixel column stands for.
    """

    def __init__(self, bin_s: float) -> None:
        if not bin_s > 0:
            raise ModelError(f"bin_s must be above 0, got {bin_s}")
        self.bin_s = bin_s
        self._kept: TickPiece | None = None

    def add(self, piece: TickPiece) -> TickBins:
        """Add a piece, later than all before; return the bins that are complete now."""
        pieces = (self._kept, piece) if self._kept else (piece,)
        whole = TickPiece(*(np.concatenate(columns) for columns in zip(*pieces, strict=True)))
        number = np.floor(whole.t_s / self.bin_s).astype(np.int64)
        # the last bin may go on in the next piece
        last = number == number[-1] if number.size else np.zeros(0, dtype=np.bool_)
        self._kept = TickPiece(*(column[last] for column in whole))
        return _bin(TickPiece(*(column[~last] for column in whole)), number[~last])


def _bin(piece: TickPiece, number: IntArray) -> TickBins:
    if not number.size:
        none = np.zeros(0, dtype=np.int64)
        return TickBins(none, np.zeros((3, 0)), np.zeros((3, 0)), none, np.zeros(0, dtype=np.bool_), none)
    starts = np.flatnonzero(np.diff(number, prepend=number[0] - 1))
    ends = np.append(starts[1:], number.size) - 1
    values = np.stack([piece.displacement_mm, piece.force_cN, piece.commanded_cN])
    return TickBins(
        number[starts],
        np.minimum.reduceat(values, starts, axis=1),
        np.maximum.reduceat(values, starts, axis=1),
        piece.state[ends],
        np.logical_or.reduceat(piece.cut, starts),
        ends - starts + 1,
    )
