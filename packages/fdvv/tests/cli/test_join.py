"""fdvv join."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.command_line import Run

BOARD = "# fdvv-capture 1\n# channel F force_cN scale=0.5 zero=10\nF 1000 10\nF 2000 30\nF 3000 50\n"
CAMERA = "time_s,left_x_mm,left_y_mm,left_z_mm\n0.0,0,0,1\n0.01,0,0,2\n"


@pytest.fixture
def logs(tmp_path: Path) -> list[str]:
    (tmp_path / "board.log").write_text(BOARD)
    (tmp_path / "camera.csv").write_text(CAMERA)
    return ["board.log", "camera.csv"]


def test_logs_of_two_instruments_become_one_recording(fdvv: Run, logs: list[str]) -> None:
    made = fdvv("join", *logs, "-o", "a.recording.jsonl", "--name", "bell", "--tip-mass-g", "2", "--json")

    assert made.status == 0
    assert made.json["bench"]["tip_mass_g"] == 2
    assert set(made.json["clocks"]) == {"board", "table"}
    assert fdvv("check", "a.recording.jsonl").status == 0


def test_a_marker_that_is_not_there_is_one_line(fdvv: Run, logs: list[str]) -> None:
    made = fdvv("join", *logs, "-o", "a.recording.jsonl", "--name", "bell", "--marker", "right")

    assert made.status == 2
    assert "no take has a marker 'right'; there are 'left'" in made.err
    assert made.err.count("\n") == 1


def test_a_recording_that_is_there_is_not_written_over(fdvv: Run, logs: list[str]) -> None:
    again = ("join", *logs, "-o", "a.recording.jsonl", "--name", "bell")
    assert fdvv(*again).status == 0

    assert fdvv(*again).status == 2
