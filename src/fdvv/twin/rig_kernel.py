"""From records to the compiled rig's structures: flattened, in SI, cut into steps."""

from __future__ import annotations

import math

from fdvv.errors import ModelError
from fdvv.twin._finger import Finger
from fdvv.twin._kernel import Grid, Plant
from fdvv.twin._noise import lsb_of
from fdvv.twin._rig import Rig
from fdvv.twin._rig_senses import ForceSensor

STEP_s = 1e-5
ROW_s = 1e-4
HUNT_CROSSLEY = 1.5
"""Loss per alpha in F = k d (1 + 1.5 alpha d') (Hunt and Crossley 1975)."""
KEYCAP_KINDS = {"none": 0.0, "force": 1.0, "acceleration": 2.0}


def plant_of(rig: Rig, finger: Finger, step_s: float = STEP_s) -> Plant:
    """Flatten everything constant while a rig runs, in SI."""
    return Plant(
        **_finger_part(rig, finger),
        **_coil_part(rig),
        **_mechanics_part(rig),
        **_servo_part(rig),
        **_exciter_part(rig),
        **_sensing_part(rig),
        **_keycap_part(rig),
        step_s=step_s,
    )


def _finger_part(rig: Rig, finger: Finger) -> dict[str, float]:
    return {
        "finger_stiffness_N_m": finger.impedance.stiffness_N_m,
        "finger_damping_N_s_m": finger.impedance.damping_N_s_m,
        **flesh_part(finger),
        **worn_part(rig.force_sensor),
    }


def flesh_part(finger: Finger) -> dict[str, float]:
    """Flatten what every press has of a finger, whatever its gesture."""
    pulp = finger.pulp
    relaxing = 1 - pulp.relaxed_ratio
    return {
        "finger_mass_kg": finger.impedance.mass_kg,
        "pulp_scale_N": pulp.scale_N,
        "pulp_exponent_1_m": pulp.exponent_1_m,
        "pulp_relaxed_ratio": pulp.relaxed_ratio,
        "pulp_fast_ratio": relaxing * pulp.fast_share,
        "pulp_slow_ratio": relaxing * (1 - pulp.fast_share),
        "pulp_fast_s": pulp.fast_s,
        "pulp_slow_s": pulp.slow_s,
        "strap_N": pulp.strap_N,
        "strap_m": math.log1p(pulp.strap_N / (pulp.relaxed_ratio * pulp.scale_N)) / pulp.exponent_1_m,
    }


def worn_part(sensor: ForceSensor) -> dict[str, float]:
    """Flatten the mechanics of the sensor on the fingertip."""
    return {
        "sensor_mass_kg": sensor.mass_kg,
        "contact_stiffness_N_m": sensor.contact_stiffness_N_m,
        "contact_loss_s_m": HUNT_CROSSLEY * sensor.contact_loss_s_m,
    }


def _coil_part(rig: Rig) -> dict[str, float]:
    coil = rig.coil
    same = ("resistance_ohm", "bridge_ohm", "source_ohm", "inductance_H", "reluctance_H_m", "copper_1_K")
    more = ("force_constant_N_A", "heat_K_W", "heat_s", "supply_V")
    return {
        **{name: getattr(coil, name) for name in same + more},
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
        "gravity_m_s2": mover.gravity_m_s2,
        "coulomb_N": mover.coulomb_N,
        "presliding_m": mover.presliding_m,
        "viscous_N_s_m": mover.viscous_N_s_m,
        "stop_stiffness_N_m": stops.bottom_stiffness_N_m,
        "stop_loss_s_m": HUNT_CROSSLEY * stops.bottom_loss_s_m,
        "top_stiffness_N_m": stops.top_stiffness_N_m,
        "top_loss_s_m": HUNT_CROSSLEY * stops.top_loss_s_m,
    }


def _servo_part(rig: Rig) -> dict[str, float]:
    servo = rig.servo
    per_us = 1e-3 / servo.pulse_us_mm
    return {
        "servo_zero_us": servo.pulse_zero_us,
        "servo_m_us": per_us,
        "servo_frame_s": servo.frame_s,
        "servo_deadband_m": per_us * servo.deadband_us,
        "servo_m_s": 1e-3 * servo.speed_mm_s,
        "servo_lag_s": servo.lag_s,
        "servo_play_m": servo.play_m,
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
        "amplifier_V_count": e.drive_V / 2047,
        "amplifier_clip_V": e.clip_V,
        "amplifier_rate": 2 * math.pi * e.filter_Hz,
        "vibration_latency_s": e.latency_s,
        "vibration_jitter_s": e.jitter_s,
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
        "sensor_hysteresis_N": force.hysteresis_N,
        "sensor_full_scale_N": force.full_scale_N,
        "sensor_lsb_N": lsb_of(force.full_scale_N, force.converter_bits),
    }


def _keycap_part(rig: Rig) -> dict[str, float]:
    cap = rig.keycap_sensor
    return {
        "keycap_kind": KEYCAP_KINDS[cap.kind],
        "keycap_full_scale": cap.full_scale_m_s2 if cap.kind == "acceleration" else cap.full_scale_N,
        "keycap_rate": 2 * math.pi * cap.bandwidth_Hz,
        "keycap_steps": 2.0**cap.converter_bits,
    }


def grid_of(rig: Rig, step_s: float = STEP_s) -> Grid:
    """Cut a tick into steps; raise ModelError if a duration is no whole number of steps."""
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
