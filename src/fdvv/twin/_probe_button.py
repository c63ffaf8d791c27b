"""A real button on a force tester: led slowly and stiffly, its housing clamped. Simulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin._button import ButtonPhysics
from fdvv.twin._finger import Finger
from fdvv.twin._flatten_button import button_plant, prepare
from fdvv.twin._gesture import plan
from fdvv.twin._kernel_button import run_probe
from fdvv.units import FloatArray, cN_from_N, m_from_mm, mm_from_m

BEYOND_mm = 0.1
"""The tester goes on beyond the bottom by this before it turns, as the kernel does; no row is taken there."""


@dataclass(frozen=True, eq=False)
class ProbedCurve:
    """Force on displacement of one slow stroke pair, simulated; (n,) each, in rising displacement."""

    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray


def probe_button(button: ButtonPhysics, speed_mm_s: float = 0.5, step_mm: float = 0.005) -> ProbedCurve:
    """Lead the slider down to the bottom stop and back at a constant speed; force as the tester reads it.

    The tester is stiff and cannot pull; a sample every step_mm or a little less.
    """
    if not (speed_mm_s > 0 and step_mm > 0):
        raise ModelError(f"a probe needs speed and step above 0, got {speed_mm_s} mm/s and {step_mm} mm")
    travel_m = button.curve.travel_m
    count = int(np.ceil(mm_from_m(travel_m) / step_mm - 1e-9)) + 1
    finger = Finger()
    plant = button_plant(button, finger, plan(finger, travel_m, 0.1), None, held=True)
    rows = run_probe(plant, prepare(button).table, travel_m, m_from_mm(speed_mm_s), max(count, 2))
    force_cN = cN_from_N(rows[:, 1])
    half = len(rows) // 2
    return ProbedCurve(mm_from_m(rows[:half, 0]), force_cN[:half], force_cN[half:][::-1])
