"""The rig against what is known in closed form. Simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.firmware.core import Core
from fdvv.protocol.tables import Settings
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil, Exciter, Mover
from tests.support.inputs import inputs_at
from tests.support.loop import AWAY


def coil_error_ratio() -> float:
    """Release a coil of known constants under 1.5 times its resistance in volts, against its closed form.

    Constants of the moving-coil example of the Modelica library: 3.88 N/A, 2.86 ohm, 5.1 mH, 12 g, 8 mm.
    """
    kt, ohm, henry, kg, volts = 3.88, 2.86, 5.1e-3, 0.012, 1.5 * 2.86
    coil = Coil(
        force_constant_N_A=kt,
        resistance_ohm=ohm,
        inductance_H=henry,
        droop_ratio=0.0,
        bridge_ohm=0.0,
        source_ohm=0.0,
        reluctance_H_m=0.0,
        copper_1_K=0.0,
        command_bits=0,
    )
    free = Mover(mass_kg=kg, gravity_m_s2=0.0, coulomb_N=0.0, viscous_N_s_m=0.0)
    plant = RigPlant(Rig(coil=coil, mover=free, exciter=Exciter(fitted="no")), AWAY, seed=None)
    duty = round(-volts / coil.supply_V * 32768)
    for _ in range(40):
        plant.step(duty, True, 0)
    trace, delay_s = plant.record(), plant.rig.controller.compute_s
    t = np.maximum(trace.t_s - delay_s, 0.0)
    moving = (trace.t_s > delay_s) & (trace.displacement_mm < 6.0)
    # v'' + R/L v' + k2/(m L) v = k V / (m L), at rest at first
    decay, push = ohm / (2 * henry), -duty / 32768 * coil.supply_V / kt
    omega = np.sqrt(kt**2 / (kg * henry) - decay**2)
    expected = push * (1 - np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t)))
    error = trace.cap_velocity_mm_s / 1000 - expected
    return float(np.abs(error[moving]).max() / np.abs(expected[moving]).max())


def mean_response(frequency_Hz: float, ticks: int = 25, tick_us: int = 1000) -> tuple[float, float]:
    """Return the attenuation of a sine by the firmware's sliding mean, and that of the closed form."""
    settings = replace(Settings(), tick_us=tick_us, sliding_ticks=ticks)
    t = np.arange(4000 + ticks) * 1e-6 * tick_us  # whole periods of whole hertz, after the start
    core = Core(settings)
    out = core.run(inputs_at(settings, 2.0 + np.sin(2 * np.pi * frequency_Hz * t)))
    place = out["displacement_um16"][ticks:] / 16000 - 2.0
    turns = np.exp(-2j * np.pi * frequency_Hz * t[ticks:])
    x = np.pi * frequency_Hz * 1e-6 * tick_us
    return 2 * float(np.abs(np.mean(place * turns))), float(np.abs(np.sin(ticks * x) / (ticks * np.sin(x))))


def ripple_N(coil: Coil, switching_Hz: float, ratio: float = 0.5) -> float:
    """Return the ripple of the force, peak to peak, under a switched supply.

    It is what averaging the duty leaves out. A locked coil between 0 and the supply, settled: the current
    rises and falls on exponentials.
    """
    ohm = coil.resistance_ohm + coil.bridge_ohm
    rise, fall = (np.exp(-part * ohm / (coil.inductance_H * switching_Hz)) for part in (ratio, 1 - ratio))
    amps = coil.supply_V / ohm * (1 - rise) * (1 - fall) / (1 - rise * fall)
    return float(coil.force_constant_N_A * amps)
