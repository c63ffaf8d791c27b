"""How a stroke would have gone, had the finger felt the right force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._felt import Pass
from fdvv.errors import ModelError
from fdvv.units import FloatArray

LONGEST_STEP_s = 2.5e-4


@dataclass(frozen=True)
class FingerJoint:
    """A finger about its joint as mass, spring and damper: any finger, not the one that presses.

    The middle of the ranges of Hajian and Howe (1997, as recalled), with the sensor it wears. It need not be
    right: with it half as heavy or twice, learning is slower, not wrong.
    """

    mass_g: float = 8.0
    damping_N_s_m: float = 5.5
    stiffness_N_m: float = 600.0

    def __post_init__(self) -> None:
        if not (self.mass_g > 0 and self.damping_N_s_m >= 0 and self.stiffness_N_m >= 0):
            raise ModelError(f"a finger needs a mass above 0, and no numbers below 0, got {self}")


def foresee(
    stroke: Pass, target_cN: FloatArray, grid_mm: FloatArray, finger: FingerJoint
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give by how much place (mm), speed (mm/s) and acceleration (m/s2) change, (n,) as the stroke's rows.

    A finger that feels less than before goes on faster, and the cap with it; so a command that takes away
    inertia brings more inertia. The change q obeys

        m q'' + b q' + k q = felt - target(x + q)

    target_cN, grid_mm : (g,) the force wanted.
    """
    # unit forces: cN over mm, so 1 N s/m is 0.1 cN s/mm and 1 g is 1e-4 cN s2/mm
    mass, damping, stiffness = (
        1e-4 * finger.mass_g,
        0.1 * finger.damping_N_s_m,
        0.1 * finger.stiffness_N_m,
    )
    parts = max(1, round(stroke.tick_s / LONGEST_STEP_s))
    step = stroke.tick_s / parts
    slope = np.gradient(target_cN, grid_mm)
    excess = (stroke.felt_cN - np.interp(stroke.displacement_mm, grid_mm, target_cN)).tolist()
    softer = (stiffness + np.interp(stroke.displacement_mm, grid_mm, slope)).tolist()
    rows, q, w = [], 0.0, 0.0
    for push, spring in zip(excess, softer, strict=True):
        for _ in range(parts):
            w = (w + step * (push - spring * q) / mass) / (1.0 + step * damping / mass)
            q += step * w
        rows.append((q, w, (push - spring * q - damping * w) / mass))
    moved = np.array(rows).reshape(-1, 3)
    return moved[:, 0], moved[:, 1], moved[:, 2] / 1000.0
