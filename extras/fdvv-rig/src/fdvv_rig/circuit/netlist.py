"""Netlists of a circuit: KiCad's s-expressions, JSON, and the table a person wires by."""

from __future__ import annotations

import itertools
from typing import Any

from fdvv_rig.circuit.circuit import Circuit

FOOTPRINTS = {
    "resistor": "Resistor_THT:R_Axial_DIN0207_L6.3mm_D2.5mm_P10.16mm_Horizontal",
    "capacitor": "Capacitor_THT:C_Disc_D5.0mm_W2.5mm_P5.00mm",
    "diode": "Diode_THT:D_DO-35_SOD27_P7.62mm_Horizontal",
    "suppressor": "Diode_SMD:D_SMB",
}


def to_kicad(circuit: Circuit) -> str:
    """Write the netlist that KiCad's board editor reads (export, version E)."""
    lines = ['(export (version "E")', f"  (design (source {_quoted(circuit.title)}))", "  (components"]
    for part in circuit.parts.values():
        value = part.text or part.kind.name
        foot = FOOTPRINTS.get(part.kind.name, "")
        lines.append(f"    (comp (ref {_quoted(part.ref)}) (value {_quoted(value)})")
        lines.append(f"      (footprint {_quoted(foot)}) (description {_quoted(part.kind.about)}))")
    lines += ["  )", "  (nets"]
    for code, (net, pins) in enumerate(circuit.nets.items(), start=1):
        lines.append(f'    (net (code "{code}") (name {_quoted(net)})')
        lines += [f"      (node (ref {_quoted(r)}) (pin {_quoted(p)}))" for r, _, p in _split(pins)]
        lines[-1] += ")"
    return "\n".join([*lines, "  )", ")", ""])


def _split(pins: tuple[str, ...]) -> list[tuple[str, str, str]]:
    return [pin.partition(".") for pin in pins]


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', "'") + '"'


def to_document(circuit: Circuit) -> dict[str, Any]:
    """Return parts and nets as plain data; values in SI units, their unit beside."""
    parts = [
        {
            "ref": part.ref,
            "kind": part.kind.name,
            "about": part.kind.about,
            "value": part.value,
            "unit": part.unit,
            "bill": part.bill,
            "pins": {name: circuit.net_of.get(f"{part.ref}.{name}") for name in part.kind.pins},
        }
        for part in circuit.parts.values()
    ]
    return {
        "format": "fdvv-netlist",
        "version": 1,
        "title": circuit.title,
        "parts": parts,
        "nets": [{"name": net, "pins": list(pins)} for net, pins in circuit.nets.items()],
    }


def wiring_rows(circuit: Circuit) -> list[tuple[str, str, str]]:
    """List every wire once: from, to, net.

    A net is a chain that begins at what drives it. Every pin of a ground has a wire of its own to one star:
    the coil's current must not lift what sensors measure from.
    """
    rows = []
    for net, pins in circuit.nets.items():
        if any(circuit.pin(pin).type == "ground" for pin in pins):
            rows += [(f"{net} star", _named(circuit, pin), net) for pin in pins]
            continue
        order = sorted(pins, key=lambda pin: (_rank(circuit, pin), pins.index(pin)))
        rows += [(_named(circuit, a), _named(circuit, b), net) for a, b in itertools.pairwise(order)]
    return rows


def _rank(circuit: Circuit, name: str) -> int:
    ranks = {"source": 0, "output": 1, "ground": 2, "open": 3}
    return ranks.get(circuit.pin(name).type, 4)


def _named(circuit: Circuit, name: str) -> str:
    part = circuit.part_of(name)
    value = f" ({part.text})" if part.text else ""
    pin = circuit.pin(name)
    number = f", pin {pin.number}" if pin.number else ""
    return f"{name}{value}{number}"
