"""Distances, resampled intervals, staircases and pairs against textbook formulas, 200 drawn sets of each."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import binomtest, norm, ttest_rel
from scipy.stats import t as student
from statsmodels.stats.anova import AnovaRM  # type: ignore[import-untyped]
from statsmodels.stats.proportion import proportion_confint  # type: ignore[import-untyped]

from fdvv_people.stats.anova import repeated_measures_anova
from fdvv_people.stats.effect_size import Estimate, cohen_dz, reduction
from fdvv_people.stats.post_hoc import post_hoc
from fdvv_people.stats.share import clustered_share
from fdvv_people.study.analysis.levels import threshold_over_people
from fdvv_people.study.analysis.records import ChoiceResult, ThresholdResult
from fdvv_people.study.plan.plan import Staircase
from fdvv_people.study.plan.staircase import staircase_state, threshold
from tests.study.test_textbook import DRAWS, TENTHS, TWO, VALUE, analysed, check_choices, drawn, draws
from tests.support import textbook, textbook_levels

pytestmark = pytest.mark.slow


def counts_of(rows: textbook.Rows) -> np.ndarray:
    """Count what every person named: FD, neither, FDVV."""
    by: dict[str, list[float]] = defaultdict(list)
    for row in rows:
        if row["choice"]:
            by[row["person"]].append(VALUE[row["choice"]])
    return np.array([[sum(v == side for v in vs) for side in (-1.0, 0.0, 1.0)] for vs in by.values()], float)


@TENTHS
def test_choices_with_equal_allowed(part: int, tmp_path: Path) -> None:
    mixed = 0
    for seed in draws(part):
        rows = drawn(seed, TWO, "2ac")
        found = analysed(rows, "2ac", tmp_path)
        kept, _ = textbook.screened(rows)
        assert found.preference is not None
        check_choices(found.preference, kept)
        counts = counts_of(kept)
        check_totals(found.preference, counts)
        mixed += check_people(found.preference, counts)
        check_persons(found, rows)
    assert mixed > DRAWS / 10 / 4


def check_totals(found: ChoiceResult, counts: np.ndarray) -> None:
    """Check the interval of all answers counted as independent, ties dropped, and how alike people are."""
    first, equal, second = counts.sum(axis=0)
    plain = found.d[-1]
    assert_allclose(plain.p, binomtest(int(second), int(first + second)).pvalue)
    if equal:
        check_profile(plain.low, plain.high, (first, equal, second))
        assert found.dropped is not None
        ends = proportion_confint(second, first + second, method="wilson")
        assert_allclose([found.dropped.low, found.dropped.high], ends, atol=1e-12)
    else:
        ends = proportion_confint(second, first + second, method="beta")
        assert_allclose([plain.low, plain.high], np.sqrt(2) * norm.ppf(ends), atol=1e-9)
    if found.people_share is not None and counts.sum() > len(counts):
        zeros_and_ones = [[0.0] * int(a + b) + [1.0] * int(c) for a, b, c in counts]
        assert found.people_share.icc is not None
        assert_allclose(found.people_share.icc, textbook_levels.likeness(zeros_and_ones), atol=1e-9)


def check_profile(low: float, high: float, counts: tuple[float, float, float]) -> None:
    """The deviance is the quantile of chi-squared at a bound; where there is none it never gets there."""
    for bound, far in ((low, -25.0), (high, 25.0)):
        if np.isfinite(bound):
            assert_allclose(textbook_levels.deviance_2ac(counts, bound), textbook_levels.LIMIT, atol=2e-3)
        else:
            assert textbook_levels.deviance_2ac(counts, far) < textbook_levels.LIMIT


def check_people(found: ChoiceResult, counts: np.ndarray) -> bool:
    """Check d' over people: by the mixed model, or of the answers that the spread between people leaves."""
    over = found.d[0]
    if over.people is None or not counts.sum(axis=0)[1]:
        return False
    assert over.people == len(counts)
    if "mixed" not in over.method:
        n = counts.sum(axis=1)
        part = min(textbook_levels.effective(column, n) for column in counts.T if column.any()) / n.sum()
        check_profile(over.low, over.high, tuple(counts.sum(axis=0) * part))
        return False
    d, tau, sd = textbook_levels.best_2ac(counts)
    assert over.tau is not None
    assert_allclose([over.d, over.tau], [d, tau], atol=0.01)
    if sd > 0.3:
        half = norm.ppf(0.975) * textbook_levels.error_2ac(counts, d, tau, sd)
        assert_allclose([over.low, over.high], [d - half, d + half], atol=0.03 * half + 0.01)
    return True


def check_persons(found: Any, rows: textbook.Rows) -> None:
    """Check what is said of each person, those who are left out too."""
    for one in found.people:
        own = [row["choice"] for row in rows if row["person"] == one.person]
        said = [VALUE[choice] for choice in own if choice]
        assert (one.planned, one.answered) == (len(own), len(said))
        if said:
            assert_allclose(one.share, np.mean([(value + 1) / 2 for value in said]))


def tails(found: Estimate, every: np.ndarray, low: float, high: float) -> None:
    """Compare bounds with the exact tails of all resamples: 9999 of them miss by a few thousandths."""
    assert found.low is not None
    assert found.high is not None
    for bound, tail in ((found.low, low), (found.high, high)):
        # a bound may lie on one of several equal resamples
        below, upto = np.mean(every < bound - 1e-9), np.mean(every <= bound + 1e-9)
        missed = 5 * np.sqrt(tail * (1 - tail) / 9999) + 0.004
        assert below - missed <= tail <= upto + missed


@TENTHS
def test_resampled_intervals_against_all_resamples(part: int) -> None:
    for seed in draws(part):
        random = np.random.default_rng(seed)
        n = int(random.integers(5, 7))
        lower, higher = random.normal(2.0, 0.4, n), random.normal(2.6, 0.5, n)
        pairs = np.column_stack([lower, higher])
        kind = seed % 3
        if kind == 0:
            exact = textbook_levels.exact_bca(
                lambda at: at[..., 0].mean(-1) / np.maximum(at[..., 0].std(-1, ddof=1), 1e-12), pairs
            )
            tails(cohen_dz(lower, seed), *exact)
        elif kind == 1:
            exact = textbook_levels.exact_bca(lambda at: 1 - at[..., 0].mean(-1) / at[..., 1].mean(-1), pairs)
            tails(reduction(lower, higher, seed), *exact)
        else:
            trials = random.integers(3, 12, n)
            hits = random.binomial(trials, random.uniform(0.3, 0.8, n))
            share = clustered_share(hits, trials, "bootstrap", seed)
            counts = np.column_stack([hits, trials]).astype(float)
            exact = textbook_levels.exact_bca(lambda at: at[..., 0].sum(-1) / at[..., 1].sum(-1), counts)
            if np.ptp(hits / trials) > 0:
                tails(Estimate(share.share, share.low, share.high), *exact)


def listened(staircase: Staircase, random: np.random.Generator) -> list[tuple[float, bool]]:
    """Let a listener of a drawn threshold answer; some staircases are broken off."""
    middle, history = random.uniform(0.03, 0.3), list[tuple[float, bool]]()
    stop = int(random.integers(4, 60))
    while len(history) < stop and (ratio := staircase_state(staircase, history).ratio) is not None:
        history.append((ratio, bool(random.random() < 0.5 + 0.48 * norm.cdf(np.log(ratio / middle) / 0.7))))
    return history


@TENTHS
def test_thresholds_of_staircases_and_over_people(part: int) -> None:
    whole = 0
    for seed in draws(part):
        random = np.random.default_rng(seed)
        rule = Staircase(down=int(random.integers(2, 4)), dropped=int(random.integers(0, 4)))
        results = []
        for person in range(int(random.integers(1, 4))):
            history = listened(rule, random)
            ratios, correct = (np.array(column) for column in zip(*history, strict=True))
            found = threshold(rule, history)
            results.append(ThresholdResult(f"P{person}", "Clear", ratios, correct, found))
            whole += check_threshold(found, rule, ratios, correct)
        over = threshold_over_people(tuple(results))
        logs = [np.log(one.threshold.value) for one in results if np.isfinite(one.threshold.value)]
        assert (over is None) == (not logs)
        if over is not None and len(logs) > 1:
            wanted = textbook.spread(logs)
            assert_allclose([over.mean, over.median], np.exp([wanted["mean"], wanted["median"]]))
            assert_allclose([over.low, over.high], np.exp([wanted["low"], wanted["high"]]))
            assert_allclose(over.sd, wanted["sd"])
    assert whole > DRAWS / 10


def check_threshold(found: Estimate, rule: Staircase, ratios: np.ndarray, correct: np.ndarray) -> bool:
    turns = textbook_levels.turns_of(ratios, correct, rule.down)[: rule.reversals][rule.dropped :]
    turns = turns[1:] if len(turns) % 2 else turns
    if not turns:
        assert np.isnan(found.value)
        return False
    assert_allclose(found.value, np.prod(turns) ** (1 / len(turns)))
    low, high = textbook_levels.threshold_bounds(ratios, correct, 0.5 ** (1 / rule.down))
    assert found.low is not None
    assert found.high is not None
    assert_allclose([found.low, found.high], [min(low, found.value), max(high, found.value)], rtol=0.04)
    return True


@TENTHS
def test_effects_of_two_factors_and_their_pairs(part: int) -> None:
    """Sums of squares by F of statsmodels, epsilon from the covariance, pairs by SciPy."""
    import pandas as pd

    for seed in draws(part):
        random = np.random.default_rng(seed)
        people, buttons, levels = (int(random.integers(*ends)) for ends in ((5, 12), (2, 5), (2, 4)))
        scores = random.normal(0, 1, (people, buttons, levels)) + random.normal(3, 1, (people, 1, 1))
        table = repeated_measures_anova(scores, ("b", "s"))
        if seed % 4 == 0:
            cells = [(p, b, s, scores[p, b, s]) for p, b, s in np.ndindex(scores.shape)]
            frame = pd.DataFrame(cells, columns=list("pbsy"))
            plain = AnovaRM(frame, "y", "p", within=["b", "s"]).fit().anova_table
            assert_allclose([one.F for one in table.effects], plain["F Value"], rtol=1e-7)
        for one, axis in zip(table.effects[:2], (2, 1), strict=True):
            means = scores.mean(axis=axis)
            epsilon = textbook_levels.greenhouse_geisser(means)
            assert_allclose(one.sphericity.epsilon, epsilon, rtol=1e-9)
            share = one.F * one.effect_df / (one.F * one.effect_df + one.error_df)
            assert_allclose(one.partial_eta2, share)
        check_pairs(scores.mean(axis=2), seed)


def check_pairs(scores: np.ndarray, seed: int) -> None:
    names = [f"B{i}" for i in range(scores.shape[1])]
    found = post_hoc(scores, names, against="B0", seed=seed) if seed % 4 == 1 else ()
    plain = [ttest_rel(scores[:, 0], scores[:, i]) for i in range(1, len(names))]
    p = [float(one.pvalue) for one in plain]
    for i, one in enumerate(found):
        apart = scores[:, 0] - scores[:, i + 1]
        half = student.ppf(0.975, len(apart) - 1) * apart.std(ddof=1) / np.sqrt(len(apart))
        assert_allclose([one.t, one.p], [plain[i].statistic, p[i]])
        bounds = np.array([one.difference.value, one.difference.low, one.difference.high], float)
        assert_allclose(bounds, apart.mean() + np.array([0, -half, half]))
        assert_allclose([one.bonferroni_p, one.holm_p], [min(1, p[i] * len(p)), textbook.holm(p)[i]])
        assert_allclose(one.dz.value, apart.mean() / apart.std(ddof=1))
