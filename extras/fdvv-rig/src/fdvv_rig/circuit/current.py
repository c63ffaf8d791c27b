"""The recommended rig's linear current drive and its load cell: what follows from their parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fdvv.protocol.messages import CN64_PER_cN
from fdvv.protocol.tables import Settings
from fdvv_rig.circuit.circuit import Circuit
from fdvv_rig.circuit.levels import PowerState, levels

LIMIT_V, LIMIT_ohm = 15000 * 4.75, 13750.0
"""OPA548: its current limit is the first over the second and the resistor at ILIM together."""
DAC_END_V = 0.15
"""What the controller's converter does not reach, at either end."""


@dataclass(frozen=True)
class CurrentDrive:
    """The current drive at the firmware's force limit, and its loop.

    Attributes
    ----------
    force_cN, current_A, heat_W : that limit, and the coil there.
    amplifiers_W : heat of both amplifiers together there.
    reach_A : at the very ends of the converter, which a duty of 1 means.
    full_A, full_cN : as far as the converter gets. step_cN : of one of its steps.
    limit_A : of the amplifiers. compliance_V : that the coil can get, either way, at about 1 A.
    slew_A_ms : of the current, at rest. loop_Hz, loop_us : bandwidth and time constant of the current.
    zero_Hz, coil_Hz : corner of the controller, and of the coil, which it cancels.
    """

    force_cN: float
    current_A: float
    heat_W: float
    amplifiers_W: float
    reach_A: float
    full_A: float
    full_cN: float
    step_cN: float
    limit_A: float
    compliance_V: float
    slew_A_ms: float
    loop_Hz: float
    loop_us: float
    zero_Hz: float
    coil_Hz: float


@dataclass(frozen=True)
class CellReading:
    """The load cell as the controller reads it.

    Attributes
    ----------
    gain : of its amplifier. step_cN : of the converter. low_cN, high_cN : ends of the range, nominal.
    zero_mV : at the controller's pin without force.
    cutoff_Hz : of the filter. noise_cN : of bridge and amplifier, rms, in that band.
    null_cN : by how much the bridge's own null may shift the range, either way.
    """

    gain: float
    step_cN: float
    low_cN: float
    high_cN: float
    zero_mV: float
    cutoff_Hz: float
    noise_cN: float
    null_cN: float


def current_drive(circuit: Circuit, settings: Settings) -> CurrentDrive:
    """Reckon the current drive from the circuit and the firmware's limits."""
    facts, value = circuit.facts, {ref: part.value or 0.0 for ref, part in circuit.parts.items()}
    k, henry, ohm = facts["force_constant_N_A"], facts["coil_inductance_H"], value["L1"]
    supply_V = circuit.pin("PS1.+").V or 0.0
    sense_V_A = facts["sense_gain"] * value["R41"] * value["R42"] / value["R43"]
    force_N = settings.force_limit_cN64 / CN64_PER_cN / 100
    amps = force_N / k
    bridge_gain = value["R34"] / value["R33"] * (1 + value["R38"] / value["R37"])
    # the controller's zero cancels the coil's corner, so what is left is one integrator
    rate_1_s = value["R44"] / value["R42"] * bridge_gain * sense_V_A / henry
    compliance_V = supply_V - 2 * facts["amplifier_drop_V"]
    return CurrentDrive(
        force_cN=100 * force_N,
        current_A=amps,
        heat_W=amps**2 * ohm,
        amplifiers_W=amps * (supply_V - amps * (ohm + value["R41"])),
        reach_A=facts["dac_V"] / 2 / sense_V_A,
        full_A=(facts["dac_V"] / 2 - DAC_END_V) / sense_V_A,
        full_cN=100 * k * (facts["dac_V"] / 2 - DAC_END_V) / sense_V_A,
        step_cN=100 * k * facts["dac_V"] / 2 ** facts["converter_bits"] / sense_V_A,
        limit_A=LIMIT_V / (LIMIT_ohm + value["R48"]),
        compliance_V=compliance_V,
        slew_A_ms=1e-3 * compliance_V / henry,
        loop_Hz=rate_1_s / (2 * math.pi),
        loop_us=1e6 / rate_1_s,
        zero_Hz=1 / (2 * math.pi * value["R44"] * value["C20"]),
        coil_Hz=ohm / (2 * math.pi * henry),
    )


def cell_reading(circuit: Circuit) -> CellReading:
    """Reckon what the load cell's reading means."""
    facts, value = circuit.facts, {ref: part.value or 0.0 for ref, part in circuit.parts.items()}
    gain = 1 + facts["cell_gain_ohm"] / value["R52"]
    V_cN = 1e-5 * facts["cell_mV_N"] * gain
    zero_V = levels(circuit, PowerState())["CELL_REF"].V
    cutoff = 1 / (2 * math.pi * value["R53"] * value["C19"])
    noise_V = 1e-9 * facts["cell_noise_nV_rtHz"] * math.sqrt(math.pi / 2 * cutoff)
    return CellReading(
        gain=gain,
        step_cN=facts["converter_V"] / 2 ** facts["converter_bits"] / V_cN,
        low_cN=-zero_V / V_cN,
        high_cN=(facts["converter_V"] - zero_V) / V_cN,
        zero_mV=1e3 * zero_V,
        cutoff_Hz=cutoff,
        noise_cN=noise_V * gain / V_cN,
        null_cN=1e-3 * facts["cell_null_mV"] * gain / V_cN,
    )
