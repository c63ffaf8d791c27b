from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.anova import repeated_measures_anova
from fdvv_people.stats.effect_size import averaged_rounds, rounds_as_people

FACTORS = ("button", "level")
GOLDEN: Any = json.loads((Path(__file__).parent / "files" / "pingouin.json").read_text())


def some_scores(seed: int = 0, people: int = 10, shape: tuple[int, int] = (6, 2)) -> FloatArray:
    random = np.random.default_rng(seed)
    people_s = 8 * random.normal(size=(people, 1, 1))
    uneven = random.normal(size=(people, shape[0], 1)) * np.linspace(1, 6, shape[0])[:, np.newaxis]
    return 90 + people_s + uneven + 4 * random.normal(size=(people, *shape))


def test_it_agrees_with_pingouin_on_every_column() -> None:
    table = repeated_measures_anova(GOLDEN["scores"], FACTORS)
    expected = GOLDEN["two_way"]
    for i, effect in enumerate(table.effects):
        ours = {
            "F": effect.F,
            "ddof1": effect.effect_df,
            "ddof2": effect.error_df,
            "p_unc": effect.p,
            "SS": effect.effect_ss,
            "eps": effect.sphericity.epsilon,
            "p_GG_corr": effect.corrected_p,
            "ng2": effect.generalized_eta2,
        }
        for column, value in ours.items():
            if expected[column][i] is not None:
                # the file keeps ten decimals, and its p are as small as 1e-8
                assert value == pytest.approx(expected[column][i], rel=1e-6, abs=2e-10), column
        assert effect.partial_eta2 == pytest.approx(GOLDEN["partial_eta2"][i])
        assert (effect.sphericity.W is None) == (expected["W_spher"][i] is None)


@pytest.mark.slow
def test_it_agrees_with_statsmodels_on_random_scores() -> None:
    import pandas
    from statsmodels.stats.anova import AnovaRM  # type: ignore[import-untyped]

    scores = some_scores(3, people=7, shape=(4, 3))
    rows = [(*place, float(scores[place])) for place in np.ndindex(scores.shape)]
    frame = pandas.DataFrame(rows, columns=["person", *FACTORS, "score"])
    theirs = AnovaRM(frame, "score", "person", within=list(FACTORS)).fit().anova_table
    ours = repeated_measures_anova(scores, FACTORS).effects
    assert [e.F for e in ours] == pytest.approx(theirs["F Value"].tolist())
    assert [e.p for e in ours] == pytest.approx(theirs["Pr > F"].tolist())
    assert [(e.effect_df, e.error_df) for e in ours] == list(
        zip(theirs["Num DF"], theirs["Den DF"], strict=True)
    )


def test_with_two_levels_F_is_the_square_of_the_paired_t() -> None:
    from scipy.stats import ttest_rel

    scores = some_scores(1)
    effect = repeated_measures_anova(scores, FACTORS).of("level")
    t, p = ttest_rel(*scores.mean(axis=1).T)
    assert pytest.approx(t**2) == effect.F
    assert effect.corrected_p == effect.p == pytest.approx(p)
    assert effect.sphericity.epsilon == 1.0


def test_sums_of_squares_add_up_to_the_whole() -> None:
    scores = some_scores(2)
    table = repeated_measures_anova(scores, FACTORS)
    parts = table.people_ss + sum(effect.effect_ss + effect.error_ss for effect in table.effects)
    assert parts == pytest.approx(float(np.sum((scores - scores.mean()) ** 2)))


def test_a_table_small_enough_to_do_by_hand() -> None:
    scores = np.array([[[0, 4], [2, 6]], [[1, 5], [3, 7]], [[2, 7], [5, 11]]])
    table = repeated_measures_anova(scores, ("a", "b"))
    # differences of the three people: a 2, 2, 3.5; b 4, 4, 5.5; of differences 0, 0, 1
    assert [effect.F for effect in table.effects] == pytest.approx([25.0, 81.0, 1.0])


def test_sphericity_of_one_factor_agrees_with_pingouin() -> None:
    from fdvv_people.stats.anova import sphericity

    averaged = np.mean(GOLDEN["scores"], axis=2)
    contrasts = np.linalg.qr(np.eye(6) - 1 / 6)[0][:, :5]
    found = sphericity(averaged @ contrasts)
    assert pytest.approx(GOLDEN["sphericity_of_buttons"]["W"]) == found.W
    # pingouin counts 6 levels for 5 contrasts in one place of the second term; R does not
    assert found.p == pytest.approx(GOLDEN["sphericity_of_buttons"]["p"], rel=2e-3)
    assert found.epsilon == pytest.approx(GOLDEN["two_way"]["eps"][0], rel=1e-6)


@pytest.mark.slow
def test_where_sphericity_holds_Mauchly_denies_it_as_rarely_as_it_says() -> None:
    from fdvv_people.stats.anova import sphericity

    random = np.random.default_rng(8)
    p = np.array([sphericity(random.normal(size=(10, 5))).p for _ in range(1500)], dtype=np.float64)
    # three standard errors of a share of 1500
    assert abs(np.mean(p < 0.05) - 0.05) < 0.017
    assert abs(np.mean(p) - 0.5) < 0.023


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.integers(3, 12), st.integers(2, 7))
def test_epsilon_stays_between_its_bounds(seed: int, people: int, levels: int) -> None:
    scores = some_scores(seed, people, (levels, 2))
    for effect in repeated_measures_anova(scores, FACTORS).effects:
        assert 1 / effect.effect_df - 1e-12 <= effect.sphericity.epsilon <= 1.0


def test_F_minds_neither_unit_nor_who_is_slow() -> None:
    scores = some_scores(5)
    moved = 1000 * scores + np.arange(10.0)[:, np.newaxis, np.newaxis]
    first, second = (repeated_measures_anova(s, FACTORS) for s in (scores, moved))
    assert [e.F for e in first.effects] == pytest.approx([e.F for e in second.effects])


def test_counting_rounds_as_people_gives_the_degrees_of_freedom_of_the_paper() -> None:
    random = np.random.default_rng(4)
    observations = some_scores(6)[..., np.newaxis] + random.normal(size=(10, 6, 2, 2))
    people = repeated_measures_anova(averaged_rounds(observations), FACTORS).of("button")
    rounds = repeated_measures_anova(rounds_as_people(observations), FACTORS).of("button")
    assert (people.effect_df, people.error_df) == (5, 45)
    assert (rounds.effect_df, rounds.error_df) == (5, 95)


def test_rounds_as_people_keeps_every_score_with_its_button_and_level() -> None:
    observations = np.arange(10 * 6 * 2 * 2).reshape(10, 6, 2, 2)
    assert rounds_as_people(observations)[2 * 3 + 1].tolist() == observations[3, ..., 1].tolist()


def test_a_missing_cell_is_one_clear_error() -> None:
    scores = some_scores()
    scores[2, 4, 1] = np.nan
    with pytest.raises(ModelError, match=r"1 of 120 scores .* person 3, button 5, level 2 "):
        repeated_measures_anova(scores, FACTORS)


@pytest.mark.parametrize(
    ("scores", "reason"),
    [
        (np.zeros((10, 6)), "need the axes person, button, level"),
        (np.zeros((2, 6, 2)), "at least 3 people"),
        (np.zeros((9, 6, 1)), "the factor level needs at least 2"),
        (np.zeros((9, 6, 2)) + np.arange(12).reshape(6, 2), "differs alike"),
    ],
)
def test_scores_that_cannot_be_tested_are_refused(scores: FloatArray, reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        repeated_measures_anova(scores, FACTORS)
