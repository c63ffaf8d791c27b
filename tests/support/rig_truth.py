"""What identification should find of a twin's rig, and rigs to find it of. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv.twin.trace import Trace

ROOM_mm = 0.05
"""To the stops, in what is judged."""
SLIDING_mm_s = 15.0
"""Below it friction may hold."""


def draw_fast_rig(seed: int, drive: str) -> tuple[Rig, Finger]:
    """Draw a rig of a 4 kHz loop that stands anywhere between upright and lying, and a finger."""
    random = np.random.default_rng(seed)
    rig, finger = draw_rig(random), draw_finger(random)
    return replace(
        rig,
        controller=replace(rig.controller, tick_s=2.5e-4, compute_s=1e-4),
        position_sensor=replace(rig.position_sensor, burst_s=2e-4),
        coil=replace(rig.coil, drive=drive),
        mover=replace(rig.mover, gravity_m_s2=random.uniform(0.0, 9.81)),
    ), finger


def rig_truth(rig: Rig) -> RigModel:
    """Return the rig's effective parameters, as its finger's sensor would measure them."""
    coil, mover, position = rig.coil, rig.mover, rig.position_sensor
    sensor, loop = 1 + rig.force_sensor.gain_error_ratio, 1 + rig.controller.gain_error_ratio
    bend, best = coil.droop_ratio / (500.0 * coil.stroke_m) ** 2, 1e3 * coil.centre_m
    scale, ohm = sensor * loop, coil.resistance_ohm + coil.bridge_ohm
    voltage = coil.drive == "voltage"
    emf = sensor * coil.force_constant_N_A**2 / ohm / scale**2 if voltage else 0.0
    lag_s = coil.inductance_H / ohm if voltage else coil.current_loop_s
    reads = position.reads
    return RigModel(
        gain=(scale * (1 - bend * best**2), scale * 2 * bend * best, -scale * bend),
        delay_s=rig.controller.compute_s + 0.5 * rig.controller.tick_s + lag_s,
        electric_lag_s=lag_s,
        position_lag_s=1 / (2 * np.pi * position.bandwidth_Hz) + 0.5 * position.burst_s * (reads - 1) / reads,
        drag_N_s_m=sensor * mover.viscous_N_s_m + emf,
        back_emf_N_s_m=emf,
        friction_cN=100 * sensor * mover.coulomb_N,
        weight_cN=100 * sensor * mover.mass_kg * mover.gravity_m_s2,
        mass_g=1e3 * sensor * mover.mass_kg,
        play_cN=100 * sensor * rig.force_sensor.hysteresis_N,
    )


def missed_cN(known: RigModel, rig: Rig, traces: Sequence[Trace], travel_mm: float) -> float:
    """Return the rms error of the force that a known rig predicts at the true motion, between the stops."""
    found = []
    for t in traces:
        motion = (t.displacement_mm, t.cap_velocity_mm_s, t.cap_acceleration_m_s2)
        command = np.interp(t.t_s, t.t_s[t.tick], t.commanded_cN[t.tick])
        predicted_cN = known.finger_force_cN(t.t_s, *motion, command)
        stop = min(travel_mm, float(t.stop_mm.min())) - ROOM_mm
        between = (t.displacement_mm > 0.1) & (t.displacement_mm < stop) & (t.force_cN > 1.0)
        moving = between & (np.abs(t.cap_velocity_mm_s) > SLIDING_mm_s)
        found.append((predicted_cN - (1 + rig.force_sensor.gain_error_ratio) * t.force_cN)[moving])
    return float(np.sqrt(np.mean(np.concatenate(found) ** 2)))
