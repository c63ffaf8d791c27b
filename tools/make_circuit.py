"""Write both circuits of hardware/ (diagrams, netlists, wiring, values) and docs/reference/bill.md."""

from __future__ import annotations

from pathlib import Path

from fdvv.io.files import write_atomic
from fdvv_rig.bill import bill_page, load_bill
from fdvv_rig.circuit.circuit import RIGS, load_circuit
from fdvv_rig.circuit.circuit_report import circuit_files
from fdvv_rig.circuit.rules import require_sound

ROOT = Path(__file__).parents[1]
FOLDERS = {
    name: ROOT / "hardware" / folder
    for name, folder in (("paper", "circuit"), ("recommended", "circuit-recommended"))
}
BILL = ROOT / "docs" / "reference" / "bill.md"


def files() -> dict[Path, str]:
    """Return every file with its text."""
    circuits = {rig: load_circuit(rig=rig) for rig in RIGS}
    made: dict[Path, str] = {}
    for rig, circuit in circuits.items():
        require_sound(circuit, RIGS[rig])
        made |= {FOLDERS[rig] / name: text for name, text in circuit_files(circuit).items()}
    # `fdvv hardware circuit --rig recommended -o FOLDER` writes its table of wires
    del made[FOLDERS["recommended"] / "wiring.md"]
    return {**made, BILL: bill_page(*(load_bill(circuits[rig]) for rig in ("paper", "recommended")))}


if __name__ == "__main__":
    for path, text in files().items():
        write_atomic(path, text)
        print(path.relative_to(ROOT))
