"""What to press a rig with, so that a few presses tell it."""

from __future__ import annotations

import numpy as np

from fdvv.compensate._bins import smooth
from fdvv.compensate._strokes import HOME_mm
from fdvv.errors import ModelError
from fdvv.model import ForceSurface
from fdvv.units import FloatArray

HOLD_cN = 80.0
"""Twice the heaviest mover of the class: it is not known yet what must be held up."""
FADE_mm = 0.3
RIPPLES_mm = ((0.9, 0.55), (0.75, 0.6))
"""Wave lengths of the ripples over displacement, of press and release."""
PHASES_rad = ((0.0, 1.0), (2.0, 0.0))
SMALLER_ratio = 0.7


def identification_surface(
    target: ForceSurface, weight_cN: float = 20.0, ripple_cN: float = 8.0, limit_cN: float = 440.0
) -> ForceSurface:
    """Give commands that excite what must be told apart, and still feel like a rough button.

    The target, lifted by about the weight of what moves, with ripples over displacement that differ between
    press and release: so command and motion do not go together, and the cap is shaken a little. They fade
    at the ends. The first 0.1 mm carries at least 80 cN, else a resting cap sinks under a resting finger.

    target : the button's own force; weight_cN : a guess; ripple_cN : amplitude of the longer ripple;
    limit_cN : the largest command of the device.
    """
    if not (ripple_cN >= 0 and limit_cN > HOLD_cN):
        raise ModelError(
            f"ripples need 0 cN or more within a limit above {HOLD_cN:g} cN, got {ripple_cN}, {limit_cN}"
        )
    x = target.displacement_mm
    press, release = (
        np.stack([_held(x, row + weight_cN + ripple_cN * _ripple(x, stroke), limit_cN) for row in table])
        for stroke, table in enumerate((target.press_cN, target.release_cN))
    )
    return ForceSurface(x, target.velocity_mm_s, press, release)


def _ripple(x_mm: FloatArray, stroke: int) -> FloatArray:
    """Give the ripples of a stroke, the longer one of amplitude 1, fading in over FADE_mm."""
    (long, short), (first, second) = RIPPLES_mm[stroke], PHASES_rad[stroke]
    waves = np.sin(2 * np.pi * x_mm / long + first) + SMALLER_ratio * np.sin(
        2 * np.pi * x_mm / short + second
    )
    depth = np.minimum(x_mm - x_mm[0] - HOME_mm, x_mm[-1] - x_mm)
    return np.asarray(np.clip(depth / FADE_mm, 0.0, 1.0) * waves)


def _held(x_mm: FloatArray, command_cN: FloatArray, limit_cN: float) -> FloatArray:
    """Hold the cap up at its home, without a step at its end, within the limit."""
    least = HOLD_cN * np.clip(1.0 - (x_mm - HOME_mm) / FADE_mm, 0.0, 1.0)
    step_mm = float(x_mm[1] - x_mm[0])
    held = smooth(np.maximum(command_cN, least), 0.5 * step_mm, step_mm)
    return np.clip(np.where(x_mm <= HOME_mm, np.maximum(held, HOLD_cN), held), -limit_cN, limit_cN)
