"""What one press teaches about a table: the force felt, placed where the table can change it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._bins import bin_force
from fdvv.compensate._strokes import Span
from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Delays:
    """Known delays of a rig.

    The force sensed at time t was felt where the cap will be sensed ``position_s`` later, and was
    commanded from the table where the cap was sensed ``command_s`` earlier. 0 for both is the paper's
    law: a force is held against the target, and corrected, at the displacement sensed with it.
    """

    position_s: float = 0.0
    command_s: float = 0.0

    def __post_init__(self) -> None:
        if not (abs(self.position_s) < 0.1 and abs(self.command_s) < 0.1):
            raise ModelError(f"delays must be less than 0.1 s, got {self}")


def felt_at_mm(t_s: FloatArray, sensed_mm: FloatArray, delays: Delays) -> FloatArray:
    """Estimate where the cap truly was when each force was felt, (n,)."""
    return np.interp(t_s + delays.position_s, t_s, sensed_mm) if delays.position_s else sensed_mm


def observe(
    t_s: FloatArray,
    sensed_mm: FloatArray,
    force_cN: FloatArray,
    span: Span,
    target_cN: FloatArray,
    grid_mm: FloatArray,
    delays: Delays,
) -> FloatArray:
    """Place the force felt during one stroke on the bins of its table: (n,), NaN where it says nothing.

    t_s, sensed_mm, force_cN : (m,) the whole press as the rig recorded it; span the rows of the stroke.
    Without delays this is ``bin_force``. With them each sample's shortfall is taken at the displacement
    where it was felt and filed under the displacement that commanded it; target minus the result is then
    the mean shortfall of each bin.
    """
    rows = span.rows
    if delays == Delays():
        return bin_force(sensed_mm[rows], force_cN[rows], grid_mm)
    felt = felt_at_mm(t_s, sensed_mm, delays)[rows]
    commanded = np.interp(t_s[rows] - delays.command_s, t_s, sensed_mm)
    shortfall = np.interp(felt, grid_mm, target_cN) - force_cN[rows]
    return target_cN - bin_force(commanded, shortfall, grid_mm)
