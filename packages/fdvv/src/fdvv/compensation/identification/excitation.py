"""What to press so that every number of a rig shows: commands that excite it and still feel like a button."""

from __future__ import annotations

import numpy as np

from fdvv.compensation.presses import HOME_mm
from fdvv.compensation.tables import smooth
from fdvv.errors import ModelError
from fdvv.force_text import force_number, force_text
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

HOLD_cN = 80.0
"""Twice the heaviest mover of the class: the weight to hold up is not known yet."""
HOLD_ratio, HEAVY_ratio = 8 / 9, 1.5
"""Of the force limit, the most that holds the cap up; of a known weight, the least."""
ROOM_cN = 200.0
"""On a rig with a lower limit weight and ripples are less, in proportion."""
FADE_mm = 0.3
RIPPLES_mm = ((0.9, 0.55), (0.75, 0.6))
"""Wavelengths of the ripples over displacement, press and release."""
PHASES_rad = ((0.0, 1.0), (2.0, 0.0))
SMALLER_ratio = 0.7
LEVEL_ratio = 3.0
"""Every second speed is commanded so much more, in ripple_cN: only another level at the same displacement
separates the gain from the rig's own force."""


def identification_surface(
    target: ForceSurface,
    weight_cN: float = 20.0,
    ripple_cN: float = 8.0,
    limit_cN: float = 440.0,
    turn: int = 0,
) -> ForceSurface:
    """Return commands that excite every parameter and still feel like a rough button.

    The target plus about the mover's weight, with ripples over displacement that differ between press and
    release: this decorrelates command and motion. They fade at the ends. The first 0.1 mm commands at least
    80 cN, or more for a heavy mover, else the cap sinks under a resting finger. Where limit_cN is below 200,
    ripples and level are less.

    target : the button's own force; weight_cN : a guess; ripple_cN : amplitude of the longer ripple;
    limit_cN : the largest command of the device. turn : of the speeds; each exchanges the two levels.
    """
    if not (ripple_cN >= 0 and limit_cN > 0):
        raise ModelError(
            f"ripples need a force of 0 or more within a limit above {force_text(0.0)}, got "
            f"{force_number(ripple_cN)}, {force_number(limit_cN)}"
        )
    x, size = target.displacement_mm, min(1.0, limit_cN / ROOM_cN)
    hold_cN = min(max(HOLD_cN, HEAVY_ratio * weight_cN), HOLD_ratio * limit_cN)
    weight_cN, ripple_cN = size * weight_cN, size * ripple_cN
    levels = weight_cN + LEVEL_ratio * ripple_cN * ((np.arange(target.velocity_mm_s.size) + turn) % 2)
    press, release = (
        np.stack(
            [
                _hold_at_rest(x, row + level + ripple_cN * _ripple(x, stroke), limit_cN, hold_cN)
                for row, level in zip(table, levels, strict=True)
            ]
        )
        for stroke, table in enumerate((target.press_cN, target.release_cN))
    )
    return ForceSurface(x, target.velocity_mm_s, press, release)


def _ripple(x_mm: FloatArray, stroke: int) -> FloatArray:
    long, short = (
        np.sin(2 * np.pi * x_mm / length + phase)
        for length, phase in zip(RIPPLES_mm[stroke], PHASES_rad[stroke], strict=True)
    )
    waves = long + SMALLER_ratio * short
    depth = np.minimum(x_mm - x_mm[0] - HOME_mm, x_mm[-1] - x_mm)
    return np.asarray(np.clip(depth / FADE_mm, 0.0, 1.0) * waves)


def _hold_at_rest(x_mm: FloatArray, command_cN: FloatArray, limit_cN: float, hold_cN: float) -> FloatArray:
    """Apply the minimum command at rest, faded out without a step, and the limit."""
    least = hold_cN * np.clip(1.0 - (x_mm - HOME_mm) / FADE_mm, 0.0, 1.0)
    step_mm = float(x_mm[1] - x_mm[0])
    held = smooth(np.maximum(command_cN, least), 0.5 * step_mm, step_mm)
    return np.clip(np.where(x_mm <= HOME_mm, np.maximum(held, hold_cN), held), -limit_cN, limit_cN)
