"""What the engines are compared with: a fixed design is fixed, a person counts once."""

from __future__ import annotations

import pytest
from benchmarks.optimize_diverse import FIXED, better_than_fixed, by_person
from benchmarks.optimize_rivals import FixedDesign
from benchmarks.optimize_tables import LEVELS, PEOPLE, Run

from tests.optimize.problems import BOWL, bowl_ms, problem, run, scored


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
