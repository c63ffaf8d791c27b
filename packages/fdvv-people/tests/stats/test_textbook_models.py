"""Standard errors, Mauchly's test and effect sizes against their definitions, 200 drawn sets of each."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm

from fdvv_people.stats.anova import repeated_measures_anova
from fdvv_people.stats.ordinal import ordinal_model
from fdvv_people.stats.ordinal_fit import OrdinalFit, fitted, gathered
from tests.study.test_textbook import DRAWS, TENTHS, TWO, analysed, draws
from tests.support import textbook, textbook_models

pytestmark = pytest.mark.slow
BUTTONS = ("Clear", "Red", "Brown", "Blue", "Black")


def some_answers(seed: int) -> tuple[Any, Any, Any]:
    """Draw ratings, with gaps, of 5 to 11 people who rated two renderings 2 to 8 times each."""
    random = np.random.default_rng(seed)
    cuts = np.sort(random.normal(0, 1.2, int(random.integers(2, 6))))
    spread, own_spread, effect = random.uniform(0.2, 1.2), random.uniform(0.2, 1.0), random.normal(0.4, 0.5)
    cells = []
    for p in range(int(random.integers(5, 12))):
        use, own = random.normal(0, spread), effect + random.normal(0, own_spread)
        for x in (0.0, 1.0):
            for felt in use + x * own + random.normal(size=int(random.integers(2, 9))):
                gap = random.random() < 0.15
                cells.append((f"P{p}", x, np.nan if gap else float(np.digitize(felt, cuts)) + 1))
    who, what, ratings = zip(*cells, strict=True)
    return np.array(ratings), np.array(who), np.array(what)


def fit_of(ratings: Any, person: Any, x: Any, slope: bool, nodes: int) -> OrdinalFit:
    category = np.unique(ratings, return_inverse=True)[1]
    return fitted(gathered(category, person, x[:, None], 0 if slope else None), nodes)


@pytest.mark.parametrize("slope", [False, True])
@TENTHS
def test_the_error_of_an_ordinal_effect_is_in_the_inverse_of_the_hessian(part: int, slope: bool) -> None:
    bounded = 0
    for seed in draws(part):
        ratings, person, x = some_answers(seed)
        found = ordinal_model(ratings, person, x, ["x"], "x" if slope else None)
        if found.problem:
            continue
        there = ~np.isnan(ratings)
        assert (found.n, found.missing) == (there.sum(), (~there).sum())
        answers = ratings[there], person[there], x[there]
        grid = textbook_models.OrdinalOnGrid(*answers, slope)
        at = fit_of(*answers, slope, found.nodes).point.flat()
        effect = found.of("x")
        # of two parts of a person nodes about a mode come less near, least where the effect is hardly bounded
        slack, near = ((0.1, 0.2) if effect.error > 1 else (0.02, 1e-2)) if slope else (1e-3, 2e-4)
        assert np.abs(grid.slope_at(at)).max() < slack
        assert_allclose(effect.error, grid.error(at), rtol=near)
        half = norm.ppf(0.975) * effect.error
        assert_allclose([effect.low, effect.high], [effect.value - half, effect.value + half])
        assert_allclose(effect.p, 2 * norm.sf(abs(effect.value) / effect.error), atol=1e-12)
        bounded += 1
    assert bounded > 0.9 * DRAWS / 10


@TENTHS
def test_sphericity_and_sizes_of_effects_from_their_definitions(part: int) -> None:
    apart = defaultdict[bool, list[float]](list)
    for seed in draws(part):
        random = np.random.default_rng(seed)
        buttons, levels = (int(n) for n in random.integers(2, 6, 2))
        people = int(random.integers(max(buttons, levels, 3), 15))
        uneven = random.normal(size=(people, buttons, levels)) * random.uniform(0.4, 2.5, (buttons, levels))
        scores = uneven + random.normal(0, 2, (people, 1, 1)) + random.normal(0, 0.5, (buttons, levels))
        table = repeated_measures_anova(scores, ("a", "b"))
        for one, axis in zip(table.effects[:2], (2, 1), strict=True):
            found = one.sphericity
            if one.effect_df == 1:
                assert found.W is found.p is None
                continue
            W, p = textbook_models.mauchly(scores.mean(axis=axis))
            assert found.W is not None
            assert_allclose(found.W, W, rtol=1e-9)
            apart[people >= 2 * (one.effect_df + 1)].append(abs((found.p or 0.0) - p))
        for one, name in zip(table.effects, ("a", "b", "ab"), strict=True):
            assert_allclose(one.generalized_eta2, textbook_models.generalized_eta2(scores, name), rtol=1e-9)
    # two terms of a series against the exact p; few people of many levels need more of them
    assert max(apart[True]) < 1.5e-3
    assert max(apart[False]) < 0.06


def timed(seed: int) -> textbook.Rows:
    """Draw scores of up to five buttons, 1 to 3 rounds each, some of them missing."""
    random = np.random.default_rng(seed)
    gap, buttons = random.uniform(0, 0.08), BUTTONS[: random.integers(3, 6)]
    rows: textbook.Rows = []
    for p in range(random.integers(8, 14)):
        lean = random.normal(0, 2)
        for i, item in enumerate(buttons):
            for number in range(random.integers(1, 4)):
                felt = 50 + lean + random.normal(0, 1 + i, 2)
                ratings = {
                    s: None if random.random() < gap else round(float(v), 2)
                    for s, v in zip(TWO, felt, strict=True)
                }
                rows.append(
                    {
                        "person": f"P{p:02d}", "item": item, "round": number,
                        "choice": "", "correct": None, "ratings": ratings,
                    }
                )  # fmt: skip
    return rows


@TENTHS
def test_the_same_of_whole_analyses_with_gaps_and_uneven_rounds(part: int, tmp_path: Path) -> None:
    tested = 0
    for seed in draws(part):
        rows = timed(seed)
        found = analysed(rows, "timing", tmp_path).timing
        assert found is not None
        if found.anova is None:
            continue
        kept, _ = textbook.screened(rows)
        cells, whole = textbook.cells_and_whole(kept, found.buttons, TWO)
        scores = np.array([[[np.mean(cells[p, b, s]) for s in TWO] for b in found.buttons] for p in whole])
        assert found.anova.people == len(whole)
        for one, name in zip(found.anova.effects, ("a", "b", "ab"), strict=True):
            wanted = textbook_models.generalized_eta2(scores, name)
            assert_allclose(one.generalized_eta2, wanted, rtol=1e-7)
        sphericity = found.anova.effects[0].sphericity
        if len(whole) >= len(found.buttons):
            W, p = textbook_models.mauchly(scores.mean(axis=2))
            assert sphericity.W is not None
            assert sphericity.p is not None
            assert_allclose(sphericity.W, W, rtol=1e-7)
            assert_allclose(sphericity.p, p, atol=0.06)
            tested += 1
    assert tested > DRAWS / 10 / 2
