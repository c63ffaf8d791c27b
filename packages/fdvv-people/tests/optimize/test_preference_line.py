"""Lines whose best stop a person feels out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.engines.preference import LINE_WEIGHT, believe_choices
from fdvv_people.optimize.engines.preference_line import PreferenceLineEngine, expected_best
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.space import Constraint, DesignSpace
from tests.optimize.problems import BOWL, HELD, bowl_ms, problem

ENGINE = PreferenceLineEngine()
NARROW = DesignSpace(
    "narrow",
    BOWL.parameters,
    (Constraint("edge", "p0 is near 2 mm", lambda d: 0.05 - abs(d["p0_mm"] - 2.0)),),
)


def line(number: int, designs: Sequence[dict[str, float]], best: int | None = None) -> Trial:
    design, *beside = designs
    if best is None:
        return Trial(number, design, beside=tuple(beside))
    return Trial(number, design, TrialState.DONE, beside=tuple(beside), best=(best,))


def walked(case: Problem, count: int) -> list[Trial]:
    """Let somebody choose who likes a low bowl."""
    found: list[Trial] = []
    for number in range(count):
        stops = ENGINE.suggest(case, found)
        found.append(line(number, stops, int(np.argmin([bowl_ms(stop) for stop in stops]))))
    return found


def test_lines_replay_are_straight_and_even_and_end_at_the_bounds_at_first() -> None:
    case = problem(seed=3)
    found = walked(case, 5)
    assert found == walked(case, 5)
    for one in found:
        places = BOWL.to_unit(one.designs)
        assert places.shape == (9, 3)
        steps = np.diff(places, axis=0)
        np.testing.assert_allclose(steps, np.broadcast_to(steps[0], steps.shape), atol=1e-12)
    for end in BOWL.to_unit(found[0].designs)[[0, -1]]:
        assert np.any((np.abs(end) < 1e-9) | (np.abs(end - 1.0) < 1e-9))
    assert len({str(one.designs) for one in found}) == 5


def test_every_line_goes_through_the_favourite() -> None:
    case = problem(seed=1)
    found = walked(case, 4)
    for number in range(1, 4):
        middle = BOWL.to_unit([ENGINE.best(case, found[:number])])[0]
        start, end = BOWL.to_unit(found[number].designs)[[0, -1]]
        along = (end - start) / np.linalg.norm(end - start)
        away = (middle - start) - ((middle - start) @ along) * along
        assert np.linalg.norm(away) < 1e-9


@pytest.mark.parametrize("space", [HELD, NARROW], ids=lambda one: str(one.name))
def test_every_stop_holds_the_constraints(space: DesignSpace) -> None:
    for one in walked(problem(space, seed=5), 6):
        assert len(one.designs) >= 2
        assert all(space.broken(stop) == () for stop in one.designs)


def test_a_space_without_a_design_is_refused() -> None:
    never = DesignSpace("never", BOWL.parameters, (Constraint("no", "nothing holds", lambda _d: -1.0),))
    with pytest.raises(InputError, match="nothing holds"):
        ENGINE.suggest(problem(never), [])


def test_a_favourite_is_found_in_five_lines() -> None:
    everywhere = np.array([bowl_ms(d) for d in BOWL.of_unit(np.random.default_rng(4).random((2000, 3)))])
    ranks = []
    for seed in range(7):
        case = problem(seed=seed)
        best = ENGINE.best(case, walked(case, 5))
        ranks.append(float((everywhere < bowl_ms(best)).mean()))
    assert np.median(ranks) < 0.02


def test_nothing_is_recommended_before_an_answer() -> None:
    case = problem()
    with pytest.raises(ModelError):
        ENGINE.best(case, [line(0, ENGINE.suggest(case, []))])


def test_the_chosen_stop_beat_each_other_one() -> None:
    a, b, c = BOWL.of_unit([[0.1] * 3, [0.5] * 3, [0.9] * 3])
    belief = believe_choices(BOWL, [line(0, (a, b, c), 2), line(1, (a, b))], of_lines=True)
    assert belief is not None
    assert belief.pairs.tolist() == [[2, 0], [2, 1]]
    assert belief.counts.tolist() == [LINE_WEIGHT, LINE_WEIGHT]
    worth = belief.mean(BOWL.to_unit([a, b, c]))
    assert worth[2] > worth[1]
    assert worth[2] > worth[0]


def test_the_best_stop_of_two_is_worth_what_clark_computed() -> None:
    """Clark (1961), The greatest of a finite set of random variables: the larger of two normals."""
    from scipy.stats import norm

    belief = believe_choices(BOWL, walked(problem(seed=2), 3), of_lines=True)
    assert belief is not None
    way = np.array([[0.1, 0.9, 0.4], [0.8, 0.2, 0.6]])
    mean, cov = belief.predict(way)
    spread = np.sqrt(cov[0, 0] + cov[1, 1] - 2 * cov[0, 1])
    gap = (mean[0] - mean[1]) / spread
    wanted = mean[0] * norm.cdf(gap) + mean[1] * norm.cdf(-gap) + spread * norm.pdf(gap)
    found = [expected_best(belief, way[None], np.random.default_rng(seed))[0] for seed in range(200)]
    assert np.mean(found) == pytest.approx(wanted, abs=4 * np.std(found) / np.sqrt(200))


def test_options_that_make_no_line_and_unknown_engines_are_refused() -> None:
    with pytest.raises(ModelError, match="2 stops"):
        engine_of("preference-line", {"stops": 1})
    with pytest.raises(InputError, match=r"use one of random.*preference-line"):
        engine_of("koyama")
