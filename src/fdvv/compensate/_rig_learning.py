"""One press on a known rig: what it felt like, what it tells about the tables, and the commands they make."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.compensate._bins import bin_force
from fdvv.compensate._error import error_cN
from fdvv.compensate._feed_forward import (
    LIFT_cN,
    command_cN,
    inertia_cN,
    unrepeatable_cN,
    wanted_cN,
)
from fdvv.compensate._felt import Pass
from fdvv.compensate._foresee import FingerJoint, foresee
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._method import Job
from fdvv.compensate._shared_table import SharedTable
from fdvv.compensate._strokes import FROM_mm, HOME_mm, STOP_GUARD_mm
from fdvv.compensate._tuning import Tuning
from fdvv.errors import ModelError
from fdvv.model import ForceSurface
from fdvv.units import FloatArray

Pair = tuple[SharedTable, SharedTable]
"""Press and release."""


@dataclass(frozen=True)
class Learning:
    """How presses enter the tables.

    Attributes
    ----------
    common_cN : spread of what all speeds share before anything is learned: calibration, weight, friction.
    alone_ratio : of the inertia expected at a speed, the spread of what one speed has for itself.
    fading : weight that is left of older presses, which were made on other tables.
    smoothing_mm, smoothing_s : sigma of a correction's smoothing, a length and, times speed, a time: what is
        shorter than the chain of sensors can tell is not learned.
    trust : part of the foreseen change of motion that counts, since the finger is a nominal one.
    finger : that finger.
    """

    common_cN: float = 4.0
    alone_ratio: float = 0.3
    fading: float = 0.7
    smoothing_mm: float = 0.06
    smoothing_s: float = 8e-4
    trust: float = 0.6
    finger: FingerJoint = field(default_factory=FingerJoint)

    def __post_init__(self) -> None:
        parts = (self.fading, self.trust, self.alone_ratio)
        if not (all(0 <= part <= 1 for part in parts) and self.fading > 0 and self.common_cN > 0):
            raise ModelError(f"ratios must be in 0..1, fading and common_cN above 0, got {self}")
        if not (self.smoothing_mm >= 0 and self.smoothing_s >= 0):
            raise ModelError(f"smoothing must be at least 0, got {self}")


@dataclass(frozen=True, eq=False)
class Felt:
    """How far off one stroke felt: error_k (eq. 3), mean and largest, over the bins judged; on which row."""

    error_cN: float
    mean_cN: float
    max_cN: float
    row_cN: FloatArray


def believed(job: Job, known: KnownRig, how: Learning) -> SharedTable:
    """Begin a table of a rig that only its numbers are known of."""
    speeds = job.target.velocity_mm_s
    inertia = inertia_cN(known, speeds)
    alone = 1.0 + how.alone_ratio * inertia
    return SharedTable.believed(job.target.displacement_mm, speeds, how.common_cN, inertia, alone)


def felt_off(stroke: Pass, target_cN: FloatArray, table: SharedTable, at: int, travel_mm: float) -> Felt:
    """Hold one stroke against its target; ModelError if no bin was felt."""
    grid = table.grid_mm
    judged = (grid >= FROM_mm) & (grid <= travel_mm - STOP_GUARD_mm)
    felt = bin_force(stroke.displacement_mm, stroke.felt_cN, grid)[judged]
    whole = error_cN(target_cN[judged], felt)
    off = np.abs(felt - target_cN[judged])
    return Felt(whole, float(np.nanmean(off)), float(np.nanmax(off)), table.rows_cN[at])


def learn_stroke(
    table: SharedTable,
    stroke: Pass,
    target_cN: FloatArray,
    at: int,
    rig: tuple[KnownRig, Tuning],
    how: Learning,
) -> SharedTable:
    """Take one stroke, made for the table's row ``at``, into a table; ModelError if it tells nothing."""
    known, tuning = rig
    grid, speed = table.grid_mm, float(table.speeds_mm_s[at])
    q, dv, da = (how.trust * part for part in foresee(stroke, target_cN, grid, how.finger))
    places, more = wanted_cN(known, tuning, stroke, (q, dv, da), (grid, target_cN))
    sigma_mm = how.smoothing_mm + how.smoothing_s * speed
    seen = bin_force(places, more, grid)
    return table.learned(seen, speed, unrepeatable_cN(known, speed), sigma_mm, how.fading)


def commands(job: Job, known: KnownRig, tables: Pair, friction_mm_s: float) -> ForceSurface:
    """Make the commands: what the numbers ask for, what was learned, the cap held up at its home.

    friction_mm_s : speed from which the controller takes off friction whole; slower strokes carry the rest.
    """
    target, limit = job.target, job.force_limit_cN
    grid = target.displacement_mm
    gain = known.gain_at(grid)
    lift = (LIFT_cN + known.weight_cN) / gain
    slow = np.clip(1.0 - target.velocity_mm_s / friction_mm_s, 0.0, 1.0)[:, np.newaxis]
    rub = slow * known.friction_cN / gain

    def rows(force_cN: FloatArray, learned_cN: FloatArray, down: float) -> FloatArray:
        command = command_cN(known, grid, force_cN) - down * rub + learned_cN
        return np.clip(np.where(grid <= HOME_mm, np.maximum(command, lift), command), -limit, limit)

    press, release = tables
    return ForceSurface(
        grid,
        target.velocity_mm_s,
        rows(target.press_cN, press.rows_cN, 1.0),
        rows(target.release_cN, release.rows_cN, -1.0),
    )
