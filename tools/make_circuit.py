"""Write hardware/circuit (diagrams, netlists, wiring, values) and docs/reference/bill.md from the circuit."""

from __future__ import annotations

from pathlib import Path

from fdvv.io.files import write_atomic
from fdvv_rig.bill import bill_page, load_bill
from fdvv_rig.circuit.circuit import load_circuit
from fdvv_rig.circuit.circuit_report import circuit_files
from fdvv_rig.circuit.rules import require_sound

ROOT = Path(__file__).parents[1]
CIRCUIT = ROOT / "hardware" / "circuit"
BILL = ROOT / "docs" / "reference" / "bill.md"


def files() -> dict[Path, str]:
    """Return every file with its text."""
    circuit = load_circuit()
    require_sound(circuit, "circuit.toml")
    made = {CIRCUIT / name: text for name, text in circuit_files(circuit).items()}
    return {**made, BILL: bill_page(load_bill(circuit))}


if __name__ == "__main__":
    for path, text in files().items():
        write_atomic(path, text)
        print(path.relative_to(ROOT))
