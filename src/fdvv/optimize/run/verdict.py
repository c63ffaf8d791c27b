"""What a run came to, in a sentence: the retest of the recommended design against the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fdvv.optimize.problem import Answer, TrialState
from fdvv.optimize.run.session import Optimization
from fdvv.optimize.space import Design, DesignSpace

BOUND_RATIO = 0.01
"""A value that is this near to a bound, in proportion to the range, is at it."""
LEVEL = 0.95
PARTS = {"bump_cN": ("bump_mm", "snap_mm"), "vibration_gain_ratio": ("vibration_Hz", "vibration_mm")}
"""What is without effect where the first is as good as 0."""
Kind = Literal["better", "same", "worse"]


@dataclass(frozen=True)
class Retest:
    """How much better the recommended design is than the start, the same person playing both blind.

    Attributes
    ----------
    pairs : played. difference, low, high : of the first objective, positive where the design is better, with
        its 95 % interval (Student's t over pairs); of comparisons the share for it less one half (Wilson's).
    chance : that it is better: the posterior probability under a flat prior.
    """

    pairs: int
    difference: float
    low: float
    high: float
    chance: float

    @property
    def kind(self) -> Kind:
        return "better" if self.low > 0 else "worse" if self.high < 0 else "same"


def retest_of(session: Optimization) -> Retest | None:
    """Return what the retest found; None of fewer than two pairs."""
    return _of_answers(session) if session.setup.preference else _of_scores(session)


def _of_scores(session: Optimization) -> Retest | None:
    objective, start = session.problem.objectives[0], session.start
    trials = session.retests
    pairs = [pair for pair in zip(trials[::2], trials[1::2], strict=False) if _scored(*pair)]
    better = []
    for one, other in pairs:
        before, after = (other, one) if other.design == start else (one, other)
        values = (trial.scores[objective.name].value for trial in (before, after))
        better.append(objective.sign * -float(np.diff(list(values))[0]))
    return paired(better)


def _scored(*trials: object) -> bool:
    return all(getattr(trial, "state", None) is TrialState.DONE for trial in trials)


def paired(better: Sequence[float]) -> Retest | None:
    """Return mean, interval and chance of differences; None of fewer than two."""
    from scipy.stats import t as student

    n = len(better)
    if n < 2:
        return None
    mean, error = float(np.mean(better)), float(np.std(better, ddof=1) / np.sqrt(n))
    if error == 0:
        return Retest(n, mean, mean, mean, float(np.heaviside(mean, 0.5)))
    half = float(student.ppf(0.5 + LEVEL / 2, n - 1)) * error
    return Retest(n, mean, mean - half, mean + half, float(student.cdf(mean / error, n - 1)))


def _of_answers(session: Optimization) -> Retest | None:
    """Count answers for the recommended design; equal ones count for neither."""
    from scipy.stats import beta

    from fdvv.stats.share import share

    said = [one for one in session.retest_comparisons if one.answer not in (None, Answer.EQUAL)]
    if len(said) < 2:
        return None
    for_it = sum((one.first if one.answer is Answer.FIRST else one.second) != session.start for one in said)
    found = share(for_it, len(said))
    chance = float(beta.sf(0.5, for_it + 1, len(said) - for_it + 1))
    return Retest(len(said), found.share - 0.5, found.low - 0.5, found.high - 0.5, chance)


PHRASES = {
    "asynchrony_ms": ("closer to the bullet", "farther from the bullet", "ms", 1.0, 0),
    "rate_Hz": ("faster", "slower", "taps per second", 1.0, 2),
    "errors_ratio": ("fewer errors", "more errors", "%", 100.0, 1),
}
"""Of a first objective: better and worse in words, the unit, by what a value is multiplied, digits."""


def verdict_kind(session: Optimization) -> Kind | None:
    """Return what the retest says of the recommended design; None while it is not over."""
    if not session.finished or not (session.trials or session.comparisons or session.lines):
        return None
    if session.recommended() == session.start:
        return "same"
    found = retest_of(session)
    return found.kind if found else None


def verdict_sentence(session: Optimization) -> str | None:
    """Return what a run came to in one sentence; None while it is not over, or where nothing was retested."""
    kind, name = verdict_kind(session), session.setup.start_name
    if kind is None:
        return None
    played = ", simulated" if session.setup.simulated else ""
    found = retest_of(session)
    if found is None:
        return f"No better design found{played}; keep {name}."
    if session.setup.preference:
        count = round((found.difference + 0.5) * found.pairs)
        share = f"95 %: {100 * (found.low + 0.5):.0f} to {100 * (found.high + 0.5):.0f} %"
        end = "." if kind == "better" else f"; keep {name}."
        return f"Preferred to {name} in {count} of {found.pairs} answers ({share}){end}"
    better, worse, unit, scale, digits = PHRASES.get(
        session.problem.objectives[0].name, ("better", "worse", "", 1.0, 2)
    )
    low, high, by = (_number(scale * value, digits) for value in (found.low, found.high, found.difference))
    if kind == "same":
        return f"No difference found (95 %: {low} to {high} {unit}){played}; keep {name}."
    if kind == "better":
        return f"{by} {unit} {better} than {name} (95 %: {low} to {high} {unit}){played}."
    low, high = (_number(-scale * value, digits) for value in (found.high, found.low))
    by = _number(-scale * found.difference, digits)
    return f"{by} {unit} {worse} than {name} (95 %: {low} to {high} {unit}){played}; keep {name}."


def _number(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}"
    return (text if float(text) else text.lstrip("-")).replace("-", "−")


def at_bound(
    space: DesignSpace, design: Design, start: Design | None = None
) -> dict[str, Literal["least", "most"]]:
    """Return which values of a design are at a bound, where a better one may lie outside.

    Not those that the start has as well, nor those of a bump or a vibration that is not there.
    """
    none = [one.name for one in space.parameters if design[one.name] < BOUND_RATIO * (one.high - one.low)]
    gone = {name for what, names in PARTS.items() if what in none for name in names}
    found: dict[str, Literal["least", "most"]] = {}
    for one in space.parameters:
        if one.name in gone:
            continue
        value, near = design[one.name], BOUND_RATIO * (one.high - one.low)
        if start is not None and abs(start[one.name] - value) < near:
            continue
        if value - one.low < near:
            found[one.name] = "least"
        elif one.high - value < near:
            found[one.name] = "most"
    return found
