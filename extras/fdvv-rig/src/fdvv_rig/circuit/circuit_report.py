"""Everything reckoned from a circuit, as plain data, and as the files that are drawn and wired by."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from fdvv.protocol.tables import Settings
from fdvv_rig.circuit.circuit import Circuit
from fdvv_rig.circuit.diagram import sheet_svgs
from fdvv_rig.circuit.filters import converter_steps, filter_values, paper_cutoff_Hz, rig_settings
from fdvv_rig.circuit.netlist import to_document, to_kicad, wiring_rows
from fdvv_rig.circuit.power import coil_drive, power_budget
from fdvv_rig.circuit.rules import check_circuit

MADE = "Made from `circuit.toml` of fdvv-rig by `tools/make_circuit.py`; do not edit.\n"
SETTINGS = Settings()


def circuit_report(circuit: Circuit, settings: Settings = SETTINGS) -> dict[str, Any]:
    """Reckon filters, steps, power, the coil's drive and settings of a circuit; every key bears its unit.

    settings : of the firmware, for its force limit and readings per tick.
    """
    rails = [asdict(rail) | {"margin_ratio": rail.margin_ratio} for rail in power_budget(circuit)]
    return {
        "title": circuit.title,
        "parts": len(circuit.parts),
        "nets": len(circuit.nets),
        "violations": [asdict(one) for one in check_circuit(circuit)],
        "filters": [asdict(one) for one in filter_values(circuit)],
        "paper_parts_cutoff_Hz": paper_cutoff_Hz(),
        "converter_steps": [asdict(one) for one in converter_steps(circuit)],
        "rails": rails,
        "coil": asdict(coil_drive(circuit, settings)),
        "settings": rig_settings(circuit, settings.reads),
    }


def circuit_files(circuit: Circuit) -> dict[str, str]:
    """Return every file of the circuit by its name; BuildError without schemdraw, which draws."""
    return {
        **{f"{name}.svg": svg for name, svg in sheet_svgs(circuit).items()},
        "rig.net": to_kicad(circuit),
        "rig.json": json.dumps(to_document(circuit), indent=1, ensure_ascii=False) + "\n",
        "wiring.md": wiring_page(circuit),
        "values.md": values_page(circuit),
    }


def wiring_page(circuit: Circuit) -> str:
    """Write the table that a person wires by: every wire once."""
    lines = [
        "# Wires",
        "",
        MADE,
        "Every wire once; tick it off as you solder it.",
        "",
        "| from | to | net |",
        "|---|---|---|",
    ]
    lines += [f"| {a} | {b} | {net} |" for a, b, net in wiring_rows(circuit)]
    free = [pin for pin in circuit.pins() if circuit.pin(pin).type == "free"]
    return "\n".join([*lines, "", f"Left free on purpose: {', '.join(free)}.", ""])


def values_page(circuit: Circuit, settings: Settings = SETTINGS) -> str:
    """Write what follows from the values: filters, steps, power, the coil's drive, settings."""
    lines = ["# Electrical values", "", MADE]
    lines += (
        _filter_lines(circuit) + _step_lines(circuit) + _power_lines(circuit) + _coil_lines(circuit, settings)
    )
    found = rig_settings(circuit, settings.reads)
    lines += ["", "## Settings that follow", "", "Before calibration; the others keep their defaults.", ""]
    lines += ["| setting | value |", "|---|---|", *(f"| {name} | {value} |" for name, value in found.items())]
    return "\n".join([*lines, ""])


def _filter_lines(circuit: Circuit) -> list[str]:
    rows = [
        f"| {f.name} | {f.capacitor} | {f.kind} | {f.ohm:.0f} | {f.cutoff_Hz:.1f} "
        f"({f.lowest_Hz:.1f}–{f.highest_Hz:.1f}) | {f.time_ms:.3f} | {f.snap_dB:.2f} | "
        f"{f.snap_deg:.1f} | {f.lag_um:.1f} |"
        for f in filter_values(circuit)
    ]
    snap, fast = (f"{circuit.facts[name]:g}" for name in ("snap_Hz", "fast_mm_s"))
    head = "| filter | capacitor | kind | it sees, Ω | cut-off, Hz (over tolerances) | time constant, ms |"
    head += f" gain at {snap} Hz, dB | phase there, ° | lag at {fast} mm/s, µm |"
    paper = next(f for f in filter_values(circuit) if f.name == "force")
    printed = " and ".join(f"{Hz:g}" for Hz in paper.paper_Hz)
    note = (
        f"The paper prints {printed} Hz for 333 Ω and 1 µF. Neither is right: these parts make "
        f"{paper_cutoff_Hz():.1f} Hz. The circuit's {circuit.parts['R5'].text}, the nearest that is made, "
        f"gives {paper.cutoff_Hz:.1f} Hz with the sensor's own output and R27; over the tolerance "
        f"of the capacitor both printed numbers are possible."
    )
    return ["## Filters", "", head, "|---|---|---|---|---|---|---|---|---|", *rows, "", note]


def _step_lines(circuit: Circuit) -> list[str]:
    rows = [
        f"| {s.name} | {s.net} | {s.volts_mV:.3f} | {s.value:.3f} {s.unit} | {s.full_scale:.0f} {s.unit} |"
        for s in converter_steps(circuit)
    ]
    head = ["| what | net | step at the pin, mV | step | full scale |", "|---|---|---|---|---|"]
    return ["", "## Steps of the converter", "", *head, *rows]


def _power_lines(circuit: Circuit) -> list[str]:
    rows = [
        f"| {r.source} | {r.net} | {r.V:g} | {r.usual_mA:.0f} | {r.peak_mA:.0f} | "
        f"{r.limit_mA:.0f} | {r.margin_ratio:.1f} |"
        for r in power_budget(circuit)
    ]
    head = [
        "| source | net | V | usual, mA | peak, mA | limit, mA | margin |",
        "|---|---|---|---|---|---|---|",
    ]
    return ["", "## Power", "", "All peaks of a source as if they came together.", "", *head, *rows]


def _coil_lines(circuit: Circuit, settings: Settings) -> list[str]:
    c = coil_drive(circuit, settings)
    rows = [
        f"| force limit of the firmware | {c.force_cN:.0f} cN |",
        f"| current and voltage there | {c.current_A:.2f} A, {c.volts_V:.2f} V |",
        f"| heat and warmth, held for ever | {c.heat_W:.2f} W, {c.rise_K:.0f} K "
        f"(the firmware derates from {settings.derate_start_K} K) |",
        f"| the bridge chops at | {c.chop_A:.2f} A, {c.chop_cN:.0f} cN |",
        f"| heat and warmth of the bridge | {c.bridge_W:.2f} W, {c.bridge_rise_K:.0f} K |",
        f"| ripple at 23.4 kHz, worst duty | {c.ripple_A:.3f} A, {c.ripple_cN:.0f} cN peak to peak |",
        f"| the same at 732 Hz | {c.default_ripple_cN:.0f} cN: why the firmware sets its timer itself |",
        f"| time constant of the coil | {c.electrical_ms:.2f} ms |",
        f"| dip of C4 in a period | {1e3 * c.bulk_dip_V:.0f} mV |",
        f"| warmth at full duty, `full_duty_rise_K` | {c.full_duty_rise_K:.0f} K |",
    ]
    return ["", "## Coil", "", "| what | value |", "|---|---|", *rows]
