"""The probing stand of a capture bench: slow force on displacement, on the stand's own clock. Simulated."""

from __future__ import annotations

import numpy as np

from fdvv.recording import Mark, Quantity, Stream
from fdvv.twin._button import ButtonPhysics
from fdvv.twin._button_noise import read_force_N
from fdvv.twin._capture_streams import FORCE_ZERO, converted
from fdvv.twin._noise import lsb_of
from fdvv.twin._probe_button import BEYOND_mm, ProbedCurve, probe_button
from fdvv.twin._rig_senses import ForceSensor
from fdvv.units import FloatArray, N_from_cN, cN_from_N, mm_from_m

STAND = "stand"
RATE_Hz = 100.0
ABOVE_mm = 0.2
"""The stand begins this far above the cap, and returns there."""
COUNT_mm = 0.001
"""Resolution of its displacement."""
PLACE_mm = 0.1
"""Spread of where its zero lies off the cap's rest."""


def record_probe(
    button: ButtonPhysics, sensor: ForceSensor, zero_N: float, speed_mm_s: float, random: np.random.Generator
) -> tuple[tuple[Stream, ...], tuple[Mark, ...], ProbedCurve]:
    """Lead the cap down to the bottom and back; streams, marks, and the truth."""
    curve = probe_button(button, speed_mm_s, speed_mm_s / RATE_Hz)
    t_s, down_mm, force_cN, bottom = _whole_way(curve, speed_mm_s)
    place_mm = PLACE_mm * float(random.standard_normal())
    noise_N = zero_N + sensor.noise_N * random.standard_normal(t_s.size)
    read_cN = cN_from_N(read_force_N(sensor, N_from_cN(force_cN), noise_N))
    lsb_cN = float(cN_from_N(lsb_of(sensor.full_scale_N, sensor.converter_bits)))
    streams = (
        converted("force", Quantity.FORCE, STAND, t_s, read_cN, lsb_cN, FORCE_ZERO),
        converted("displacement", Quantity.DISPLACEMENT, STAND, t_s, down_mm + place_mm, COUNT_mm, 0),
    )
    leaf = button.curve.kind == "leaf"
    close_mm, open_mm = (float(mm_from_m(m)) for m in (button.curve.close_m, button.curve.open_m))
    closed = int(np.argmax(down_mm >= close_mm))
    opened = bottom + int(np.argmax(down_mm[bottom:] < (close_mm if leaf else open_mm)))
    marks = (Mark("closed", STAND, float(t_s[closed])), Mark("open", STAND, float(t_s[opened])))
    return streams, marks, curve


def _whole_way(curve: ProbedCurve, speed_mm_s: float) -> tuple[FloatArray, FloatArray, FloatArray, int]:
    """Join approach, press, release and retreat: time, displacement, force, the row where it turns.

    The rows beyond the bottom, where only the stand bends, are left out.
    """
    apart_mm = float(curve.displacement_mm[1] - curve.displacement_mm[0])
    free_mm = -apart_mm * np.arange(int(ABOVE_mm / apart_mm), 0, -1)
    down_mm = np.concatenate([free_mm, curve.displacement_mm])
    forces = np.concatenate([np.zeros(free_mm.size), curve.press_cN])
    back = np.concatenate([curve.release_cN[::-1], np.zeros(free_mm.size)])
    t_s = apart_mm / speed_mm_s * np.arange(down_mm.size)
    turned_s = t_s[-1] + 2 * BEYOND_mm / speed_mm_s
    return (
        np.concatenate([t_s, turned_s + t_s]),
        np.concatenate([down_mm, down_mm[::-1]]),
        np.concatenate([forces, back]),
        down_mm.size,
    )
