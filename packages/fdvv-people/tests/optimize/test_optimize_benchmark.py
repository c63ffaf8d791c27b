"""The comparison of engines on few people, and with a fixed design: its true values, its counts, its runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks import optimize_wishes
from benchmarks.optimize_diverse import FIXED, better_than_fixed, by_person
from benchmarks.optimize_engines import Runner, Variant, compare, runs_of
from benchmarks.optimize_people import Person, expected_ms
from benchmarks.optimize_rivals import FixedDesign
from benchmarks.optimize_tables import BASELINE, LEVELS, LOOKS, PEOPLE, SEEDS, SMOOTHED, Run, needed

from fdvv_people.optimize.paper_space import paper_model, paper_space
from tests.optimize.problems import BOWL, bowl_ms, problem, run, scored


def test_every_seed_meets_every_person_once() -> None:
    runs = [Run("gp", number, "easy") for number in range(SEEDS * PEOPLE)]
    assert len({(run.seed, run.person) for run in runs}) == SEEDS * PEOPLE
    few = runs[60:120]
    assert {run.person for run in few} == set(range(PEOPLE))
    assert len({run.seed for run in few}) == SEEDS


def test_as_good_as_a_final_value_means_from_then_on() -> None:
    reached = np.array([[90.0, 70.0, 80.0, 70.0, 60.0]])
    assert needed(reached, 75.0) == LOOKS[3]
    assert needed(reached, 95.0) == 1
    assert needed(reached, 50.0) is None


@pytest.mark.slow
@pytest.mark.parametrize("level", ["easy", "hard"])
def test_the_true_value_is_the_mean_of_many_scores(level: str) -> None:
    person = Person(7, 3, level)
    (design,) = paper_space().of_unit([[0.3, 0.4, 0.6, 0.2, 0.3, 0.4, 0.2, 0.5]])
    scores = [person.score(design, seed)["asynchrony_ms"].value for seed in range(100)]
    expected = expected_ms(person.task, paper_model(design), person.user, sessions=15)
    assert abs(np.mean(scores) - expected) < 4 * np.std(scores) / np.sqrt(len(scores))


@pytest.mark.slow
def test_runs_are_kept_and_gone_on_with(tmp_path: Path) -> None:
    variants = {"random": Variant("random", budget=2), "sobol": Variant("sobol", budget=2)}
    runner = Runner(tmp_path, first_seed=7, variants=variants)
    one = compare(tmp_path, runs_of(1, variants), runner, 1)
    two = compare(tmp_path, runs_of(2, variants), runner, 2)
    assert {run: two[run] for run in one} == one
    assert len(two) == 8


@pytest.mark.slow
def test_the_baseline_answers_in_two_ways_from_the_same_trials(tmp_path: Path) -> None:
    runner = Runner(tmp_path, first_seed=7, variants={BASELINE: Variant("gp-ei", budget=3)})
    found = runner(Run(BASELINE, 0, "easy"))
    assert found.keys() == {BASELINE, SMOOTHED}
    assert [len(values) for values in found.values()] == [3, 3]
    assert found[BASELINE][0] == found[SMOOTHED][0]


def test_a_table_of_wishes_counts_from_time_alone_and_from_the_start() -> None:
    """Every person alike, so that medians are the values themselves."""
    one = [[50.0, 5.0], [40.0, 2.0], [41.0, 2.5], [44.0, 4.0], [43.0, 4.1], [47.0, 4.6]]
    found = np.array([one] * 3)
    lines = optimize_wishes.table(found).splitlines()
    assert len(lines) == 2 + len(optimize_wishes.ROWS)
    compromise = next(line for line in lines if line.startswith(f"| {optimize_wishes.KNEE} |"))
    for cell in ("44.0 (", "+4.0 (", "−6.0 (", "4.00 (", "+2.00 (", "−1.00 ("):
        assert cell in compromise
    assert "faster than mx-clear for 100 %, better liked for 0 %" in optimize_wishes.shares(found)


def test_the_fixed_design_is_the_one_that_others_scored_best() -> None:
    designs = BOWL.of_unit([[0.1, 0.2, 0.3], [0.5, 0.5, 0.5], [0.9, 0.1, 0.4]])
    case = problem(prior=tuple(scored(i, one, bowl_ms(one)) for i, one in enumerate(designs)))
    trials = run(FixedDesign(), case, 3)
    assert all(trial.design == designs[1] for trial in trials)
    assert FixedDesign().best(case, trials) == designs[1]


def test_everybody_counts_once_however_many_seeds_they_had() -> None:
    numbers = range(2 * PEOPLE)
    found = {Run(FIXED, i, level): [50.0] for i in numbers for level in LEVELS}
    # two thirds of the people gain 5 ms, the others lose 1
    found |= {
        Run("gp", i, level): [60.0] * 5 + [45.0 if Run("gp", i, level).person % 3 else 51.0] * 7
        for i in numbers
        for level in LEVELS
    }
    assert len(by_person(found, "gp", "easy", 10)) == PEOPLE
    text = better_than_fixed(found, "gp", "easy", 10)
    assert "67 % of 30 people" in text
    assert "gains 5.0 ms" in text


def test_the_median_over_seeds_is_a_persons_figure() -> None:
    numbers = [i for i in range(600) if Run("gp", i, "easy").person == 4][:3]
    found = {Run("gp", i, "easy"): [value] * 12 for i, value in zip(numbers, (40.0, 70.0, 44.0), strict=True)}
    assert by_person(found, "gp", "easy", 30) == {4: pytest.approx(44.0)}
