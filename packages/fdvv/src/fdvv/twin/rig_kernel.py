"""Parameters of the compiled rig in SI units, and the calls to it."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fdvv._native import address, library, words
from fdvv._native.structures import fill, structure
from fdvv.errors import ModelError
from fdvv.firmware.core import OUTPUTS, RecordArray
from fdvv.protocol.tables import BoardLimits, Settings
from fdvv.twin.finger import Finger, bare
from fdvv.twin.gesture import Gesture
from fdvv.twin.noise import Noise, lsb_of
from fdvv.twin.rig import ForceSensor, Rig
from fdvv.units import FloatArray

LoopConstants = bytes | npt.NDArray[np.float32]
"""fdvv_force_loop_gains, flat: ForceLoopGains.pack()."""

RIG_COLUMNS, TICK_COLUMNS = 10, 3
STEP_s = 1e-5
ROW_s = 1e-4
HUNT_CROSSLEY = 1.5
"""Loss per alpha in F = k d (1 + 1.5 alpha d') (Hunt and Crossley 1975)."""
THERMISTOR_KINDS = {"sound": 1.0, "open": 2.0, "short": 3.0}
KEYCAP_KINDS = {"none": 0.0, "force": 1.0, "acceleration": 2.0}


@dataclass(frozen=True)
class Grid:
    """Discretisation of a tick; the fields of fdvv_rig_grid."""

    steps_per_tick: int
    steps_per_row: int
    delay_steps: int
    reads: int
    read_steps: float
    audit: int = 0

    @property
    def rows_per_tick(self) -> int:
        return self.steps_per_tick // self.steps_per_row

    def counts(self) -> ctypes.Structure:
        """Return fdvv_rig_grid."""
        return fill("fdvv_rig_grid", vars(self))


class Rows(NamedTuple):
    """Record of a press: physics (rows, RIG_COLUMNS), each tick's sensors (ticks, 3), the core's outputs."""

    physics: FloatArray
    sensed: FloatArray
    outputs: RecordArray


def pick(record: object, names: str, prefix: str = "") -> dict[str, float]:
    """Return fields of a record, named in one text, under the kernel's names: those with a prefix."""
    return {prefix + name: getattr(record, name) for name in names.split()}


def gesture_times(gesture: Gesture) -> ctypes.Structure:
    """Return fdvv_gesture."""
    return fill("fdvv_gesture", pick(gesture, "start_m end_m onset_s press_s dwell_s release_s"))


def noise_pointers(arrays: Sequence[FloatArray]) -> ctypes.Structure:
    """Return fdvv_twin_noise; the caller keeps the arrays (Noise.arrays()) alive during the call."""
    return structure("fdvv_twin_noise")(*(address(array) for array in arrays))


@cache
def rig_library() -> ctypes.CDLL:
    """Load the library; raise ModelError if it was built from other structures than the headers say."""
    lib = library()
    names = ("fdvv_rig_model", "fdvv_rig_grid", "fdvv_twin_press_plan", "fdvv_twin_noise")
    expected = [ctypes.sizeof(structure(name)) for name in names] + [OUTPUTS.itemsize]
    sizes = _sizes(lib)
    compiled = sizes[:2] + sizes[3:]
    if compiled != expected:
        raise ModelError(
            f"compiled twin has structures of {compiled} bytes, Python of {expected}; rebuild the library"
        )
    lib.fdvv_rig_step.restype = ctypes.c_double
    lib.fdvv_rig_load.restype = ctypes.c_uint8
    return lib


def _sizes(lib: ctypes.CDLL) -> list[int]:
    """Return the bytes of model, grid, running rig, plan, noise and outputs."""
    sizes = [ctypes.c_int64() for _ in range(6)]
    lib.fdvv_rig_sizes(*(ctypes.byref(size) for size in sizes[:3]))
    lib.fdvv_twin_sizes(*(ctypes.byref(size) for size in sizes[3:]))
    return [size.value for size in sizes]


def rig_bytes() -> int:
    """Return the memory of a running rig."""
    return _sizes(rig_library())[2]


def run(
    plant: ctypes.Structure,
    grid: Grid,
    settings: tuple[Settings, BoardLimits],
    image: bytes,
    gesture: Gesture,
    noise: Noise,
    settle_ticks: int,
    announced_mm_s: float,
    loop: LoopConstants | None = None,
) -> Rows:
    """Simulate one press in C, under settings and the board's limits.

    ModelError if the noise is of another length, or the grid is impossible.
    """
    noise.check(grid.reads)
    ticks = noise.force_N.size - settle_ticks
    n = max(ticks, 0)  # fewer than none are refused by the kernel
    plan = {
        "gesture": gesture_times(gesture),
        **pick(gesture, "stiffness_N_m damping_N_s_m"),
        "settle_ticks": settle_ticks,
        "ticks": ticks,
        "announced_mm_s16": round(16 * announced_mm_s),
    }
    physics, sensed = np.empty((n * grid.rows_per_tick, RIG_COLUMNS)), np.empty((n, TICK_COLUMNS))
    rows = Rows(physics, sensed, np.zeros(n, OUTPUTS))
    arrays = noise.arrays()
    settings_words, limits_words, image_words = (words(d) for d in (*(s.pack() for s in settings), image))
    held_loop = None if loop is None else np.frombuffer(loop, np.float32).copy()
    failed = rig_library().fdvv_twin_press(
        ctypes.byref(plant),
        ctypes.byref(grid.counts()),
        ctypes.byref(fill("fdvv_twin_press_plan", plan)),
        address(settings_words),
        address(limits_words),
        None if held_loop is None else address(held_loop),
        address(image_words),
        ctypes.byref(noise_pointers(arrays)),
        *(address(array) for array in rows),
    )
    if failed:
        raise ModelError(f"the compiled twin cannot run this press: {grid}, {ticks} ticks")
    return rows


def plant_of(rig: Rig, finger: Finger, step_s: float = STEP_s) -> ctypes.Structure:
    """Return fdvv_rig_model: everything constant while a rig runs, in SI units."""
    impedance = finger.impedance
    parts = {
        "finger": finger_part(
            bare(finger) if rig.has_cell else finger, impedance.stiffness_N_m, impedance.damping_N_s_m
        ),
        **_contact_part(rig),
        **_coil_part(rig),
        **_mechanics_part(rig),
        **_servo_part(rig),
        **_exciter_part(rig),
        **_sensing_part(rig),
        **_keycap_part(rig),
        **_thermistor_part(rig),
        "step_s": step_s,
    }
    return fill("fdvv_rig_model", parts)


def finger_part(finger: Finger, stiffness_N_m: float, damping_N_s_m: float) -> dict[str, float]:
    """Return the fields of fdvv_finger, with the impedance of one gesture."""
    pulp = finger.pulp
    relaxing = 1 - pulp.relaxed_ratio
    return {
        "finger_mass_kg": finger.impedance.mass_kg,
        "finger_stiffness_N_m": stiffness_N_m,
        "finger_damping_N_s_m": damping_N_s_m,
        **pick(pulp, "scale_N exponent_1_m relaxed_ratio fast_s slow_s", "pulp_"),
        "pulp_fast_ratio": relaxing * pulp.fast_share,
        "pulp_slow_ratio": relaxing * (1 - pulp.fast_share),
        "strap_N": pulp.strap_N,
        "strap_m": math.log1p(pulp.strap_N / (pulp.relaxed_ratio * pulp.scale_N)) / pulp.exponent_1_m,
    }


def sensor_part(sensor: ForceSensor) -> dict[str, float]:
    """Return the fields of the force sensor on the fingertip."""
    return {
        "sensor_mass_kg": sensor.mass_kg,
        "contact_stiffness_N_m": sensor.contact_stiffness_N_m,
        "contact_loss_s_m": HUNT_CROSSLEY * sensor.contact_loss_s_m,
    }


def _contact_part(rig: Rig) -> dict[str, float]:
    """Return what lies between pulp and cap: the worn cone's contact, or the plate on the load cell."""
    cell = rig.load_cell
    if not rig.has_cell:
        return {**sensor_part(rig.force_sensor), "cell_damping_N_s_m": 0.0}
    return {
        "sensor_mass_kg": cell.plate_kg,
        "contact_stiffness_N_m": cell.stiffness_N_m,
        "contact_loss_s_m": 0.0,
        "cell_damping_N_s_m": cell.damping_N_s_m,
    }


def _coil_part(rig: Rig) -> dict[str, float]:
    coil = rig.coil
    return {
        **pick(coil, "resistance_ohm bridge_ohm source_ohm inductance_H reluctance_H_m copper_1_K"),
        **pick(coil, "force_constant_N_A heat_K_W heat_s supply_V"),
        "droop_1_m2": coil.droop_ratio / (coil.stroke_m / 2) ** 2,
        "droop_centre_m": coil.centre_m,
        "current_loop_s": 0.0 if coil.drive == "voltage" else coil.current_loop_s,
        "drive_lsb": lsb_of(1.0, coil.command_bits),
        "drive_low": -1.0 if coil.bipolar == "yes" else 0.0,
    }


def _mechanics_part(rig: Rig) -> dict[str, float]:
    mover, stops = rig.mover, rig.stops
    return {
        "mover_mass_kg": mover.mass_kg,
        "frame_mass_kg": rig.frame_kg,
        **pick(mover, "gravity_m_s2 coulomb_N presliding_m viscous_N_s_m"),
        "stop_stiffness_N_m": stops.bottom_stiffness_N_m,
        "stop_loss_s_m": HUNT_CROSSLEY * stops.bottom_loss_s_m,
        "top_stiffness_N_m": stops.top_stiffness_N_m,
        "top_loss_s_m": HUNT_CROSSLEY * stops.top_loss_s_m,
    }


def _servo_part(rig: Rig) -> dict[str, float]:
    servo = rig.servo
    per_us = 1e-3 / servo.pulse_us_mm
    return {
        **pick(servo, "frame_s lag_s play_m", "servo_"),
        "servo_zero_us": servo.pulse_zero_us,
        "servo_m_us": per_us,
        "servo_deadband_m": per_us * servo.deadband_us,
        "servo_m_s": 1e-3 * servo.speed_mm_s,
    }


def _exciter_part(rig: Rig) -> dict[str, float]:
    e = rig.exciter
    mass = e.mass_kg if e.fitted == "yes" else 0.0
    omega = 2 * math.pi * e.resonance_Hz
    return {
        "magnet_kg": mass,
        "magnet_stiffness_N_m": mass * omega**2,
        "magnet_damping_N_s_m": mass * omega / e.quality,
        "magnet_motor_N_A": e.motor_N_A if mass else 0.0,
        "magnet_ohm": e.resistance_ohm,
        "magnet_H": e.inductance_H,
        "amplifier_V_count": e.drive_V / 2047,  # a converter of 12 bits, signed
        "amplifier_clip_V": e.clip_V,
        "amplifier_rate": 2 * math.pi * e.filter_Hz,
        **pick(e, "latency_s jitter_s", "vibration_"),
    }


def _sensing_part(rig: Rig) -> dict[str, float]:
    position, force = rig.position_sensor, rig.force_sensor
    return {
        "lvdt_rate": 2 * math.pi * position.bandwidth_Hz,
        "lvdt_linearity_m": position.linearity_ratio * position.range_m / 2,
        "lvdt_range_m": position.range_m,
        "lvdt_steps": 2.0**position.converter_bits,
        "sensor_rate": 1 / force.filter_s,
        "sensor_gain": 1 + force.gain_error_ratio,
        **pick(force, "hysteresis_N full_scale_N", "sensor_"),
        "sensor_lsb_N": lsb_of(force.full_scale_N, force.converter_bits),
    }


def _keycap_part(rig: Rig) -> dict[str, float]:
    """Return the board's force reading: of the load cell, else of the cap's own sensor."""
    cap, cell = rig.keycap_sensor, rig.load_cell
    if rig.has_cell:
        return {
            "keycap_kind": KEYCAP_KINDS["force"],
            "keycap_full_scale": cell.full_scale_N,
            "keycap_rate": 2 * math.pi * cell.bandwidth_Hz,
            "keycap_steps": 2.0**cell.converter_bits,
            "keycap_gain": 1 + cell.gain_error_ratio,
            "keycap_offset": cell.offset_N / cell.full_scale_N,
        }
    return {
        "keycap_kind": KEYCAP_KINDS[cap.kind],
        "keycap_full_scale": cap.full_scale_m_s2 if cap.kind == "acceleration" else cap.full_scale_N,
        "keycap_rate": 2 * math.pi * cap.bandwidth_Hz,
        "keycap_steps": 2.0**cap.converter_bits,
        "keycap_gain": 1.0,
        "keycap_offset": 0.0,
    }


def _thermistor_part(rig: Rig) -> dict[str, float]:
    bead = rig.thermistor
    return {
        "thermistor_kind": THERMISTOR_KINDS[bead.condition] if bead.fitted == "yes" else 0.0,
        "thermistor_share": bead.share_ratio,
        "thermistor_lag_s": bead.lag_s,
        "thermistor_25_ohm": bead.resistance_ohm,
        "thermistor_beta_K": bead.beta_K,
        "pull_up_ohm": bead.pull_up_ohm,
        "thermistor_noise": bead.noise_counts,
        "room_C": bead.room_C,
    }


def grid_of(rig: Rig, step_s: float = STEP_s) -> Grid:
    """Divide a tick into steps; raise ModelError if a duration is no whole number of steps."""
    control, position = rig.controller, rig.position_sensor

    def steps(duration_s: float, name: str) -> int:
        count = round(duration_s / step_s)
        if abs(count * step_s - duration_s) > 1e-9:
            raise ModelError(f"{name} must be a multiple of the step {step_s:g} s, got {duration_s:g} s")
        return count

    per_tick = steps(control.tick_s, "tick_s")
    return Grid(
        steps_per_tick=per_tick,
        steps_per_row=math.gcd(per_tick, steps(ROW_s, "row")),
        delay_steps=steps(control.compute_s, "compute_s"),
        reads=position.reads,
        read_steps=max(1e-3, position.burst_s / position.reads / step_s),
    )
