"""fdvv hardware, as a person runs it."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest

from tests.support.command_line import Run


def test_the_bill_is_printed_and_written_as_a_table(fdvv: Run) -> None:
    bill = fdvv("hardware", "bill", "--json").json
    shown = fdvv("hardware", "bill").out
    assert "HVCM-025-022-003-01" in shown
    assert "estimates" in shown
    rows = list(csv.DictReader(io.StringIO(fdvv("hardware", "bill", "--csv").out)))
    assert len(rows) == len(bill["lines"])
    ran = fdvv("hardware", "bill", "--csv", "--json")
    assert (ran.status, ran.json["error"]["source"]) == (2, "--csv")


def test_the_recommended_rig_has_a_bill_and_a_circuit_of_its_own(fdvv: Run, tmp_path: Path) -> None:
    bill = fdvv("hardware", "bill", "--rig", "recommended", "--json").json
    asked = [line["role"] for line in bill["lines"] if line["price_USD"] is None]
    assert "load cell" in asked
    assert f"{len(asked)} lines without a price" in " ".join(
        fdvv("hardware", "bill", "--rig", "recommended").out.split()
    )
    circuit = fdvv("hardware", "circuit", "--rig", "recommended", "--json", "-o", str(tmp_path / "made")).json
    assert circuit["violations"] == []
    assert circuit["coil"]["loop_Hz"] == pytest.approx(3183, abs=20)
    assert "U17.OUT" in (tmp_path / "made" / "wiring.md").read_text()


def test_a_circuit_that_would_burn_a_pin_ends_with_status_1(fdvv: Run, tmp_path: Path) -> None:
    source = Path(__file__).resolve().parents[2] / "extras/fdvv-rig/src/fdvv_rig/circuit/circuit.toml"
    text = source.read_text().replace("V = 3.135, ohm = 1.0 }\npins.GND", "V = 4.75, ohm = 1.0 }\npins.GND")
    (tmp_path / "mine.toml").write_text(text)
    ran = fdvv("hardware", "circuit", "--file", "mine.toml")
    assert ran.status == 1
    assert "U1.A4: is driven with 4.7" in ran.out
    ran = fdvv("hardware", "circuit", "--file", "mine.toml", "-o", "drawn")
    assert ran.status == 2
    assert not (tmp_path / "drawn").exists()


def test_a_file_that_is_no_circuit_is_refused(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("a = 1\n")
    ran = fdvv("hardware", "circuit", "--file", "mine.toml")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "mine.toml: format" in ran.err


def test_a_failed_selftest_names_the_part_and_leaves_no_receipt(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("hardware", "selftest", "--fault", "position-off", "-o", "receipt.json")
    assert ran.status == 1
    assert "fdvv: position sensor:" in ran.err
    assert "(simulated)" in ran.out
    assert list(tmp_path.iterdir()) == []


def test_a_fault_a_device_and_a_receipt_that_are_none_are_refused(fdvv: Run) -> None:
    assert fdvv("hardware", "selftest", "--fault", "x").status == 2
    assert fdvv("hardware", "selftest", "--device", "x").status == 2
    assert fdvv("hardware", "selftest", "-o", "receipt.txt").status == 2
    ran = fdvv("hardware", "selftest", "--device", "serial:none")
    assert (ran.status, "run it in a terminal" in ran.err) == (2, True)


@pytest.mark.slow
def test_a_sound_rig_leaves_a_receipt_and_its_calibration(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("hardware", "selftest", "--apply", "-o", "receipt.json", "--json")
    assert ran.status == 0, ran.err
    assert ran.json["passed"]
    assert "duty_gain_q16" in ran.json["settings"]
    assert (tmp_path / "receipt.json").is_file()
