"""What a force curve says of the snap before anybody listens: where it must lie and what it sets free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model import find_bump

mJ_PER_cN_mm = 0.01
"""1 cN mm = 10 mN x 1 mm = 0.01 mJ."""

BEFORE_ratio, AFTER_ratio = 0.25, 1.25
"""A leaf lands once the force has fallen, at the valley of a press or past it, and is struck past that of a
release; in lengths of the fall."""


@dataclass(frozen=True)
class SnapEnergy:
    """The fall of force that drives a snap.

    Attributes
    ----------
    drop_cN : from peak to valley.
    energy_mJ : set free between them, the area between the peak's force and the curve.
    peak_mm, valley_mm : where it falls.
    """

    drop_cN: float
    energy_mJ: float
    peak_mm: float
    valley_mm: float

    @property
    def window_mm(self) -> tuple[float, float]:
        """Where the snap is looked for: from a quarter of the fall before the valley to 1.25 past it."""
        length = self.valley_mm - self.peak_mm
        return self.valley_mm - BEFORE_ratio * length, self.valley_mm + AFTER_ratio * length


def snap_energy(
    displacement_mm: npt.ArrayLike, force_cN: npt.ArrayLike, least_drop_cN: float | None = None
) -> SnapEnergy | None:
    """Measure the energy that the fall of force sets free; None where it hardly falls.

    displacement_mm, force_cN : (n,) one stroke, displacement strictly rising (turn a release round), contact
        and stop left out.
    least_drop_cN : a smaller fall is friction; that of a bump (find_bump) if None.

    A finger that keeps pressing with the force of the peak gains what the button no longer takes: the area
    between the peak's force and the curve from peak to valley, in mJ.
    """
    x, force = (np.asarray(v, dtype=np.float64) for v in (displacement_mm, force_cN))
    if x.shape != force.shape or x.ndim != 1 or x.size < 3 or np.any(np.diff(x) <= 0):
        raise ModelError(
            f"a stroke needs forces at 3 or more rising displacements, got {x.shape}, {force.shape}"
        )
    bump = find_bump(x, force) if least_drop_cN is None else find_bump(x, force, least_drop_cN)
    if bump is None:
        return None
    fall = (x >= bump.peak_mm) & (x <= bump.valley_mm)
    given = np.trapezoid(bump.peak_cN - force[fall], x[fall]) * mJ_PER_cN_mm
    return SnapEnergy(bump.drop_cN, max(float(given), 0.0), bump.peak_mm, bump.valley_mm)
