"""The statistics of a study as textbooks define them, from plain rows: slow, and nothing of fdvv in it.

Signs are turned one by one (2^k of them), Walsh averages listed, tests are statsmodels' and SciPy's.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from scipy import stats
from statsmodels.stats.proportion import proportion_confint  # type: ignore[import-untyped]

Rows = list[dict[str, Any]]
"""A row is a trial: person, item, round, choice ("" for none), correct (None), and ratings by stimulus."""


def screened(rows: Rows) -> tuple[Rows, set[str]]:
    """Return the rows of who answered at least three quarters of theirs, and who that is not."""
    answered: dict[str, list[bool]] = defaultdict(list)
    for row in rows:
        rated = any(value is not None for value in row["ratings"].values())
        answered[row["person"]].append(bool(row["choice"]) or row["correct"] is not None or rated)
    out = {person for person, given in answered.items() if 1 - np.mean(given) > 0.25}
    return [row for row in rows if row["person"] not in out], out


def cells_and_whole(
    rows: Rows, items: Sequence[str], stimuli: Sequence[str]
) -> tuple[dict[tuple[str, str, str], list[float]], list[str]]:
    """Return the ratings by person, item and stimulus, and who rated every stimulus on every item."""
    cells: dict[tuple[str, str, str], list[float]] = defaultdict(list)
    for row in rows:
        for stimulus, value in row["ratings"].items():
            if value is not None:
                cells[row["person"], row["item"], stimulus].append(value)
    people = sorted({person for person, *_ in cells})
    return cells, [p for p in people if all((p, item, s) in cells for item in items for s in stimuli)]


def person_means(values: list[tuple[str, float]]) -> list[float]:
    """Average the values of each person, people in the order of their names."""
    by: dict[str, list[float]] = defaultdict(list)
    for person, value in values:
        by[person].append(value)
    return [sum(by[person]) / len(by[person]) for person in sorted(by)]


def signed_rank(differences: list[float]) -> dict[str, float]:
    """Test differences by turning the sign of every one that is not 0."""
    rounded = [round(value, 9) for value in differences]
    apart = [value for value in rounded if value != 0]
    ranks = stats.rankdata(np.abs(apart)) if apart else np.empty(0)
    plus = float(sum(r for r, value in zip(ranks, apart, strict=True) if value > 0))
    minus = float(ranks.sum()) - plus
    signs = np.array(list(product((0.0, 1.0), repeat=len(apart)))) if apart else np.zeros((1, 0))
    sums = signs @ ranks
    centre = ranks.sum() / 2
    p_exact = float(np.mean(np.abs(sums - centre) >= abs(plus - centre) - 1e-9))
    root = float(np.sqrt((ranks**2).sum() / 4))
    z = (min(plus, minus) - centre) / root if apart else 0.0
    walsh = sorted((a + b) / 2 for i, a in enumerate(differences) for b in differences[i:])
    found = {
        "n": len(rounded), "zeros": len(rounded) - len(apart), "w_plus": plus, "w_minus": minus,
        "z": z, "p_asymptotic": 2 * float(stats.norm.cdf(z)), "p_exact": p_exact,
        "effect": (plus - minus) / (plus + minus) if apart else 0.0, "shift": float(np.median(walsh)),
    }  # fmt: skip
    cut = _rejected(len(rounded))
    return found | ({"low": walsh[cut[-1]], "high": walsh[-1 - cut[-1]]} if cut else {})


@cache
def _rejected(n: int) -> list[int]:
    """Return the sums of n untied ranks in the lower tail of 2.5 %, ways counted rank by rank."""
    ways = {0: 1}
    for rank in range(1, n + 1):
        taken = {total + rank: count for total, count in ways.items()}
        ways = {t: ways.get(t, 0) + taken.get(t, 0) for t in ways | taken}
    return [w for w in sorted(ways) if sum(c for t, c in ways.items() if t <= w) <= 0.025 * 2**n]


def spread(values: list[float]) -> dict[str, float]:
    """Return the mean of people with the interval of the t distribution."""
    mean, half = float(np.mean(values)), stats.t.ppf(0.975, len(values) - 1) * float(stats.sem(values))
    return {
        "mean": mean, "low": mean - half, "high": mean + half,
        "sd": float(np.std(values, ddof=1)), "median": float(np.median(values)),
    }  # fmt: skip


def holm(p: list[float]) -> list[float]:
    """Correct p step by step (Holm 1979); statsmodels' multipletests collects garbage each call: 0.1 s."""
    found, worst = [0.0] * len(p), 0.0
    for rank, place in enumerate(sorted(range(len(p)), key=lambda i: p[i])):
        worst = max(worst, min(1.0, (len(p) - rank) * p[place]))
        found[place] = worst
    return found


def shares(counts: dict[str, tuple[int, int]]) -> dict[str, float]:
    """Return a share over people by Korn and Graubard. counts : successes and answers of each person."""
    k, n = (np.array(column, dtype=float) for column in zip(*counts.values(), strict=True))
    total, share = n.sum(), k.sum() / n.sum()
    wilson = proportion_confint(k.sum(), total, method="wilson")
    between = k.size / (k.size - 1) * np.sum((n / total) ** 2 * (k / n - share) ** 2)
    if share in (0, 1):
        counted = float(k.size)
    elif between == 0 or total == k.size:
        # of one answer each there is no likeness to allow for
        counted = total
    else:
        t = stats.t.ppf(0.975, total - 1) / stats.t.ppf(0.975, k.size - 1)
        counted = min(total, share * (1 - share) / between * t**2)
    low = stats.beta.ppf(0.025, share * counted, counted - share * counted + 1) if share else 0.0
    high = stats.beta.ppf(0.975, share * counted + 1, counted - share * counted) if share < 1 else 1.0
    return {"share": share, "low": low, "high": high, "wilson_low": wilson[0], "wilson_high": wilson[1]}


def friedman(scores: np.ndarray) -> dict[str, float]:
    """Return Friedman's test of complete people, with Kendall's W and Iman and Davenport's F."""
    n, k = scores.shape
    chi2, p = stats.friedmanchisquare(*scores.T)
    w = chi2 / (n * (k - 1))
    f = (n - 1) * w / (1 - w) if w < 1 else np.inf
    return {"chi2": chi2, "p": p, "W": w, "F": f, "F_p": stats.f.sf(f, k - 1, (k - 1) * (n - 1))}


def ordinal_log_likelihood(ratings: np.ndarray, person: np.ndarray, slope: np.ndarray, model: Any) -> float:
    """Integrate the likelihood of a cumulative probit model on a fine grid, at a model's own numbers."""
    at = np.linspace(-6, 6, 61)
    weight = np.exp(-0.5 * at**2) * (at[1] - at[0]) / np.sqrt(2 * np.pi)
    a, b = np.meshgrid(at, at, indexing="ij")
    r = model.correlation
    own = model.person_sd[0] * a
    more = model.person_sd[1] * (r * a + np.sqrt(1 - r**2) * b)
    edges = np.concatenate([[-np.inf], model.thresholds, [np.inf]])
    place = {value: i for i, value in enumerate(model.categories)}
    total = 0.0
    for who in np.unique(person):
        log = np.zeros_like(a)
        for value, x in zip(ratings[person == who], slope[person == who], strict=True):
            mean = own + x * (model.effects[0].value + more)
            i = place[value]
            log += np.log(
                np.maximum(stats.norm.cdf(edges[i + 1] - mean) - stats.norm.cdf(edges[i] - mean), 1e-300)
            )
        total += float(np.log(np.sum(np.exp(log) * np.outer(weight, weight))))
    return total
