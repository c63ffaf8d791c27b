"""From records to the compiled button's structure and table: flattened, in SI."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from fdvv.twin._button import ButtonPhysics
from fdvv.twin._cam import Cam, CELL_m, identify
from fdvv.twin._finger import Finger
from fdvv.twin._flatten import HUNT_CROSSLEY, flesh_part, worn_part
from fdvv.twin._gesture import Gesture
from fdvv.twin._kernel_button import CELL, ButtonPlant
from fdvv.twin._rig_senses import ForceSensor
from fdvv.units import FloatArray

STEP_s = 5e-6
TICK_s = 1e-3
"""Period of the muscle's noise and of the recorder's samples."""
ROW_s = 1e-4
BARE = ForceSensor(mass_kg=3e-4, contact_stiffness_N_m=2e4, contact_loss_s_m=1.0)
"""Where no sensor is worn: the skin that moves with the cap, and how it touches it; assumed."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """What is worked out once per button: its identification and the kernel's table."""

    cam: Cam
    table: FloatArray


@lru_cache(maxsize=64)
def prepare(button: ButtonPhysics) -> Prepared:
    """Identify a button and lay out its table; kept for the buttons used last."""
    cam = identify(button)
    return Prepared(cam, _table(cam))


def _table(cam: Cam) -> FloatArray:
    """Lay out one row per cell, as fdvv_button_press takes it."""
    table = np.empty((cam.x_m.size - 1, CELL))
    table[:, :4] = _cubics(cam.x_m, cam.elastic_N)
    table[:, 4:8] = _cubics(cam.x_m, cam.height_m)
    for column, values in ((8, cam.rail_N), (10, cam.friction_ratio)):
        table[:, column] = values[:-1]
        table[:, column + 1] = np.diff(values)
    area = table[:, :4] @ (CELL_m / np.arange(1.0, 5.0))
    table[:, 12] = np.append(0.0, np.cumsum(area)[:-1])
    return table


def _cubics(x: FloatArray, values: FloatArray) -> FloatArray:
    """Give coefficients in u in [0, 1), lowest first, of a smooth curve through all values, (n - 1, 4)."""
    from scipy.interpolate import PchipInterpolator

    highest_first = PchipInterpolator(x, values).c
    return np.asarray(highest_first[::-1].T * CELL_m ** np.arange(4.0))


def button_plant(
    button: ButtonPhysics, finger: Finger, gesture: Gesture, sensor: ForceSensor | None, held: bool = False
) -> ButtonPlant:
    """Flatten everything constant during a press, in SI; held: the housing is clamped."""
    numbers: dict[str, Any] = _finger_part(finger, gesture) | _sensor_part(sensor or BARE)
    numbers |= _button_part(button) | _leaf_part(button)
    numbers |= _plate_part(button, held)
    start_m = float(prepare(button).cam.x_m[0])
    return ButtonPlant(**numbers, table_start_m=start_m, table_step_m=CELL_m, step_s=STEP_s)


def _finger_part(finger: Finger, gesture: Gesture) -> dict[str, float]:
    places = ("start_m", "end_m", "onset_s", "press_s", "dwell_s", "release_s")
    return {name: getattr(gesture, name) for name in places} | {
        "finger_stiffness_N_m": gesture.stiffness_N_m,
        "finger_damping_N_s_m": gesture.damping_N_s_m,
        **flesh_part(finger),
    }


def _sensor_part(sensor: ForceSensor) -> dict[str, float]:
    return {**worn_part(sensor), "sensor_rc_s": sensor.filter_s}


def _button_part(button: ButtonPhysics) -> dict[str, float]:
    slider, dome, housing, curve = button.slider, button.dome, button.housing, button.curve
    rubber = curve.kind == "dome"
    return {
        "slider_mass_kg": slider.mass_kg,
        "viscous_N_s_m": slider.viscous_N_s_m,
        "bristle_m": dome.arm_m if rubber else slider.bristle_m,
        "relax_1_s": 1 / dome.arm_s if rubber else 0.0,
        "law_ratio": dome.log_ratio if rubber and dome.law == "log" else 0.0,
        "law_speed_m_s": dome.log_speed_m_s,
        "law_s_m": dome.linear_s_m if rubber and dome.law == "linear" else 0.0,
        "travel_m": curve.travel_m,
        "bottom_stiffness_N_m": housing.bottom_stiffness_N_m,
        "bottom_loss_s_m": HUNT_CROSSLEY * housing.bottom_loss_s_m,
        "top_stiffness_N_m": housing.top_stiffness_N_m,
        "top_loss_s_m": HUNT_CROSSLEY * housing.top_loss_s_m,
        "close_m": curve.close_m,
        "open_m": curve.open_m,
        "snap_ratio": housing.snap_ratio,
    }


def _leaf_part(button: ButtonPhysics) -> dict[str, float]:
    leaf = button.leaf
    return {
        "leaf_mass_kg": leaf.mass_kg if button.curve.kind == "leaf" else 0.0,
        "leaf_stiffness_N_m": leaf.stiffness_N_m,
        "leaf_preload_N": prepare(button).cam.preload_N,
        "leaf_damping_N_s_m": 2 * leaf.damping_ratio * math.sqrt(leaf.stiffness_N_m * leaf.mass_kg),
        "cam_stiffness_N_m": leaf.cam_stiffness_N_m,
        "cam_loss_s_m": HUNT_CROSSLEY * leaf.cam_loss_s_m,
        "fixed_stiffness_N_m": leaf.fixed_stiffness_N_m,
        "fixed_loss_s_m": HUNT_CROSSLEY * leaf.fixed_loss_s_m,
    }


def _plate_part(button: ButtonPhysics, held: bool) -> dict[str, tuple[float, float]]:
    h = button.housing
    first, second = 2 * math.pi * h.first_Hz, 2 * math.pi * h.second_Hz
    return {
        "plate_1_kg": (0.0, 0.0) if held else (1 / h.first_kg, 1 / h.second_kg),
        "plate_rad_s": (first, second),
        "plate_damping_1_s": (2 * h.first_damping_ratio * first, 2 * h.second_damping_ratio * second),
    }
