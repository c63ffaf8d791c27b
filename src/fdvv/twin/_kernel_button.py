"""The doors of the compiled button: its structures mirrored, and the calls."""

from __future__ import annotations

import ctypes
import dataclasses
import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from fdvv._native import address, library
from fdvv.errors import ModelError
from fdvv.units import FloatArray

COLUMNS = 13
CELL = 13
PAIRS = ("plate_1_kg", "plate_rad_s", "plate_damping_1_s")


@dataclass(frozen=True)
class ButtonPlant:
    """The numbers of one press, in the order of fdvv_button_model; see button.h for their meaning."""

    finger_mass_kg: float
    finger_stiffness_N_m: float
    finger_damping_N_s_m: float
    pulp_scale_N: float
    pulp_exponent_1_m: float
    pulp_relaxed_ratio: float
    pulp_fast_ratio: float
    pulp_slow_ratio: float
    pulp_fast_s: float
    pulp_slow_s: float
    strap_N: float
    strap_m: float
    start_m: float
    end_m: float
    onset_s: float
    press_s: float
    dwell_s: float
    release_s: float
    sensor_mass_kg: float
    contact_stiffness_N_m: float
    contact_loss_s_m: float
    sensor_rc_s: float
    slider_mass_kg: float
    viscous_N_s_m: float
    bristle_m: float
    relax_1_s: float
    law_ratio: float
    law_speed_m_s: float
    law_s_m: float
    travel_m: float
    bottom_stiffness_N_m: float
    bottom_loss_s_m: float
    top_stiffness_N_m: float
    top_loss_s_m: float
    leaf_mass_kg: float
    leaf_stiffness_N_m: float
    leaf_preload_N: float
    leaf_damping_N_s_m: float
    cam_stiffness_N_m: float
    cam_loss_s_m: float
    fixed_stiffness_N_m: float
    fixed_loss_s_m: float
    close_m: float
    open_m: float
    plate_1_kg: tuple[float, float]
    plate_rad_s: tuple[float, float]
    plate_damping_1_s: tuple[float, float]
    snap_ratio: float
    table_start_m: float
    table_step_m: float
    step_s: float


@dataclass(frozen=True)
class ButtonGrid:
    """The counts of one press, in the order of fdvv_button_grid."""

    settle_ticks: int
    ticks: int
    steps_per_tick: int
    steps_per_row: int
    cells: int
    audit: int = 0

    @property
    def rows(self) -> int:
        """Count the rows of the record."""
        return self.ticks * (self.steps_per_tick // self.steps_per_row)


class _Model(ctypes.Structure):
    _fields_ = [
        (f.name, ctypes.c_double * 2 if f.name in PAIRS else ctypes.c_double)
        for f in dataclasses.fields(ButtonPlant)
    ]


class _Grid(ctypes.Structure):
    _fields_ = [(f.name, ctypes.c_int64) for f in dataclasses.fields(ButtonGrid)]


@cache
def _library() -> ctypes.CDLL:
    """Load the library and refuse one built from other structures than these."""
    lib = library()
    sizes = (ctypes.c_int64(), ctypes.c_int64())
    lib.fdvv_button_sizes(ctypes.byref(sizes[0]), ctypes.byref(sizes[1]))
    theirs, ours = (sizes[0].value, sizes[1].value), (ctypes.sizeof(_Model), ctypes.sizeof(_Grid))
    if theirs != ours:
        raise ModelError(
            f"compiled button has structures of {theirs} bytes, Python of {ours}; rebuild the library"
        )
    lib.fdvv_button_probe.argtypes = [
        ctypes.c_void_p,
        ctypes.c_int64,
        ctypes.c_void_p,
        ctypes.c_double,
        ctypes.c_double,
        ctypes.c_int64,
        ctypes.c_void_p,
    ]
    return lib


def _model(plant: ButtonPlant) -> _Model:
    return _Model(*(getattr(plant, f.name) for f in dataclasses.fields(plant)))


def run_button(
    plant: ButtonPlant,
    grid: ButtonGrid,
    table: FloatArray,
    effort_ratio: FloatArray,
    detour_m: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Simulate one press in C: rows (COLUMNS, grid.rows) and switching times (2,), as button.h lists them."""
    detour = np.zeros_like(effort_ratio) if detour_m is None else np.ascontiguousarray(detour_m)
    each = (grid.settle_ticks + grid.ticks + 1,)
    wanted = {"table": (grid.cells, CELL), "effort_ratio": each, "detour_m": each}
    for (name, shape), array in zip(wanted.items(), (table, effort_ratio, detour), strict=True):
        if array.shape != shape:
            raise ModelError(f"{name} must be {shape}, got {array.shape}")
    rows, switching = np.empty((COLUMNS, grid.rows)), np.empty(2)
    effort = np.ascontiguousarray(effort_ratio)
    model, counts = _model(plant), _Grid(*dataclasses.astuple(grid))
    pointers = [address(array) for array in (table, effort, detour, rows, switching)]
    if _library().fdvv_button_press(ctypes.byref(model), ctypes.byref(counts), *pointers):
        raise ModelError(f"the compiled button cannot step this press: {grid}")
    return rows, switching


def run_probe(
    plant: ButtonPlant, table: FloatArray, way_m: float, speed_m_s: float, count: int
) -> FloatArray:
    """Lead the slider down and back in C: (2 count, 2) displacement m and force N."""
    if not (math.isfinite(way_m) and math.isfinite(speed_m_s)):
        raise ModelError(f"a probe needs a finite way and speed, got {way_m} m and {speed_m_s} m/s")
    rows = np.empty((2 * count, 2))
    model = _model(plant)
    if _library().fdvv_button_probe(
        ctypes.byref(model), len(table), address(table), way_m, speed_m_s, count, address(rows)
    ):
        raise ModelError(f"the compiled button cannot be probed at {speed_m_s} m/s in {count} rows")
    return rows
