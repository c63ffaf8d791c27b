"""Every figure of an analysis against textbook formulas, on drawn answers with gaps and of uneven size.

A draw is written as a foreign table, read without a flag and analysed. 200 draws of each kind.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import binomtest, norm
from statsmodels.stats.anova import AnovaRM  # type: ignore[import-untyped]
from statsmodels.stats.proportion import proportion_confint  # type: ignore[import-untyped]

from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.columns import ColumnMap
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.records import ButtonTest, ChoiceResult, StudyAnalysis
from tests.support import textbook, textbook_levels
from tests.support.campaign import campaign

DRAWS = 200
TENTHS = campaign("part", range(10), part=1)
TWO, FOUR = ("FD", "FDVV"), ("reference", "FDVV", "FD", "anchor")
pytestmark = pytest.mark.slow


def draws(part: int) -> range:
    """Return the seeds of a tenth of the draws."""
    return range(part, DRAWS, 10)


def drawn(seed: int, stimuli: tuple[str, ...], kind: str) -> textbook.Rows:
    """Draw trials: people of 1 to 4 rounds, some draws of one button, gaps in ratings and choices."""
    random = np.random.default_rng(seed)
    rows: textbook.Rows = []
    gap = random.uniform(0, 0.2)
    for p in range(random.integers(5, 10)):
        lean = random.normal(0.4, 0.7)
        for item in ("Clear", "Red")[: 1 + (random.random() > 0.1)]:
            for number in range(random.integers(1, 5)):
                felt = lean + random.normal(0, 1, len(stimuli)) + np.arange(len(stimuli)) * 0.3
                scale = np.clip(np.round(4 + felt), 1, 7)
                ratings = {
                    s: None if random.random() < gap else float(v)
                    for s, v in zip(stimuli, scale, strict=True)
                }
                choice = (
                    ""
                    if random.random() < gap
                    else str(random.choice([*stimuli, "equal"], p=[0.3, 0.5, 0.2]))
                    if len(stimuli) == 2
                    else ""
                )
                correct = None if random.random() < gap else float(random.random() < 0.7)
                rows.append(
                    {
                        "person": f"P{p:02d}", "item": item, "round": number,
                        "choice": choice if kind in ("realism", "2ac") else "",
                        "correct": correct if kind == "abx" else None,
                        "ratings": ratings if kind in ("realism", "mushra", "timing") else {},
                    }
                )  # fmt: skip
    return rows


def analysed(rows: textbook.Rows, kind: str, folder: Path) -> StudyAnalysis:
    """Write trials as a foreign table and analyse it."""
    stimuli = list(rows[0]["ratings"])
    lines = []
    for row in rows:
        head = [row["person"], row["item"], str(row["round"]), row["choice"] or "NA"]
        head.append("" if row["correct"] is None else f"{row['correct']:g}")
        head += ["" if row["ratings"][s] is None else f"{row['ratings'][s]:g}" for s in stimuli]
        lines.append(",".join(head))
    titles = ["participant", "button", "trial", "preferred", "correct", *(f"rating_{s}" for s in stimuli)]
    path = folder / "table.csv"
    path.write_text(",".join(titles) + "\n" + "\n".join(lines) + "\n")
    asked = ColumnMap(
        kind="" if kind in ("realism", "2ac") else kind, stimuli=tuple(stimuli) if len(stimuli) > 2 else ()
    )
    return analyse(read_answers(path, asked))


def close(found: Any, wanted: dict[str, float]) -> None:
    values = found if isinstance(found, dict) else asdict(found)
    for name, value in wanted.items():
        assert_allclose(values[name], value, rtol=1e-9, atol=1e-9, err_msg=name)


def pairs_of(rows: textbook.Rows, first: str, second: str) -> list[tuple[str, float, float]]:
    """Return person and both ratings of every trial that has both."""
    both = [(row["person"], row["ratings"][first], row["ratings"][second]) for row in rows]
    return [one for one in both if None not in one]


def check_button(found: ButtonTest, rows: textbook.Rows) -> float:
    here = [row for row in rows if row["item"] == found.button]
    pairs = pairs_of(here, "FDVV", "FD")
    close(
        found.test, wanted := textbook.signed_rank(textbook.person_means([(p, a - b) for p, a, b in pairs]))
    )
    for values, part in (
        ([(p, a) for p, a, _ in pairs], found.more_spread),
        ([(p, b) for p, _, b in pairs], found.less_spread),
    ):
        if wanted["n"] > 1:
            close(part, textbook.spread(textbook.person_means(values)))
    ratings = sum(value is not None for row in here for value in row["ratings"].values())
    assert found.unpaired == ratings - 2 * len(pairs)
    return wanted["p_exact"]


VALUE = {"FDVV": 1.0, "equal": 0.0, "FD": -1.0}


def check_choices(found: ChoiceResult, rows: textbook.Rows) -> None:
    said = [(row["person"], VALUE[row["choice"]]) for row in rows if row["choice"]]
    counts = {side: sum(v == side for _, v in said) for side in (1.0, 0.0, -1.0)}
    assert [found.more_count, found.equal_count, found.less_count] == list(counts.values())
    assert found.missing == len(rows) - len(said)
    assert_allclose(found.split, (counts[1.0] + counts[0.0] / 2) / len(said))
    by: dict[str, list[float]] = defaultdict(list)
    for person, value in said:
        by[person].append(value)
    share = (
        textbook.shares({p: (sum(v == 1 for v in vs), len(vs)) for p, vs in by.items()})
        if len(by) > 1
        else None
    )
    if share:
        assert found.test is not None
        close(found.people_share, {k: share[k] for k in ("share", "low", "high")})
        assert_allclose(
            [found.share.low, found.share.high], [share["wilson_low"], share["wilson_high"]], atol=1e-12
        )
        means = textbook.person_means(said)
        close(found.test, textbook.signed_rank([m / 2 for m in means]))
        plus, minus = sum(m > 0 for m in means), sum(m < 0 for m in means)
        assert_allclose(found.sign.p, binomtest(plus, plus + minus).pvalue if plus + minus else 1.0)
    if not counts[0.0] and 0 < counts[1.0] < len(said):
        assert_allclose(found.d[-1].d, np.sqrt(2) * norm.ppf(counts[1.0] / len(said)), atol=1e-9)
    elif all(counts.values()):
        low, high = (np.sqrt(2) * norm.ppf(counts[s] / len(said)) for s in (-1.0, 1.0))
        assert found.d[-1].tau is not None
        assert_allclose(found.d[-1].d, (high - low) / 2, atol=1e-9)
        assert_allclose(found.d[-1].tau, -(low + high) / 2, atol=1e-9)


@TENTHS
def test_choices_and_ratings_of_two(part: int, tmp_path: Path) -> None:
    likelihoods = 0
    for seed in draws(part):
        rows = drawn(seed, TWO, "realism")
        found = analysed(rows, "realism", tmp_path)
        kept, out = textbook.screened(rows)
        assert set(found.screening.left_out) == out
        p = [check_button(one, kept) for one in found.tests]
        assert_allclose([one.p_holm for one in found.tests], textbook.holm(p))
        assert found.preference is not None
        for one in (found.preference, *found.by_button):
            check_choices(one, [row for row in kept if one.button in ("", row["item"])])
        assert found.claim is not None
        said = [(row["person"], VALUE[row["choice"]]) for row in kept if row["choice"]]
        close(found.claim.test, textbook.signed_rank(textbook.person_means(said)))
        for scale in found.scales:
            likelihoods += check_ordinal(scale.model, kept)
    assert likelihoods > 0


def check_ordinal(model: Any, rows: textbook.Rows) -> bool:
    """Compare the likelihood where the fit is not singular; count what was used in any case."""
    cells = [(r["person"], s == "FDVV", v) for r in rows for s, v in r["ratings"].items() if v is not None]
    assert model.n == len(cells)
    assert model.missing == 2 * len(rows) - len(cells)
    assert (model.correlation is None) == bool(model.singular)
    if model.singular or model.problem:
        return False
    person, slope, ratings = (np.array(column) for column in zip(*cells, strict=True))
    plain = textbook.ordinal_log_likelihood(ratings, person, slope.astype(float), model)
    assert_allclose(model.log_likelihood, plain, atol=2e-3)
    return True


@TENTHS
def test_many_renderings(part: int, tmp_path: Path) -> None:
    tested = 0
    for seed in draws(part):
        rows = drawn(seed, FOUR, "mushra")
        found = analysed(rows, "mushra", tmp_path)
        kept, _ = textbook.screened(rows)
        for one in found.rated:
            here = [row for row in kept if one.button in ("", row["item"])]
            tested += check_rated(one, here, sorted({row["item"] for row in rows}))
    assert tested > DRAWS / 10


def by_person(rows: textbook.Rows, stimuli: tuple[str, ...], buttons: list[str]) -> np.ndarray:
    """Return people's means of complete trials, those of each button first, of who has all of them."""
    cells: dict[tuple[str, str], list[list[float]]] = defaultdict(list)
    for row in rows:
        values = [row["ratings"][s] for s in stimuli]
        if None not in values:
            cells[row["person"], row["item"]].append(values)
    whole = [p for p in sorted({p for p, _ in cells}) if all((p, b) in cells for b in buttons)]
    return np.array([np.mean([np.mean(cells[p, b], axis=0) for b in buttons], axis=0) for p in whole])


def check_rated(found: Any, rows: textbook.Rows, buttons: list[str]) -> int:
    places = [found.button] if found.button else buttons
    complete = by_person(rows, FOUR, places)
    if found.friedman is not None:
        assert found.friedman.people == len(complete)
        close(found.friedman, textbook.friedman(np.round(complete, 9)))
    for pair in found.pairs:
        both = by_person(rows, (pair.first, pair.second), places)
        close(pair.test, textbook.signed_rank((both[:, 0] - both[:, 1]).tolist()))
    if found.pairs:
        assert_allclose(
            [one.holm_p for one in found.pairs], textbook.holm([one.test.p_exact for one in found.pairs])
        )
    return found.friedman is not None


@TENTHS
def test_right_and_wrong(part: int, tmp_path: Path) -> None:
    for seed in draws(part):
        rows = drawn(seed, TWO, "abx")
        found = analysed(rows, "abx", tmp_path)
        kept, _ = textbook.screened(rows)
        for one in (found.preference, *found.by_button):
            assert one is not None
            here = [r for r in kept if one.button in ("", r["item"]) and r["correct"] is not None]
            right = sum(r["correct"] for r in here)
            assert (one.more_count, one.less_count) == (right, len(here) - right)
            by: dict[str, list[float]] = defaultdict(list)
            for row in here:
                by[row["person"]].append(row["correct"])
            if len(by) > 1:
                share = textbook.shares({p: (int(sum(v)), len(v)) for p, v in by.items()})
                close(one.people_share, {k: share[k] for k in ("share", "low", "high")})
                close(
                    one.test,
                    textbook.signed_rank(
                        [m - 0.5 for m in textbook.person_means([(p, v) for p, vs in by.items() for v in vs])]
                    ),
                )
            check_distances(one, int(right), len(here))


def check_distances(found: ChoiceResult, right: int, n: int) -> None:
    """Check d', its bounds by Clopper and Pearson or of people, each by the rule, and the one-sided p."""
    for one in found.d:
        rule = textbook_levels.abx_independent if "independent" in one.method else textbook_levels.abx
        share = found.people_share if one.people else None
        bounds = (share.low, share.high) if share else proportion_confint(right, n, method="beta")
        wanted = [textbook_levels.distance(at, rule, False) for at in (right / n, *bounds)]
        assert_allclose([one.d, one.low, one.high], wanted, atol=1e-8)
        if not one.people:
            assert_allclose(one.p, binomtest(right, n, alternative="greater").pvalue, atol=1e-12)


@TENTHS
def test_scores_of_complete_people(part: int, tmp_path: Path) -> None:
    import pandas as pd

    tested = 0
    for seed in draws(part):
        rows = drawn(seed, TWO, "timing")
        found = analysed(rows, "timing", tmp_path).timing
        kept, _ = textbook.screened(rows)
        assert found is not None
        if found.anova is None:
            continue
        cells, whole = textbook.cells_and_whole(kept, found.buttons, TWO)
        assert found.anova.people == len(whole)
        table = pd.DataFrame(
            [(p, b, s, np.mean(v)) for (p, b, s), v in cells.items() if p in whole], columns=list("pbsy")
        )
        plain = AnovaRM(table, "y", "p", within=["b", "s"]).fit().anova_table
        assert_allclose([one.F for one in found.anova.effects], plain["F Value"], rtol=1e-7, atol=1e-9)
        assert_allclose([one.p for one in found.anova.effects], plain["Pr > F"], rtol=1e-7, atol=1e-9)
        tested += 1
    assert tested > DRAWS / 10 / 2
