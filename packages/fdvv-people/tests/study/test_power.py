"""Power comes from whole simulated studies and the claim's own test."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.claim import claim_p, claim_scores
from fdvv_people.study.plan.plan import Claim
from fdvv_people.study.simulation.people import draw_people
from fdvv_people.study.simulation.power import (
    ItemEffect,
    PowerDesign,
    PowerTable,
    _answered,
    power_table,
    simulate_scores,
)
from tests.support.campaign import campaign


def design(difference_JND: float, kind: str = "realism", points: int | None = None) -> PowerDesign:
    effects = tuple(ItemEffect.of_size(name, difference_JND) for name in ("soft", "hard"))
    return PowerDesign(kind, effects, rounds=6, ties=True, alpha=0.05, points=points)


def table(
    difference_JND: float, people: list[int], points: int | None = None, studies: int = 400
) -> PowerTable:
    return power_table(design(difference_JND, points=points), people, studies, sizes_JND=())


def test_few_people_cannot_show_anything_and_many_can() -> None:
    rows = table(1.5, [5, 6, 30]).rows
    # the smallest p of five signs is 0.0625
    assert rows[0].power.value == rows[0].false_nothing.value == 0
    assert 0 < rows[1].power.value < rows[2].power.value
    assert rows[2].power.value > 0.95


@pytest.mark.parametrize("points", [None, 7])
@campaign("people", [12, 24], part=1)
def test_false_claims_stay_at_alpha(points: int | None, people: int) -> None:
    (row,) = table(2.0, [people], points, studies=600).rows
    error = np.sqrt(0.05 * 0.95 / 600)
    for found in (row.false_nothing, row.false_split):
        assert found.value <= 0.05 + 3 * error
        assert found.low is not None
        assert found.high is not None
        assert found.low <= found.value <= found.high
    # nor is the test so shy that it wastes people
    assert row.false_split.value >= 0.02


def test_the_same_seed_gives_the_same_table_however_many_people_it_goes_to() -> None:
    alone, among = table(0.8, [12]).rows[0], table(0.8, list(range(8, 20))).rows[4]
    assert among.people == 12
    assert alone.power == among.power
    assert alone.false_nothing == among.false_nothing
    other = power_table(design(0.8), [12], 400, seed=1, sizes_JND=()).rows[0]
    assert other.power != alone.power


def test_what_is_detectable_has_a_power_of_four_fifths() -> None:
    found = power_table(design(1.0), [16], 800, sizes_JND=(0.25, 0.5, 0.75, 1.0, 1.5, 2.0))
    size_JND = found.rows[0].detectable_JND
    assert size_JND is not None
    (there,) = table(size_JND, [16], studies=800).rows
    assert there.power.value == pytest.approx(0.8, abs=0.06)
    share = found.rows[0].detectable_share
    assert share is not None
    assert 1 / 3 < share < 1


def test_the_table_tells_from_how_many_people_on_the_power_is_enough() -> None:
    found = table(2.0, list(range(6, 31, 4)))
    enough = found.enough()
    assert enough is not None
    for row in found.rows:
        assert row.power.low is not None
        if row.people >= enough:
            assert row.power.low >= 0.8
    assert table(0.0, [6, 12]).enough() is None


@pytest.mark.parametrize("kind", ["realism", "abx", "2afc", "2ac", "preference"])
def test_planning_scores_a_study_as_its_analysis_does(kind: str) -> None:
    of = design(1.2, kind)
    people = 7
    planned = simulate_scores(of, people, studies=1, seed=3).scores[0]
    rows = []
    for number in range(people):
        random = np.random.default_rng([3, 0, number])
        trials = _answered(of, draw_people(random, (1,)), random)
        for item in range(2):
            for chosen, correct in zip(trials.chosen[0, item], trials.correct[0, item], strict=True):
                name = "equal" if chosen < 0 else ("FDVV", "FD")[chosen]
                rows.append((f"P{number:02d}", of.effects[item].item, name, float(correct)))
    person, item_names, choice, right = (np.array(column) for column in zip(*rows, strict=True))
    n = len(rows)
    found = Answers(kind, ("FD", "FDVV"), person, item_names, np.arange(n), choice, right.astype(float))
    _, scores = claim_scores(found, Claim(more="FDVV", less="FD"))
    np.testing.assert_allclose(scores, planned)


def test_power_counts_the_studies_whose_own_test_upholds_the_claim() -> None:
    of = design(1.0)
    scores = simulate_scores(of, 10, 200, seed=4).scores
    upheld = (claim_p(scores) <= 0.05) & (scores.sum(axis=1) > 0)
    (row,) = power_table(of, [10], 200, seed=4, sizes_JND=()).rows
    assert row.power.value == upheld.mean()


def test_shares_are_of_all_answers() -> None:
    shares = simulate_scores(design(1.0), 20, 50).shares
    np.testing.assert_allclose(shares.sum(axis=1), 1.0)
    assert (shares[:, 0] > shares[:, 2]).all()


def test_too_few_people_or_studies_are_refused() -> None:
    for people, studies in (([1], 100), ([], 100), ([6], 3)):
        with pytest.raises(ModelError):
            power_table(design(1.0), people, studies)
