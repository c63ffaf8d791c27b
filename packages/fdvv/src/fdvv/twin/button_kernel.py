"""Parameters of the compiled button in SI units, and the calls to it."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from fdvv._native import address, library
from fdvv._native.structures import fill, structure
from fdvv.errors import ModelError
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.cam import Cam, CELL_m, identify
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.rig import ForceSensor
from fdvv.twin.rig_kernel import HUNT_CROSSLEY, finger_part, gesture_times, pick, sensor_part
from fdvv.units import FloatArray

BUTTON_COLUMNS = 13
CELL_COLUMNS = 13
STEP_s = 5e-6
TICK_s = 1e-3
"""Period of the muscle's noise and of the recorder's samples."""
ROW_s = 1e-4
BARE = ForceSensor(mass_kg=3e-4, contact_stiffness_N_m=2e4, contact_loss_s_m=1.0)
"""Where no sensor is worn: the skin that moves with the cap, and how it touches it; assumed."""


@dataclass(frozen=True)
class ButtonGrid:
    """Discretisation of one press; the fields of fdvv_button_grid."""

    settle_ticks: int
    ticks: int
    steps_per_tick: int
    steps_per_row: int
    cells: int
    audit: int = 0

    @property
    def rows(self) -> int:
        return self.ticks * (self.steps_per_tick // self.steps_per_row)


@cache
def button_library() -> ctypes.CDLL:
    """Load the library; raise ModelError if it was built from other structures than the headers say."""
    lib, sizes = library(), (ctypes.c_int64(), ctypes.c_int64())
    lib.fdvv_button_sizes(*map(ctypes.byref, sizes))
    compiled = [size.value for size in sizes]
    expected = [ctypes.sizeof(structure(name)) for name in ("fdvv_button_model", "fdvv_button_grid")]
    if compiled != expected:
        raise ModelError(
            f"compiled button has structures of {compiled} bytes, Python of {expected}; rebuild the library"
        )
    pointer, count, number = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
    lib.fdvv_button_probe.argtypes = [pointer, count, pointer, number, number, count, pointer]
    return lib


def run_button(
    plant: ctypes.Structure,
    grid: ButtonGrid,
    table: FloatArray,
    effort_ratio: FloatArray,
    detour_m: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Simulate one press in C; return rows (BUTTON_COLUMNS, grid.rows) and switching times (2,)."""
    detour = np.zeros_like(effort_ratio) if detour_m is None else np.ascontiguousarray(detour_m)
    each = (grid.settle_ticks + grid.ticks + 1,)
    shapes = {"table": (grid.cells, CELL_COLUMNS), "effort_ratio": each, "detour_m": each}
    for (name, shape), array in zip(shapes.items(), (table, effort_ratio, detour), strict=True):
        if array.shape != shape:
            raise ModelError(f"{name} must be {shape}, got {array.shape}")
    rows, switching = np.empty((BUTTON_COLUMNS, grid.rows)), np.empty(2)
    effort = np.ascontiguousarray(effort_ratio)
    counts = fill("fdvv_button_grid", vars(grid))
    pointers = [address(array) for array in (table, effort, detour, rows, switching)]
    if button_library().fdvv_button_press(ctypes.byref(plant), ctypes.byref(counts), *pointers):
        raise ModelError(f"the compiled button cannot step this press: {grid}")
    return rows, switching


class Prepared(NamedTuple):
    """What is worked out once per button: its identification and the kernel's table."""

    cam: Cam
    table: FloatArray


@lru_cache(maxsize=64)
def prepare(button: ButtonPhysics) -> Prepared:
    """Identify a button and lay out its table; kept for the buttons used last."""
    cam = identify(button)
    return Prepared(cam, _table(cam))


def _table(cam: Cam) -> FloatArray:
    table = np.empty((cam.x_m.size - 1, CELL_COLUMNS))
    table[:, :4] = _cubics(cam.x_m, cam.elastic_N)
    table[:, 4:8] = _cubics(cam.x_m, cam.height_m)
    for column, values in ((8, cam.rail_N), (10, cam.friction_ratio)):
        table[:, column] = values[:-1]
        table[:, column + 1] = np.diff(values)
    area = table[:, :4] @ (CELL_m / np.arange(1.0, 5.0))
    table[:, 12] = np.append(0.0, np.cumsum(area)[:-1])
    return table


def _cubics(x: FloatArray, values: FloatArray) -> FloatArray:
    """Return coefficients in u in [0, 1), lowest first, of a smooth curve through all values, (n - 1, 4)."""
    from scipy.interpolate import PchipInterpolator

    highest_first = PchipInterpolator(x, values).c
    return np.asarray(highest_first[::-1].T * CELL_m ** np.arange(4.0))


def button_plant(
    button: ButtonPhysics,
    finger: Finger,
    gesture: Gesture,
    sensor: ForceSensor | None,
    clamped: bool = False,
    step_s: float = STEP_s,
) -> ctypes.Structure:
    """Return fdvv_button_model: everything constant during a press, in SI units.

    sensor : worn on the fingertip; None for a bare finger. clamped : the housing cannot move.
    """
    worn = sensor or BARE
    parts = {
        "finger": finger_part(finger, gesture.stiffness_N_m, gesture.damping_N_s_m),
        "gesture": gesture_times(gesture),
        **sensor_part(worn),
        "sensor_rc_s": worn.filter_s,
        **_button_part(button),
        **_leaf_part(button),
        **_plate_part(button, clamped),
        "table_start_m": float(prepare(button).cam.x_m[0]),
        "table_step_m": CELL_m,
        "step_s": step_s,
    }
    return fill("fdvv_button_model", parts)


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
        **pick(curve, "travel_m close_m open_m"),
        **pick(housing, "bottom_stiffness_N_m top_stiffness_N_m snap_ratio"),
        "bottom_loss_s_m": HUNT_CROSSLEY * housing.bottom_loss_s_m,
        "top_loss_s_m": HUNT_CROSSLEY * housing.top_loss_s_m,
    }


def _leaf_part(button: ButtonPhysics) -> dict[str, float]:
    leaf = button.leaf
    return {
        "leaf_mass_kg": leaf.mass_kg if button.curve.kind == "leaf" else 0.0,
        "leaf_stiffness_N_m": leaf.stiffness_N_m,
        "leaf_preload_N": prepare(button).cam.preload_N,
        "leaf_damping_N_s_m": 2 * leaf.damping_ratio * math.sqrt(leaf.stiffness_N_m * leaf.mass_kg),
        **pick(leaf, "cam_stiffness_N_m fixed_stiffness_N_m"),
        "cam_loss_s_m": HUNT_CROSSLEY * leaf.cam_loss_s_m,
        "fixed_loss_s_m": HUNT_CROSSLEY * leaf.fixed_loss_s_m,
    }


def _plate_part(button: ButtonPhysics, clamped: bool) -> dict[str, tuple[float, float]]:
    h = button.housing
    first, second = 2 * math.pi * h.first_Hz, 2 * math.pi * h.second_Hz
    return {
        "plate_1_kg": (0.0, 0.0) if clamped else (1 / h.first_kg, 1 / h.second_kg),
        "plate_rad_s": (first, second),
        "plate_damping_1_s": (2 * h.first_damping_ratio * first, 2 * h.second_damping_ratio * second),
    }
