"""fdvv study simulate."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.command_line import Run
from tests.support.study_people import frozen_study


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return frozen_study(tmp_path / "s", rounds=1).folder


def test_a_study_is_run_and_what_it_says_is_simulated(fdvv: Run, study: Path) -> None:
    ran = fdvv("study", "simulate", study, "--people", "1", "--fast")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("simulated: demo, 1 simulated participant done")
    assert "Nothing was pressed" in ran.out
    assert "P01" in ran.out
    again = fdvv("study", "simulate", study, "--people", "1", "--fast", "--json")
    assert again.json["simulated"] is True
    assert again.json["sessions"] == []
    assert again.json["finished"] == ["P01"]
