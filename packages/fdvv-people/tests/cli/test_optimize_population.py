"""fdvv optimize population."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from fdvv.cli.main import cli


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["optimize", "population", *arguments])


@pytest.mark.slow
def test_a_grid_is_printed_as_json_that_says_simulated_and_becomes_a_prior(tmp_path: Path) -> None:
    first, second = str(tmp_path / "grid"), str(tmp_path / "people")
    sizes = ["--people", "2", "--processes", "1", "--json"]
    grid = invoke(first, "--grid", "3", "--seed", "1", "--shift", "pace_mm_s=1.2", *sizes)
    assert grid.exit_code == 0, grid.output
    summary = json.loads(grid.stdout)
    assert summary["simulated"]
    assert summary["plan"]["shifts"] == {"pace_mm_s": 1.2}
    assert set(summary["best"]["parameters"]) >= {"actuation_mm", "y3_cN"}
    people = invoke(second, "--engine", "sobol", "--budget", "2", "--prior", first, *sizes)
    assert people.exit_code == 0, people.output
    found = json.loads(people.stdout)
    assert 0 < found["judged_ms"]["low"] <= found["judged_ms"]["median"] <= found["judged_ms"]["high"]
    assert json.loads(Path(second, "summary.json").read_text()) == found


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--workers", "1", "--processes", "1"], "exclude each other"),
        (["--shift", "pace_mm_s=fast"], "no NAME=RATIO"),
        (["--people", "0"], "not in the range"),
    ],
)
def test_what_cannot_be_is_refused_before_any_work(tmp_path: Path, options: list[str], said: str) -> None:
    result = invoke(str(tmp_path / "run"), *options)
    assert result.exit_code == 2
    assert said in result.stderr
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("options", [["--engine", "guess"], ["--shift", "charm=2"], ["--rig", "wish"]])
def test_unknown_names_are_refused_before_any_work(tmp_path: Path, options: list[str]) -> None:
    result = invoke(str(tmp_path / "run"), *options)
    assert result.exception is not None
    assert "use one of" in str(result.exception)
    assert not (tmp_path / "run").exists()
