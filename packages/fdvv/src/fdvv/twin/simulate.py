"""Simulate a press on the rig."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.protocol.tables import Settings
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.noise import Noise, count_ticks, settle_ticks
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import LoopConstants, STEP_s, grid_of, plant_of, run
from fdvv.twin.settings import limits_of, settings_of
from fdvv.twin.trace import Trace


def simulate_program(
    rig: Rig,
    finger: Finger,
    gesture: Gesture,
    image: bytes,
    noise: Noise,
    announced_mm_s: float,
    step_s: float = STEP_s,
    audit: bool = False,
    settings: Settings | None = None,
    loop: LoopConstants | None = None,
) -> Trace:
    """Simulate one press on a checked program (an image as protocol/fdvv.toml has it) in compiled C.

    announced_mm_s : the speed that the controller takes for granted until it has found its own.
    audit : also account for the energy of the press.
    settings : of the firmware; settings_of(rig) if None.

    The controller is the firmware's own core. Safe to call from threads. Raises ModelError if durations of
    the rig are no multiples of the step, if the firmware cannot hold the settings, or if rig or finger are
    too stiff for the step.
    """
    n = settle_ticks(rig) + count_ticks(rig, gesture)
    if noise.force_N.size != n:
        raise ModelError(f"noise must last {n} ticks, got {noise.force_N.size}")
    grid = replace(grid_of(rig, step_s), audit=int(audit))
    plant = plant_of(rig, finger, step_s)
    held = settings or settings_of(rig)
    pair = held, limits_of(rig)
    rows = run(plant, grid, pair, image, gesture, noise, settle_ticks(rig), announced_mm_s, loop)
    if not np.isfinite(rows.physics[-1]).all():
        raise ModelError(
            f"the press diverged: rig or finger are too stiff or too light for steps of {step_s:g} s; "
            "raise the lightest mass or lower the largest stiffness, damping or loss"
        )
    return Trace.of_rows(rows, audit, plant.drive_low, rig.has_cell)
