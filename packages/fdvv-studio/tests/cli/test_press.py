"""fdvv press: the simulated person on a simulated real button."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from tests.support.command_line import Run


def test_a_real_button_is_pressed_at_every_speed_and_says_that_it_is_simulated(fdvv: Run) -> None:
    ran = fdvv("press", "--button", "mx-brown", "--speed", "60", "--speed", "150", "--presses", "2", "--json")
    report = json.loads(ran.out)
    assert report["simulated"]
    assert [row["asked_mm_s"] for row in report["presses"]] == [60.0, 60.0, 150.0, 150.0]
    for row in report["presses"]:
        assert 0.5 < row["achieved_mm_s"] / row["asked_mm_s"] < 1.5
        assert report["quasi_static_peak_cN"] - 3 < row["before_stop_cN"] < 100
        assert row["largest_cN"] > row["before_stop_cN"]
        assert row["closing_ms"] > 0
    assert "(simulated)" in fdvv("press", "--button", "mx-brown", "--speed", "60", "--presses", "1").out


def test_the_same_seed_gives_the_same_presses_and_another_gives_others(fdvv: Run) -> None:
    def output(seed: str) -> str:
        return fdvv("press", "--button", "hp-pr1101u", "--speed", "90", "--seed", seed, "--json").out

    assert output("4") == output("4")
    assert output("4") != output("5")


def test_the_file_holds_every_row_of_every_press(fdvv: Run, tmp_path: Path) -> None:
    path = tmp_path / "presses.csv"
    ran = fdvv("press", "--button", "mx-red", "--speed", "120", "--presses", "2", "-o", str(path), "--json")
    with path.open() as file:
        rows = list(csv.DictReader(file))
    largest = [max(float(r["force_cN"]) for r in rows if r["press"] == n) for n in ("1", "2")]
    reported_cN = [row["largest_cN"] for row in json.loads(ran.out)["presses"]]
    assert all(abs(a - b) < 1e-3 * b for a, b in zip(largest, reported_cN, strict=True))
    assert {row["closed"] for row in rows} == {"0", "1"}


def test_an_unknown_button_is_refused_in_one_line_with_those_there_are(fdvv: Run) -> None:
    ran = fdvv("press", "--button", "nix")
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert "mx-clear" in ran.err
