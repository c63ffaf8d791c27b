"""fdvv optimize population."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.command_line import Run

POPULATION = ("optimize", "population")


@pytest.mark.slow
def test_a_grid_is_printed_as_json_that_says_simulated_and_becomes_a_prior(fdvv: Run) -> None:
    sizes = ["--people", "2", "--processes", "1", "--json"]
    grid = fdvv(*POPULATION, "grid", "--grid", "3", "--seed", "1", "--shift", "pace_mm_s=1.2", *sizes)
    assert grid.status == 0, grid.err
    assert grid.json["simulated"]
    assert grid.json["plan"]["shifts"] == {"pace_mm_s": 1.2}
    assert set(grid.json["best"]["parameters"]) >= {"actuation_mm", "y3_cN"}
    ran = fdvv(*POPULATION, "people", "--engine", "sobol", "--budget", "2", "--prior", "grid", *sizes)
    assert ran.status == 0, ran.err
    found = ran.json
    assert 0 < found["judged_ms"]["low"] <= found["judged_ms"]["median"] <= found["judged_ms"]["high"]
    assert json.loads(Path("people", "summary.json").read_text()) == found


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--workers", "1", "--processes", "1"], "exclude each other"),
        (["--shift", "pace_mm_s=fast"], "no NAME=RATIO"),
        (["--people", "0"], "not in the range"),
    ],
)
def test_what_cannot_be_is_refused_before_any_work(
    fdvv: Run, tmp_path: Path, options: list[str], said: str
) -> None:
    result = fdvv(*POPULATION, "run", *options)
    assert result.status == 2
    assert said in result.err
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("options", [["--engine", "guess"], ["--shift", "charm=2"], ["--rig", "wish"]])
def test_unknown_names_are_refused_before_any_work(fdvv: Run, tmp_path: Path, options: list[str]) -> None:
    result = fdvv(*POPULATION, "run", *options)
    assert result.status == 2
    assert "use one of" in result.err
    assert not (tmp_path / "run").exists()
