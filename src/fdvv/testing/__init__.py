"""Helpers for tests, shipped: devices without physics, random programs, what devices and rigs must honour."""

from fdvv.testing._captured import (
    PERFECT_RIG,
    PERFECT_SENSOR,
    CapturedSession,
    PACES_mm_s,
    captured_session,
    top_mm,
    true_stroke_cN,
)
from fdvv.testing._chunk_work import SeededSum, refuse_three, wait_for_ever
from fdvv.testing._closed_forms import coil_error_ratio, mean_response, ripple_N
from fdvv.testing._conformance import DeviceConformance, ProgramConformance, plain_surface
from fdvv.testing._deadly_work import DeadlyCells, DeadlyReader
from fdvv.testing._felt import Felt, SNAP_AT_mm, SNAP_DURATION_s, SNAP_Hz, felt, press_with, snap, ways
from fdvv.testing._held import held_swings_mm, swings_held
from fdvv.testing._loop import (
    AWAY,
    LinearLoop,
    bare_loop,
    cycles,
    grainy_loop,
    onset_N_m,
    quantisation_limit_N_m,
)
from fdvv.testing._random_presses import random_inputs, random_settings
from fdvv.testing._random_programs import random_image
from fdvv.testing._rig_truth import draw_fast_rig, missed_cN, rig_truth
from fdvv.testing._scripted import ScriptedDevice

__all__ = [
    "AWAY",
    "PERFECT_RIG",
    "PERFECT_SENSOR",
    "CapturedSession",
    "DeadlyCells",
    "DeadlyReader",
    "DeviceConformance",
    "Felt",
    "LinearLoop",
    "PACES_mm_s",
    "ProgramConformance",
    "SNAP_AT_mm",
    "SNAP_DURATION_s",
    "SNAP_Hz",
    "ScriptedDevice",
    "SeededSum",
    "bare_loop",
    "captured_session",
    "coil_error_ratio",
    "cycles",
    "draw_fast_rig",
    "felt",
    "grainy_loop",
    "held_swings_mm",
    "mean_response",
    "missed_cN",
    "onset_N_m",
    "plain_surface",
    "press_with",
    "quantisation_limit_N_m",
    "random_image",
    "random_inputs",
    "random_settings",
    "refuse_three",
    "rig_truth",
    "ripple_N",
    "snap",
    "swings_held",
    "top_mm",
    "true_stroke_cN",
    "wait_for_ever",
    "ways",
]
