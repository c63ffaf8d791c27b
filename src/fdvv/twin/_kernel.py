"""The doors of the compiled rig: its structures mirrored, and the calls."""

from __future__ import annotations

import ctypes
import dataclasses
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from fdvv._native import address, library, words
from fdvv.core import OUTPUTS, RecordArray
from fdvv.errors import ModelError
from fdvv.protocol import Settings
from fdvv.twin._gesture import Gesture
from fdvv.twin._noise import Noise
from fdvv.units import FloatArray

COLUMNS, TICK_COLUMNS = 10, 3


@dataclass(frozen=True)
class Plant:
    """The numbers of a rig and a finger, in the order of fdvv_rig_model; see rig.h for their meaning."""

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
    bridge_ohm: float
    source_ohm: float
    inductance_H: float
    reluctance_H_m: float
    copper_1_K: float
    heat_K_W: float
    heat_s: float
    supply_V: float
    current_loop_s: float
    drive_lsb: float
    drive_low: float
    mover_mass_kg: float
    frame_mass_kg: float
    gravity_m_s2: float
    coulomb_N: float
    presliding_m: float
    viscous_N_s_m: float
    stop_stiffness_N_m: float
    stop_loss_s_m: float
    top_stiffness_N_m: float
    top_loss_s_m: float
    servo_zero_us: float
    servo_m_us: float
    servo_frame_s: float
    servo_deadband_m: float
    servo_m_s: float
    servo_lag_s: float
    servo_play_m: float
    magnet_kg: float
    magnet_stiffness_N_m: float
    magnet_damping_N_s_m: float
    magnet_motor_N_A: float
    magnet_ohm: float
    magnet_H: float
    amplifier_V_count: float
    amplifier_clip_V: float
    amplifier_rate: float
    vibration_latency_s: float
    vibration_jitter_s: float
    lvdt_rate: float
    lvdt_linearity_m: float
    lvdt_range_m: float
    lvdt_steps: float
    sensor_rate: float
    sensor_gain: float
    sensor_hysteresis_N: float
    sensor_full_scale_N: float
    sensor_lsb_N: float
    keycap_kind: float
    keycap_full_scale: float
    keycap_rate: float
    keycap_steps: float
    step_s: float


@dataclass(frozen=True)
class Grid:
    """How a tick is cut, in the order of fdvv_rig_grid."""

    steps_per_tick: int
    steps_per_row: int
    delay_steps: int
    reads: int
    read_steps: float
    audit: int = 0

    @property
    def rows_per_tick(self) -> int:
        """Count the rows of a tick."""
        return self.steps_per_tick // self.steps_per_row


class Rows(NamedTuple):
    """What a press leaves: physics (rows, COLUMNS), each tick's sensors (ticks, 3), the core's outputs."""

    physics: FloatArray
    sensed: FloatArray
    outputs: RecordArray


class Model(ctypes.Structure):
    """fdvv_rig_model."""

    _fields_ = [(f.name, ctypes.c_double) for f in dataclasses.fields(Plant)]


class GridCounts(ctypes.Structure):
    """fdvv_rig_grid."""

    _fields_ = [
        (f.name, ctypes.c_double if f.name == "read_steps" else ctypes.c_int64)
        for f in dataclasses.fields(Grid)
    ]


class GestureTimes(ctypes.Structure):
    """fdvv_gesture."""

    NAMES = ("start_m", "end_m", "onset_s", "press_s", "dwell_s", "release_s")
    _fields_ = [(name, ctypes.c_double) for name in NAMES]

    @classmethod
    def of(cls, gesture: Gesture) -> GestureTimes:
        """Take where the referent goes."""
        return cls(*(getattr(gesture, name) for name in cls.NAMES))


class _Plan(ctypes.Structure):
    _fields_ = [
        ("gesture", GestureTimes),
        ("stiffness_N_m", ctypes.c_double),
        ("damping_N_s_m", ctypes.c_double),
        ("settle_ticks", ctypes.c_int64),
        ("ticks", ctypes.c_int64),
        ("announced_mm_s16", ctypes.c_int64),
    ]


class NoiseArrays(ctypes.Structure):
    """fdvv_twin_noise."""

    _fields_ = [
        (name, ctypes.c_void_p) for name in ("position_m", "force_N", "keycap", "effort_ratio", "latency")
    ]


@cache
def doors() -> ctypes.CDLL:
    """Load the library and refuse one built from other structures than these."""
    lib = library()
    sizes = [ctypes.c_int64() for _ in range(6)]
    lib.fdvv_rig_sizes(*(ctypes.byref(size) for size in sizes[:3]))
    lib.fdvv_twin_sizes(*(ctypes.byref(size) for size in sizes[3:]))
    found = [size.value for size in sizes]
    ours = [ctypes.sizeof(part) for part in (Model, GridCounts, _Plan, NoiseArrays)] + [OUTPUTS.itemsize]
    if found[:2] + found[3:] != ours:
        raise ModelError(
            f"compiled twin has structures of {found} bytes, Python of {ours}; rebuild the library"
        )
    lib.fdvv_rig_step.restype = ctypes.c_double
    lib.fdvv_rig_load.restype = ctypes.c_uint8
    return lib


def rig_bytes() -> int:
    """Tell how much memory a running rig takes."""
    sizes = [ctypes.c_int64() for _ in range(3)]
    doors().fdvv_rig_sizes(*(ctypes.byref(size) for size in sizes))
    return sizes[2].value


def run(
    plant: Plant,
    grid: Grid,
    settings: Settings,
    image: bytes,
    gesture: Gesture,
    noise: Noise,
    settle_ticks: int,
    announced_mm_s: float,
) -> Rows:
    """Simulate one press in C; ModelError if the noise is that of another one, or the grid is impossible."""
    noise.check(grid.reads)
    ticks = noise.force_N.size - settle_ticks
    plan = _Plan(
        GestureTimes.of(gesture),
        gesture.stiffness_N_m,
        gesture.damping_N_s_m,
        settle_ticks,
        ticks,
        round(16 * announced_mm_s),
    )
    rows = Rows(
        np.empty((max(ticks, 0) * grid.rows_per_tick, COLUMNS)),
        np.empty((max(ticks, 0), TICK_COLUMNS)),
        np.zeros(max(ticks, 0), OUTPUTS),
    )
    arrays = noise.arrays()
    told, held = words(settings.pack()), words(image)
    failed = doors().fdvv_twin_press(
        ctypes.byref(Model(*vars(plant).values())),
        ctypes.byref(GridCounts(*vars(grid).values())),
        ctypes.byref(plan),
        address(told),
        address(held),
        ctypes.byref(NoiseArrays(*(address(array) for array in arrays))),
        *(address(array) for array in rows),
    )
    if failed:
        raise ModelError(f"the compiled twin cannot run this press: {grid}, {ticks} ticks")
    return rows
