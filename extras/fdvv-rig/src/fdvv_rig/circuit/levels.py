"""Direct voltage of every net and the resistance behind it, solved at once."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray
from fdvv_rig.circuit.circuit import Circuit

SOURCE_ohm, LINK_ohm = 0.01, 0.02
"""Inside a supply; a closed contact or fuse."""
LEAK_S = 1e-12
"""Of every net to ground, so that a net without a path to anywhere shows: by its resistance."""
FLOATS_ohm = 1e9
LINKS = ("resistor", "thermistor", "coil", "exciter")
CONTACTS = ("fuse", "switch")


@dataclass(frozen=True)
class PowerState:
    """What drives.

    Attributes
    ----------
    high : outputs are high, else low. released : references of parts whose outputs let go.
    absent : references of parts that are pulled out. contacts_open : no contact is closed.
    """

    high: bool = True
    released: Collection[str] = ()
    absent: Collection[str] = ()
    contacts_open: bool = False


@dataclass(frozen=True)
class Level:
    """A net's voltage (V) in a state, and the resistance behind it (ohm); floats if nothing holds it."""

    V: float
    ohm: float

    @property
    def floats(self) -> bool:
        """Return whether nothing holds the net."""
        return self.ohm > FLOATS_ohm


def levels(circuit: Circuit, state: PowerState) -> dict[str, Level]:
    """Solve the nets' direct voltages: capacitors and diodes carry no current, coils are their resistance.

    An open pin lets go; what a pull-up makes of its net is then its level.
    """
    names = list(circuit.nets)
    place = {name: i for i, name in enumerate(names)}
    conductance = LEAK_S * np.eye(len(names))
    current = np.zeros(len(names))
    for a, b, ohm in _links(circuit, state):
        _join(conductance, place[a], place[b], 1 / ohm)
    for net, V, ohm in _drives(circuit, state):
        conductance[place[net], place[net]] += 1 / ohm
        current[place[net]] += V / ohm
    inverse = np.linalg.inv(conductance)
    volts = inverse @ current
    return {name: Level(float(volts[i]), float(inverse[i, i])) for i, name in enumerate(names)}


def _join(conductance: FloatArray, a: int, b: int, siemens: float) -> None:
    conductance[a, a] += siemens
    conductance[b, b] += siemens
    conductance[a, b] -= siemens
    conductance[b, a] -= siemens


def _links(circuit: Circuit, state: PowerState) -> list[tuple[str, str, float]]:
    found = []
    for kind in (*LINKS, *CONTACTS):
        for part, a, b in circuit.between(kind):
            opened = kind == "switch" and state.contacts_open
            if a and b and a != b and not opened and part.ref not in state.absent:
                found.append((a, b, LINK_ohm if kind in CONTACTS else part.value or LINK_ohm))
    return found


def _drives(circuit: Circuit, state: PowerState) -> list[tuple[str, float, float]]:
    found = []
    for name, net in circuit.net_of.items():
        pin, ref = circuit.pin(name), circuit.part_of(name).ref
        if ref in state.absent:
            continue
        if pin.type == "ground":
            found.append((net, 0.0, SOURCE_ohm))
        elif pin.type == "source":
            found.append((net, pin.V or 0.0, SOURCE_ohm))
        elif pin.type == "output" and ref not in state.released:
            found.append((net, (pin.V or 0.0) if state.high else 0.0, pin.ohm))
    return found
