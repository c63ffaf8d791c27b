"""What follows from the parts: cut-offs, delays, steps of the converters, settings."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import Settings
from fdvv_rig.circuit.circuit import Circuit, Filter
from fdvv_rig.circuit.current import cell_reading, current_drive
from fdvv_rig.circuit.levels import PowerState, levels


@dataclass(frozen=True)
class FilterValues:
    """A filter of first order as its parts make it.

    Attributes
    ----------
    ohm, farad : what the capacitor sees, and the capacitor.
    cutoff_Hz, time_ms : nominal. lowest_Hz, highest_Hz : over the parts' tolerances.
    snap_dB, snap_deg : gain and phase at the frequency of the snap.
    lag_um : how far a cap at the fastest pace moves within the time constant; of a low pass.
    paper_Hz : what the paper prints.
    """

    name: str
    about: str
    kind: str
    capacitor: str
    ohm: float
    farad: float
    cutoff_Hz: float
    lowest_Hz: float
    highest_Hz: float
    time_ms: float
    snap_dB: float
    snap_deg: float
    lag_um: float
    paper_Hz: tuple[float, ...]


@dataclass(frozen=True)
class Step:
    """What one step of a converter means.

    volts_mV : at its pin. value, unit : of what is measured. full_scale : the most that is measured, in unit.
    """

    name: str
    net: str
    volts_mV: float
    value: float
    unit: str
    full_scale: float


def filter_values(circuit: Circuit) -> tuple[FilterValues, ...]:
    """Reckon every filter of the circuit."""
    return tuple(_values(circuit, one) for one in circuit.filters)


def _values(circuit: Circuit, one: Filter) -> FilterValues:
    part = circuit.parts[one.capacitor]
    farad, ohm = part.value or math.inf, _seen_ohm(circuit, one)
    cutoff = 1 / (2 * math.pi * ohm * farad)
    time_s = ohm * farad
    loose, tight = part.kind.tolerance, circuit.kinds["resistor"].tolerance
    snap = _gain(circuit.facts["snap_Hz"] / cutoff, one.kind == "low pass")
    return FilterValues(
        **{name: getattr(one, name) for name in ("name", "about", "kind", "capacitor", "paper_Hz")},
        ohm=ohm,
        farad=farad,
        cutoff_Hz=cutoff,
        lowest_Hz=cutoff / (1 + loose) / (1 + tight),
        highest_Hz=cutoff / (1 - loose) / (1 - tight),
        time_ms=1e3 * time_s,
        snap_dB=20 * math.log10(abs(snap)),
        snap_deg=math.degrees(cmath.phase(snap)),
        lag_um=1e3 * circuit.facts["fast_mm_s"] * time_s if one.kind == "low pass" else 0.0,
    )


def _gain(ratio: float, low: bool) -> complex:
    return 1 / (1 + 1j * ratio) if low else 1j * ratio / (1 + 1j * ratio)


def _seen_ohm(circuit: Circuit, one: Filter) -> float:
    if one.kind == "low pass":
        return levels(circuit, PowerState())[one.net].ohm
    loads = [circuit.pin(p).load_ohm for p in circuit.nets[one.net]]
    before = [
        n for _, a, b in circuit.between("capacitor") for n in (a, b) if one.net in (a, b) and n != one.net
    ]
    source = levels(circuit, PowerState())[before[0]].ohm if before else 0.0
    return source + sum(load for load in loads if load)


def paper_cutoff_Hz() -> float:
    """Return the cut-off of the parts that the paper names: 333 ohm and 1 uF."""
    return 1 / (2 * math.pi * 333.0 * 1e-6)


def converter_steps(circuit: Circuit) -> tuple[Step, ...]:
    """Return what a step of the controller's converter means on every analog net of it."""
    facts = circuit.facts
    count_V = facts["converter_V"] / 2 ** facts["converter_bits"]
    at = levels(circuit, PowerState())
    span_V = at["POSITION"].V  # of a conditioner that gives 0 to its full 5 V
    range_mm = facts["position_range_mm"]
    mm_V = range_mm / span_V
    supply = (circuit.pin("PS1.+").V or 0.0) / at["SUPPLY"].V
    top_V = facts["converter_V"]
    return (
        Step("position", "POSITION", 1e3 * count_V, 1e3 * mm_V * count_V, "um", 1e3 * range_mm),
        _force_step(circuit, count_V),
        Step("supply", "SUPPLY", 1e3 * count_V, 1e3 * supply * count_V, "mV", 1e3 * supply * top_V),
    )


def _force_step(circuit: Circuit, count_V: float) -> Step:
    facts = circuit.facts
    if circuit.has_cell:
        cell = cell_reading(circuit)
        return Step("force", "FORCE", 1e3 * count_V, cell.step_cN, "cN", cell.high_cN)
    high = facts["force_high_ratio"]
    force_V = levels(circuit, PowerState())["FORCE"].V / high * (high - facts["force_low_ratio"])
    return Step(
        "force", "FORCE", 1e3 * count_V, 100 * facts["force_range_N"] / force_V * count_V, "cN", 981.0
    )


def _zero_V(circuit: Circuit) -> float:
    """Return the voltage of the force's converter at no force."""
    if circuit.has_cell:
        return 1e-3 * cell_reading(circuit).zero_mV
    facts = circuit.facts
    return levels(circuit, PowerState())["FORCE"].V * facts["force_low_ratio"] / facts["force_high_ratio"]


def _drive_settings(circuit: Circuit) -> dict[str, int]:
    """Return the settings that follow from what a duty of 1 means to a current drive."""
    facts, amps = circuit.facts, current_drive(circuit, Settings()).reach_A
    ohm = circuit.parts["L1"].value or 0.0
    return {
        "duty_gain_q16": round(2**31 / (100 * CN64_PER_cN * amps * facts["force_constant_N_A"])),
        "full_duty_rise_K": round(facts["heat_K_W"] * ohm * amps**2),
    }


def rig_settings(circuit: Circuit, reads: int) -> dict[str, int]:
    """Return the settings of the firmware that follow from the parts, to be refined by calibration.

    reads : readings that a tick sums up.
    """
    position, force, _ = converter_steps(circuit)
    drive = _drive_settings(circuit) if circuit.has_cell else {}
    facts = circuit.facts
    counts = 2 ** facts["converter_bits"]
    return {
        "position_gain_q14": round(position.value * 1e-3 * UM16_PER_mm * 2**14 / reads),
        "position_offset_um16": round(-facts["position_range_mm"] / 2 * UM16_PER_mm),
        "force_gain_q14": round(force.value * CN64_PER_cN * 2**14),
        "force_offset_counts": round(_zero_V(circuit) / facts["converter_V"] * counts),
        **drive,
    }
