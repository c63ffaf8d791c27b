"""What others did before: which grids a run and an experiment may begin from, and that they do."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from fdvv.errors import InputError
from fdvv_people.optimize.experiment.experiment import judge_experiment, run_experiment
from fdvv_people.optimize.experiment.html import experiment_html
from fdvv_people.optimize.experiment.setup import ExperimentSetup
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population
from fdvv_people.optimize.run.begin import experiment_prior, read_grid
from tests.support.executors import Here
from tests.support.grids import grid


@pytest.fixture(scope="module")
def grids(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("others")
    return grid(folder / "easy", "easy"), grid(folder / "hard", "hard", 6)


def test_each_level_begins_from_its_own_grid(grids: tuple[Path, Path]) -> None:
    found = experiment_prior(grids[::-1], 1)
    assert {level: len(trials) for level, trials in found.items()} == {"easy": 5, "hard": 6}
    assert found["hard"] == read_grid(grids[1]).prior()
    assert experiment_prior((), 1) == {}


def test_a_level_without_a_grid_or_with_two_is_refused(grids: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="hard: is a level without a grid; name one grid per level"):
        experiment_prior(grids[:1], 1)
    with pytest.raises(InputError, match="is a second grid of the level easy"):
        experiment_prior((grids[0], *grids), 1)


def test_what_is_no_finished_grid_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds no grid that is finished"):
        read_grid(tmp_path)
    runs = PopulationPlan(people=1, engine="sobol", budget=1, judged=1, rounds=2)
    run_population(tmp_path / "runs", runs, Here())
    with pytest.raises(InputError, match="holds runs of many people, not a grid"):
        read_grid(tmp_path / "runs")


def test_an_experiment_trains_from_what_others_did_and_says_so(
    grids: tuple[Path, Path], tmp_path: Path
) -> None:
    prior = experiment_prior(grids, 2)
    setup = ExperimentSetup(people=3, trials=1, presses=2, rounds=1, engine="gp", seed=2, prior=prior)
    result = run_experiment(tmp_path, setup, Here())
    kept = msgspec.json.decode((tmp_path / "training" / "person-02-hard" / "optimize.json").read_bytes())
    assert kept["prior"] == msgspec.json.decode(msgspec.json.encode(prior["hard"]))
    assert result.to_dict()["prior_designs"] == {"easy": 5, "hard": 6}
    page = experiment_html(result, judge_experiment(result))
    assert "the mean scores that other simulated people gave 5 designs (easy) and 6 designs (hard)" in page
    again = run_experiment(tmp_path, setup, Here())
    assert again.observations == result.observations
    with pytest.raises(InputError, match="was begun from other trials of others"):
        run_experiment(tmp_path, msgspec.structs.replace(setup, prior={}), Here())
