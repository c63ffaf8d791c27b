"""The experiment on simulated people: who meets what, what others did before, what comes out of it."""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.experiment.experiment import ExperimentResult, judge_experiment, run_experiment
from fdvv_people.optimize.experiment.html import experiment_html, write_experiment
from fdvv_people.optimize.experiment.setup import ExperimentSetup, blocks_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_people.optimize.people.week import WeekGap, a_week_later, random_design
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population
from fdvv_people.optimize.run.begin import experiment_prior, read_grid
from tests.support.executors import Here
from tests.support.experiments import invented
from tests.support.grids import grid

SMALL = ExperimentSetup(people=4, trials=2, presses=3, engine="sobol", seed=2)


class InTurn:
    """Works on chunks one after the other, the last first: what is found must not depend on it."""

    processes = 1

    def __init__(self, stop_after: int | None = None) -> None:
        self.stop_after = stop_after

    def run(
        self, work: Callable[[Any], Any], chunks: Sequence[Any]
    ) -> Generator[tuple[int, Any], None, None]:
        for done, place in enumerate(reversed(range(len(chunks)))):
            if done == self.stop_after:
                raise KeyboardInterrupt
            yield place, work(chunks[place])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("experiment") / "whole"


@pytest.fixture(scope="module")
def result(folder: Path) -> ExperimentResult:
    return run_experiment(folder, SMALL, InTurn())


def test_everybody_meets_every_button_in_every_round_at_every_level(result: ExperimentResult) -> None:
    met = Counter((o.person, o.level, o.round, o.button) for o in result.observations)
    assert len(met) == SMALL.observations == 96
    assert set(met.values()) == {1}
    assert np.isfinite(result.scores_ms()).all()


def test_an_experiment_stopped_in_training_goes_on_without_training_anybody_twice(
    folder: Path, result: ExperimentResult, tmp_path: Path
) -> None:
    with pytest.raises(KeyboardInterrupt):
        run_experiment(tmp_path, SMALL, InTurn(stop_after=3))
    kept = {path: path.read_bytes() for path in sorted(tmp_path.glob("training/*/trials.jsonl"))}
    assert len(kept) == 3
    again = run_experiment(tmp_path, SMALL, InTurn())
    assert again.observations == result.observations
    assert [t.best for t in again.trainings] == [t.best for t in result.trainings]
    assert all(path.read_bytes() == before for path, before in kept.items())


def test_another_setup_or_something_else_in_the_folder_is_refused(
    folder: Path, result: ExperimentResult, tmp_path: Path
) -> None:
    assert len(result.trainings) == 8
    shutil.copytree(folder, tmp_path / "copy")
    other = msgspec.structs.replace(SMALL, trials=3)
    with pytest.raises(InputError, match="was begun with trials 2, not 3"):
        run_experiment(tmp_path / "copy", other, InTurn())
    with pytest.raises(InputError, match="holds no experiment"):
        run_experiment(tmp_path, SMALL, InTurn())


def test_validation_is_counterbalanced_over_people() -> None:
    setup = ExperimentSetup(people=12)
    blocks = [block for person in range(12) for block in blocks_of(setup, person)]
    places = Counter((place, b) for block in blocks for place, b in enumerate(block.buttons))
    follows = Counter(pair for block in blocks for pair in pairwise(block.buttons))
    assert set(places.values()) == {8}
    assert len(follows) == 30
    assert set(follows.values()) == {8}
    firsts = Counter(blocks_of(setup, person)[0].level for person in range(12))
    assert firsts == {"easy": 6, "hard": 6}


def test_ten_people_of_the_paper_are_balanced_to_one_block() -> None:
    setup = ExperimentSetup()
    blocks = [block for person in range(10) for block in blocks_of(setup, person)]
    assert setup.observations == 240 == sum(len(block.buttons) for block in blocks)
    places = Counter((place, b) for block in blocks for place, b in enumerate(block.buttons))
    assert set(places.values()) == {6, 7}


def test_a_week_forgets_a_stated_part_of_the_practice_and_no_more() -> None:
    user = SimulatedUser(number=3, learning_ratio=0.8, learning_presses=100)
    still = WeekGap(kept_ratio=1.0, bias_ms=0, anticipated_ms=0, clock_ratio=0, pace_ratio=0)
    kept = a_week_later(user, still, 50, 1)
    # as practised as after 50 presses
    assert kept.learning_ratio == pytest.approx(0.8 * np.exp(-0.5))
    assert replace(kept, learning_ratio=user.learning_ratio) == user
    gone = a_week_later(user, msgspec.structs.replace(still, kept_ratio=0.0), 50, 1)
    assert gone.learning_ratio == user.learning_ratio


def test_another_day_differs_between_people_and_repeats_with_its_seed() -> None:
    days = [a_week_later(SimulatedUser(number=i), WeekGap(), 0, 1) for i in range(200)]
    shifts = np.array([day.bias_ms - SimulatedUser().bias_ms for day in days])
    assert np.std(shifts) == pytest.approx(5.0, rel=0.2)
    assert days[3] == a_week_later(SimulatedUser(number=3), WeekGap(), 0, 1)
    assert days[3] != a_week_later(SimulatedUser(number=3), WeekGap(), 0, 2)


def test_random_designs_hold_the_space_and_differ_between_people() -> None:
    space = paper_space()
    designs = [random_design(space, 1, person) for person in range(20)]
    assert all(not space.broken(space.checked(design)) for design in designs)
    assert len({tuple(design.values()) for design in designs}) == 20


def test_an_effect_that_is_there_is_found_with_its_size() -> None:
    verdict = judge_experiment(invented(-16.0))
    assert verdict.anova.of("button").corrected_p < 1e-6
    assert verdict.anova.of("level").effect_ss > 0
    assert verdict.anova.of("button × level").corrected_p > 0.05
    assert all(one.bonferroni_p < 0.001 for one in verdict.against)
    assert [one.reduction_ratio.value for one in verdict.against] == pytest.approx([16 / 95.5] * 5, abs=0.03)
    assert (verdict.anova.of("button").error_df, verdict.anova.people) == (35, 8)
    assert verdict.rounds_anova is not None
    assert verdict.rounds_anova.of("button").error_df == 75


def test_without_an_effect_the_optimised_button_is_not_called_better() -> None:
    verdict = judge_experiment(invented(0.0))
    assert all(one.bonferroni_p > 0.05 for one in verdict.against)


def test_a_missing_observation_is_one_clear_error() -> None:
    whole = invented(-16.0)
    with pytest.raises(ModelError, match="scores are missing, the first at person 1"):
        judge_experiment(replace(whole, observations=whole.observations[1:]))


def test_the_report_reads_like_a_result_section_and_says_simulated(
    result: ExperimentResult, tmp_path: Path
) -> None:
    verdict = judge_experiment(result)
    document = write_experiment(tmp_path, result, verdict)
    page = (tmp_path / "report.html").read_text()
    effect = verdict.anova.of("button")
    first, second = effect.corrected_df
    for text in (
        "<strong>Simulated:</strong>",
        "A two-way repeated measures ANOVA was conducted over 4 people",
        f"F({first:.2f}, {second:.2f}) = {effect.F:.2f}",
        "Greenhouse-Geisser",
        "Post-hoc tests with Bonferroni correction over 15 pairs",
        "96 observations",
        f"{verdict.means[0].mean_ms:.1f} ms",
    ):
        assert text in page
    assert page == experiment_html(result, verdict)
    assert document["observations"][5] == asdict(result.observations[5])
    assert msgspec.json.decode((tmp_path / "result.json").read_bytes())["simulated"] is True


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
