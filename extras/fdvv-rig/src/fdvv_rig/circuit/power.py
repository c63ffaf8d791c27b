"""What every rail has to give, what the coil and its bridge take, and what becomes warm."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fdvv.protocol.messages import CN64_PER_cN
from fdvv.protocol.tables import Settings
from fdvv_rig.circuit.circuit import Circuit
from fdvv_rig.circuit.levels import CONTACTS

ILIM_V = 64e3
"""DRV8871: the current at which it chops is this over the resistor at ILIM."""


@dataclass(frozen=True)
class Rail:
    """What a source gives.

    source : its pin. net : the one that it feeds. V : voltage. limit_mA : the most it can give.
    usual_mA : what its consumers take usually; peak_mA : at most.
    """

    source: str
    net: str
    V: float
    limit_mA: float
    usual_mA: float
    peak_mA: float

    @property
    def margin_ratio(self) -> float:
        """Limit over the most that is taken."""
        return self.limit_mA / self.peak_mA if self.peak_mA else math.inf


def power_budget(circuit: Circuit) -> tuple[Rail, ...]:
    """Sum what hangs on every source, through fuses, contacts and regulators.

    The peaks of one source are taken as if they came together; that of a bridge is its chopping current.
    """
    sources = [n for n in circuit.net_of if circuit.pin(n).type == "source"]
    return tuple(_rail(circuit, name) for name in sorted(sources))


def _rail(circuit: Circuit, source: str) -> Rail:
    pin, net = circuit.pin(source), circuit.net_of[source]
    usual, peak = _taken(circuit, source)
    return Rail(source, net, pin.V or 0.0, pin.limit_mA or 0.0, round(usual, 1), round(peak, 1))


def _taken(circuit: Circuit, source: str) -> tuple[float, float]:
    usual = peak = 0.0
    for net in reached(circuit, circuit.net_of[source]):
        for name in circuit.nets[net]:
            pin = circuit.pin(name)
            if pin.type != "supply":
                continue
            one, most = _consumer(circuit, name, circuit.pin(source).V or 0.0)
            usual, peak = usual + one, peak + most
    return usual, peak


def _consumer(circuit: Circuit, name: str, V: float) -> tuple[float, float]:
    pin = circuit.pin(name)
    if not pin.feeds:
        return pin.mA, pin.peak_mA
    fed = f"{circuit.part_of(name).ref}.{pin.feeds}"
    ratio = (circuit.pin(fed).V or 0.0) / (V * pin.efficiency_ratio)
    usual, peak = _taken(circuit, fed)
    return usual * ratio, peak * ratio


def reached(circuit: Circuit, net: str) -> list[str]:
    """Return the nets that a net feeds through fuses and closed contacts, itself first."""
    found = [net]
    links = [(a, b) for kind in CONTACTS for _, a, b in circuit.between(kind)]
    for here in found:
        ends = [b if a == here else a for a, b in links if here in (a, b)]
        found += [end for end in ends if end not in found]
    return found


@dataclass(frozen=True)
class CoilDrive:
    """The coil at the firmware's force limit, and when its bridge chops.

    Attributes
    ----------
    current_A, volts_V, heat_W, rise_K : at the force limit, held for ever.
    force_cN : that limit. chop_A, chop_cN : current at which the bridge chops, and its force.
    bridge_W, bridge_rise_K : in the bridge at the force limit.
    ripple_A, ripple_cN : of the PWM, peak to peak, at the worst duty of a half.
    default_ripple_cN : the same at 732 Hz, at which the controller's core libraries would leave the timer.
    electrical_ms : time constant of the coil. bulk_dip_V : of the bulk capacitor in one period at that limit.
    full_duty_rise_K : warmth that full duty would end at, as the settings state it.
    """

    force_cN: float
    current_A: float
    volts_V: float
    heat_W: float
    rise_K: float
    chop_A: float
    chop_cN: float
    bridge_W: float
    bridge_rise_K: float
    ripple_A: float
    ripple_cN: float
    default_ripple_cN: float
    electrical_ms: float
    bulk_dip_V: float
    full_duty_rise_K: float


def coil_drive(circuit: Circuit, settings: Settings) -> CoilDrive:
    """Reckon the coil's drive from the circuit and the firmware's limits."""
    facts, ohm = circuit.facts, _value(circuit, "L1")
    V = circuit.pin("PS1.+").V or 0.0
    k, henry = facts["force_constant_N_A"], facts["coil_inductance_H"]
    force_N = settings.force_limit_cN64 / CN64_PER_cN / 100
    amps, chop = force_N / k, ILIM_V / _value(circuit, "R8")
    heat = amps**2 * ohm
    bridge = amps**2 * facts["bridge_ohm"]
    ripple = _ripple_A(V, ohm, henry, facts["pwm_Hz"])
    return CoilDrive(
        force_cN=100 * force_N,
        current_A=amps,
        volts_V=amps * (ohm + facts["bridge_ohm"]),
        heat_W=heat,
        rise_K=heat * facts["heat_K_W"],
        chop_A=chop,
        chop_cN=100 * chop * k,
        bridge_W=bridge,
        bridge_rise_K=bridge * facts["bridge_K_W"],
        ripple_A=ripple,
        ripple_cN=100 * ripple * k,
        default_ripple_cN=100 * k * _ripple_A(V, ohm, henry, 48e6 / 2**16),
        electrical_ms=1e3 * henry / ohm,
        bulk_dip_V=amps / facts["pwm_Hz"] / _value(circuit, "C4"),
        full_duty_rise_K=facts["heat_K_W"] * V**2 / ohm,
    )


def _ripple_A(V: float, ohm: float, henry: float, pwm_Hz: float) -> float:
    half = math.exp(-ohm / (henry * 2 * pwm_Hz))
    return V / ohm * (1 - half) / (1 + half)


def _value(circuit: Circuit, ref: str) -> float:
    value = circuit.parts[ref].value
    assert value is not None  # the rig's own circuit; held by its tests
    return value
