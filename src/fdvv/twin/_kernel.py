"""The doors of the compiled press: its structures mirrored, and the call."""

from __future__ import annotations

import ctypes
import dataclasses
from dataclasses import dataclass
from functools import cache

import numpy as np

from fdvv._native import address, library
from fdvv.errors import ModelError
from fdvv.units import FloatArray

COLUMNS = 13


@dataclass(frozen=True)
class Plant:
    """The numbers of one press, in the order of fdvv_twin_model; see fdvv.h for their meaning."""

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
    sensor_mass_kg: float
    contact_stiffness_N_m: float
    contact_loss_s_m: float
    force_constant_N_A: float
    droop_1_m2: float
    droop_centre_m: float
    resistance_ohm: float
    inductance_H: float
    supply_V: float
    current_loop_s: float
    moving_mass_kg: float
    gravity_m_s2: float
    coulomb_N: float
    coulomb_speed_m_s: float
    viscous_N_s_m: float
    travel_m: float
    stop_stiffness_N_m: float
    stop_loss_s_m: float
    top_stiffness_N_m: float
    top_loss_s_m: float
    lvdt_rad_s: float
    lvdt_linearity_m: float
    lvdt_range_m: float
    lvdt_lsb_m: float
    sensor_rc_s: float
    sensor_gain: float
    sensor_hysteresis_N: float
    sensor_full_scale_N: float
    sensor_lsb_N: float
    window_start_m: float
    window_end_m: float
    reversal_m: float
    rearm_m: float
    announced_m_s: float
    velocity_scale: float
    force_limit_N: float
    drive_per_N: float
    drive_lsb: float
    drive_low: float
    drive_high: float
    start_m: float
    end_m: float
    onset_s: float
    press_s: float
    dwell_s: float
    release_s: float
    table_start_m: float
    table_step_m: float
    step_s: float


@dataclass(frozen=True)
class Grid:
    """The counts of one press, in the order of fdvv_twin_grid."""

    settle_ticks: int
    ticks: int
    steps_per_tick: int
    steps_per_row: int
    delay_steps: int
    reads: int
    read_steps: int
    average_ticks: int
    fewest_samples: int
    displacements: int
    velocities: int
    audit: int = 0

    @property
    def rows(self) -> int:
        """Count the rows of the record."""
        return self.ticks * (self.steps_per_tick // self.steps_per_row)


class _Model(ctypes.Structure):
    _fields_ = [(f.name, ctypes.c_double) for f in dataclasses.fields(Plant)]


class _Grid(ctypes.Structure):
    _fields_ = [(f.name, ctypes.c_int64) for f in dataclasses.fields(Grid)]


@dataclass(frozen=True, eq=False)
class Inputs:
    """The arrays of one press, as fdvv_twin_press takes them."""

    speeds_m_s: FloatArray
    table_N: FloatArray
    position_noise_m: FloatArray
    force_noise_N: FloatArray
    effort_ratio: FloatArray

    def check(self, grid: Grid) -> None:
        """Raise ModelError unless every array has the shape that grid says."""
        n = grid.settle_ticks + grid.ticks
        wanted = {
            "speeds_m_s": (grid.velocities,),
            "table_N": (2, grid.velocities, grid.displacements),
            "position_noise_m": (n, grid.reads),
            "force_noise_N": (n,),
            "effort_ratio": (n + 1,),
        }
        for name, shape in wanted.items():
            if getattr(self, name).shape != shape:
                raise ModelError(f"{name} must be {shape}, got {getattr(self, name).shape}")


@cache
def _library() -> ctypes.CDLL:
    """Load the library and refuse one built from other structures than these."""
    lib = library()
    sizes = (ctypes.c_int64(), ctypes.c_int64())
    lib.fdvv_twin_sizes(ctypes.byref(sizes[0]), ctypes.byref(sizes[1]))
    ours = (ctypes.sizeof(_Model), ctypes.sizeof(_Grid))
    if (sizes[0].value, sizes[1].value) != ours:
        raise ModelError(
            f"compiled twin has structures of {sizes} bytes, Python of {ours}; rebuild the library"
        )
    return lib


def run(plant: Plant, grid: Grid, inputs: Inputs) -> FloatArray:
    """Simulate one press in C: rows (grid.rows, COLUMNS), columns as fdvv.h lists them."""
    inputs.check(grid)
    arrays = [np.ascontiguousarray(getattr(inputs, f.name)) for f in dataclasses.fields(inputs)]
    rows = np.empty((grid.rows, COLUMNS))
    model = _Model(*dataclasses.astuple(plant))
    counts = _Grid(*dataclasses.astuple(grid))
    pointers = [address(array) for array in arrays]
    if _library().fdvv_twin_press(ctypes.byref(model), ctypes.byref(counts), *pointers, address(rows)):
        raise ModelError(f"the compiled twin cannot step this press: {grid}")
    return rows
