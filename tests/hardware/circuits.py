"""The rigs' circuits, and the paper's changed."""

from __future__ import annotations

from dataclasses import replace

from fdvv_rig.circuit.circuit import Circuit, Component, Pin, load_circuit

CIRCUIT = load_circuit()
RECOMMENDED = load_circuit(rig="recommended")
BOTH = (CIRCUIT, RECOMMENDED)


def with_nets(circuit: Circuit = CIRCUIT, **nets: tuple[str, ...]) -> Circuit:
    """Return a circuit with some nets replaced; an empty one is left out."""
    changed = {**circuit.nets, **nets}
    return replace(circuit, nets={name: pins for name, pins in changed.items() if pins})


def with_value(ref: str, value: float, circuit: Circuit = CIRCUIT) -> Circuit:
    part = replace(circuit.parts[ref], value=value)
    return replace(circuit, parts={**circuit.parts, ref: part})


def with_pin(ref: str, pin: str, circuit: Circuit = CIRCUIT, **changes: object) -> Circuit:
    """Return a circuit in which one part's pin is another, its kind being its own from now on."""
    part = circuit.parts[ref]
    changed: Pin = replace(part.kind.pins[pin], **changes)  # type: ignore[arg-type]
    kind = replace(part.kind, pins={**part.kind.pins, pin: changed})
    made: Component = replace(part, kind=kind)
    return replace(circuit, parts={**circuit.parts, ref: made})


def without(ref: str, circuit: Circuit = CIRCUIT) -> Circuit:
    """Return a circuit without a part; remaining nets of a single pin are left out with their pin marked."""
    nets = {
        name: tuple(pin for pin in pins if pin.partition(".")[0] != ref)
        for name, pins in circuit.nets.items()
    }
    parts = {name: part for name, part in circuit.parts.items() if name != ref}
    return replace(circuit, parts=parts, nets=nets)
