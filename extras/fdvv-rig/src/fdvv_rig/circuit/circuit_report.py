"""Everything reckoned from a circuit, as plain data, and as the files that are drawn and wired by."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from fdvv.protocol.tables import Settings
from fdvv_rig.circuit.circuit import RIGS, Circuit
from fdvv_rig.circuit.current import cell_reading, current_drive
from fdvv_rig.circuit.diagram import sheet_svgs
from fdvv_rig.circuit.filters import converter_steps, filter_values, paper_cutoff_Hz, rig_settings
from fdvv_rig.circuit.netlist import to_document, to_kicad, wiring_rows
from fdvv_rig.circuit.power import coil_drive, power_budget
from fdvv_rig.circuit.rules import check_circuit

MADE = "Made from `{}` of fdvv-rig by `tools/make_circuit.py`; do not edit."
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
        **_drive(circuit, settings),
        "settings": rig_settings(circuit, settings.reads),
    }


def _drive(circuit: Circuit, settings: Settings) -> dict[str, Any]:
    if circuit.has_cell:
        return {"coil": asdict(current_drive(circuit, settings)), "cell": asdict(cell_reading(circuit))}
    return {"coil": asdict(coil_drive(circuit, settings))}


def _made(circuit: Circuit) -> str:
    return MADE.format(RIGS["recommended" if circuit.has_cell else "paper"])


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
    free = [pin for pin in circuit.pins() if circuit.pin(pin).type == "free"]
    return page("wiring.md.j2", made=_made(circuit), wires=wiring_rows(circuit), free=free)


def values_page(circuit: Circuit, settings: Settings = SETTINGS) -> str:
    """Write what follows from the values: filters, steps, power, the coil's drive, settings."""
    if circuit.has_cell:
        return page(
            "current.md.j2",
            made=_made(circuit),
            facts=circuit.facts,
            drive=current_drive(circuit, settings),
            cell=cell_reading(circuit),
            filters=filter_values(circuit),
            rails=power_budget(circuit),
            settings=rig_settings(circuit, settings.reads),
        )
    return page(
        "values.md.j2",
        made=_made(circuit),
        facts=circuit.facts,
        parts=circuit.parts,
        filters=filter_values(circuit),
        paper_cutoff_Hz=paper_cutoff_Hz(),
        steps=converter_steps(circuit),
        rails=power_budget(circuit),
        coil=coil_drive(circuit, settings),
        derate_start_K=settings.derate_start_K,
        settings=rig_settings(circuit, settings.reads),
    )


def page(template: str, **values: object) -> str:
    """Fill a template of fdvv_rig/templates, which is Markdown: nothing is escaped."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=PackageLoader("fdvv_rig"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return made.get_template(template).render(values)
