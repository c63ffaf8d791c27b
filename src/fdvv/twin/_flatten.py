"""From records to the compiled press's structures: flattened, in SI, cut into steps."""

from __future__ import annotations

import math

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import ForceSurface
from fdvv.twin._finger import Finger
from fdvv.twin._gesture import Gesture
from fdvv.twin._kernel import Grid, Inputs, Plant
from fdvv.twin._noise import Noise, count_ticks, lsb_of, reads_of, settle_ticks
from fdvv.twin._rig import Rig
from fdvv.units import N_from_cN, m_from_mm

STEP_s = 5e-6
ROW_s = 1e-4
HUNT_CROSSLEY = 1.5
"""Loss per alpha in F = k d (1 + 1.5 alpha d') (Hunt and Crossley 1975)."""


def plant_of(
    rig: Rig, finger: Finger, gesture: Gesture, surface: ForceSurface, travel_mm: float, announced_mm_s: float
) -> Plant:
    """Flatten everything constant during a press, in SI."""
    return Plant(
        **_finger_part(rig, finger, gesture),
        **_coil_part(rig),
        **_mechanics_part(rig, float(m_from_mm(travel_mm))),
        **_sensing_part(rig),
        **_control_part(rig, announced_mm_s),
        start_m=gesture.start_m,
        end_m=gesture.end_m,
        onset_s=gesture.onset_s,
        press_s=gesture.press_s,
        dwell_s=gesture.dwell_s,
        release_s=gesture.release_s,
        table_start_m=m_from_mm(float(surface.displacement_mm[0])),
        table_step_m=m_from_mm(float(np.ptp(surface.displacement_mm)) / (surface.displacement_mm.size - 1)),
        step_s=STEP_s,
    )


def _finger_part(rig: Rig, finger: Finger, gesture: Gesture) -> dict[str, float]:
    pulp, sensor = finger.pulp, rig.force_sensor
    relaxing = 1 - pulp.relaxed_ratio
    return {
        "finger_mass_kg": finger.impedance.mass_kg,
        "finger_stiffness_N_m": gesture.stiffness_N_m,
        "finger_damping_N_s_m": gesture.damping_N_s_m,
        "pulp_scale_N": pulp.scale_N,
        "pulp_exponent_1_m": pulp.exponent_1_m,
        "pulp_relaxed_ratio": pulp.relaxed_ratio,
        "pulp_fast_ratio": relaxing * pulp.fast_share,
        "pulp_slow_ratio": relaxing * (1 - pulp.fast_share),
        "pulp_fast_s": pulp.fast_s,
        "pulp_slow_s": pulp.slow_s,
        "strap_N": pulp.strap_N,
        "strap_m": math.log1p(pulp.strap_N / (pulp.relaxed_ratio * pulp.scale_N)) / pulp.exponent_1_m,
        "sensor_mass_kg": sensor.mass_kg,
        "contact_stiffness_N_m": sensor.contact_stiffness_N_m,
        "contact_loss_s_m": HUNT_CROSSLEY * sensor.contact_loss_s_m,
    }


def _coil_part(rig: Rig) -> dict[str, float]:
    coil = rig.coil
    voltage = coil.drive == "voltage"
    # a calibrated command: a held force equals the table where the coil is at its best
    per_N = (1 + rig.controller.gain_error_ratio) / coil.force_constant_N_A
    per_N *= coil.resistance_ohm if voltage else 1.0
    high = coil.supply_V if voltage else coil.supply_V / coil.resistance_ohm
    return {
        "force_constant_N_A": coil.force_constant_N_A,
        "droop_1_m2": coil.droop_ratio / (coil.stroke_m / 2) ** 2,
        "droop_centre_m": coil.centre_m,
        "resistance_ohm": coil.resistance_ohm,
        "inductance_H": coil.inductance_H,
        "supply_V": coil.supply_V,
        "current_loop_s": 0.0 if voltage else coil.current_loop_s,
        "drive_per_N": per_N,
        "drive_lsb": lsb_of(high, coil.command_bits),
        "drive_low": -high if coil.bipolar == "yes" else 0.0,
        "drive_high": high,
    }


def _mechanics_part(rig: Rig, travel_m: float) -> dict[str, float]:
    mover, stops = rig.mover, rig.stops
    return {
        "moving_mass_kg": mover.mass_kg,
        "gravity_m_s2": mover.gravity_m_s2,
        "coulomb_N": mover.coulomb_N,
        "coulomb_speed_m_s": mover.coulomb_speed_m_s,
        "viscous_N_s_m": mover.viscous_N_s_m,
        "travel_m": travel_m,
        "stop_stiffness_N_m": stops.bottom_stiffness_N_m,
        "stop_loss_s_m": HUNT_CROSSLEY * stops.bottom_loss_s_m,
        "top_stiffness_N_m": stops.top_stiffness_N_m,
        "top_loss_s_m": HUNT_CROSSLEY * stops.top_loss_s_m,
    }


def _sensing_part(rig: Rig) -> dict[str, float]:
    position, force = rig.position_sensor, rig.force_sensor
    return {
        "lvdt_rad_s": 2 * math.pi * position.bandwidth_Hz,
        "lvdt_linearity_m": position.linearity_ratio * position.range_m / 2,
        "lvdt_range_m": position.range_m,
        "lvdt_lsb_m": lsb_of(position.range_m, position.converter_bits),
        "sensor_rc_s": force.filter_s,
        "sensor_gain": 1 + force.gain_error_ratio,
        "sensor_hysteresis_N": force.hysteresis_N,
        "sensor_full_scale_N": force.full_scale_N,
        "sensor_lsb_N": lsb_of(force.full_scale_N, force.converter_bits),
    }


def _control_part(rig: Rig, announced_mm_s: float) -> dict[str, float]:
    control = rig.controller
    return {
        "window_start_m": control.window_start_m,
        "window_end_m": control.window_end_m,
        "reversal_m": control.reversal_m,
        "rearm_m": control.rearm_m,
        "announced_m_s": m_from_mm(announced_mm_s),
        "velocity_scale": control.velocity_scale,
        "force_limit_N": control.force_limit_N,
    }


def grid_of(rig: Rig, gesture: Gesture, surface: ForceSurface, step_s: float = STEP_s) -> Grid:
    """Cut a press into steps; raise ModelError if a duration is no whole number of steps."""
    control, reads = rig.controller, reads_of(rig)

    def steps(duration_s: float, name: str) -> int:
        count = round(duration_s / step_s)
        if abs(count * step_s - duration_s) > 1e-9:
            raise ModelError(f"{name} must be a multiple of the step {step_s:g} s, got {duration_s:g} s")
        return count

    per_tick = steps(control.tick_s, "tick_s")
    return Grid(
        settle_ticks=settle_ticks(rig),
        ticks=count_ticks(rig, gesture),
        steps_per_tick=per_tick,
        steps_per_row=math.gcd(per_tick, steps(ROW_s, "row")),
        delay_steps=steps(control.compute_s, "compute_s"),
        reads=reads,
        read_steps=max(1, steps(rig.position_sensor.burst_s / reads, "burst_s / reads")),
        average_ticks=control.average_ticks if control.averaging == "sliding" else 1,
        fewest_samples=control.fewest_samples,
        displacements=surface.displacement_mm.size,
        velocities=surface.velocity_mm_s.size,
    )


def inputs_of(surface: ForceSurface, noise: Noise) -> Inputs:
    """Bring table and noise into the kernel's shapes and units."""
    return Inputs(
        m_from_mm(surface.velocity_mm_s),
        N_from_cN(np.stack([surface.press_cN, surface.release_cN])),
        noise.position_m,
        noise.force_N,
        noise.effort_ratio,
    )
