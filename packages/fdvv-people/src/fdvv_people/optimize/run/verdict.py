"""What a run came to, in a sentence: the retest of the recommended design against the start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.state import RunState
from fdvv_people.optimize.space import Design, DesignSpace
from fdvv_people.task.questionnaire import HIGHEST, LIKING
from fdvv_people.task.score import Objective

BOUND_RATIO = 0.01
"""A value that is this near to a bound, in proportion to the range, is at it."""
LEVEL = 0.95
PARTS = {"bump_cN": ("bump_mm", "snap_mm"), "vibration_gain_ratio": ("vibration_Hz", "vibration_mm")}
"""What is without effect where the first is as good as 0."""
Kind = Literal["better", "same", "worse", "mixed"]
"""What was found; mixed : better in one objective, worse in another."""


def kind_of(low: float, high: float) -> Kind:
    """Return what the interval of a difference says, positive where a design is better."""
    return "better" if low > 0 else "worse" if high < 0 else "same"


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
        return kind_of(self.low, self.high)


def retest_of(session: RunState) -> Retest | None:
    """Return what the retest found; None of fewer than two pairs."""
    return _of_answers(session) if session.setup.preference else _of_scores(session)


def _of_scores(session: RunState) -> Retest | None:
    return retests_of(session).get(session.problem.objectives[0].name)


def retests_of(session: RunState) -> dict[str, Retest]:
    """Return what the retest found by objective, of those that were scored; empty of comparisons.

    Several intervals hold together with LEVEL: each has the level of Bonferroni.
    """
    pairs = [(block.found, block.start) for block in session.blocks if block.found is not block.start]
    objectives = session.problem.objectives
    level = 1 - (1 - LEVEL) / len(objectives)
    found = {one.name: paired(gains(session, pairs, one), level) for one in objectives}
    return {name: one for name, one in found.items() if one is not None}


def gains(
    session: RunState, pairs: Sequence[tuple[Trial, Trial]], objective: Objective | None = None
) -> list[float]:
    """Return by how much the first of two trials is better, of those where both are scored.

    objective : in which; None: the first.
    """
    objective = objective or session.problem.objectives[0]
    both = ([one.scores[objective.name].value for one in pair] for pair in pairs if scored(*pair))
    return [objective.sign * (other - mine) for mine, other in both]


def scored(*trials: Trial) -> bool:
    return all(trial.state is TrialState.DONE for trial in trials)


def paired(better: Sequence[float], level: float = LEVEL) -> Retest | None:
    """Return mean, interval of a level and chance of differences; None of fewer than two."""
    from scipy.stats import t as student

    n = len(better)
    if n < 2:
        return None
    mean, error = float(np.mean(better)), float(np.std(better, ddof=1) / np.sqrt(n))
    if error == 0:
        return Retest(n, mean, mean, mean, float(np.heaviside(mean, 0.5)))
    half = float(student.ppf(0.5 + level / 2, n - 1)) * error
    return Retest(n, mean, mean - half, mean + half, float(student.cdf(mean / error, n - 1)))


def _of_answers(session: RunState) -> Retest | None:
    """Count answers for the recommended design; equal ones count for neither."""
    from scipy.stats import beta

    from fdvv_people.stats.share import share

    said = [trial for trial in session.retests if len(trial.best or ()) == 1]
    if len(said) < 2:
        return None
    for_it = sum(trial.designs[place] != session.start for trial in said for place in trial.best or ())
    found = share(for_it, len(said))
    chance = float(beta.sf(0.5, for_it + 1, len(said) - for_it + 1))
    return Retest(len(said), found.share - 0.5, found.low - 0.5, found.high - 0.5, chance)


@dataclass(frozen=True)
class Phrase:
    """How a difference in an objective is written.

    Attributes
    ----------
    better, worse : in words. unit : shown. scale : by which a value is multiplied for it. digits : shown.
    what : the objective in words, for a sentence that finds no difference in it.
    """

    better: str
    worse: str
    unit: str
    scale: float = 1.0
    digits: int = 0
    what: str = "the score"

    def number(self, value: float) -> str:
        """Write a value without its unit."""
        text = f"{self.scale * value:.{self.digits}f}"
        return (text if float(text) else text.lstrip("-")).replace("-", "−")

    def difference(self, value: float) -> str:
        """Write how much better one of two is, or how much worse below 0."""
        return f"{self.number(abs(value))} {self.unit} {self.better if value > 0 else self.worse}"

    def among_others(self, found: Retest) -> str:
        """Write what a retest found, as a part of a sentence on several objectives."""
        if found.low == found.high == 0:
            return f"no difference in {self.what}"
        if found.kind == "same":
            interval = f"({self.number(found.low)} to {self.number(found.high)} {self.unit})"
            return f"no difference found in {self.what} {interval}"
        low, high = sorted((abs(found.low), abs(found.high)))
        return f"{self.difference(found.difference)} ({self.number(low)} to {self.number(high)})"

    def doubt(self, low: float, high: float, chance: float) -> str:
        """Write an interval and the chance of being better, in brackets."""
        interval = f"95 %: {self.number(low)} to {self.number(high)} {self.unit}"
        return f"({interval}; chance of being better {chance_text(chance)})"


def chance_text(chance: float) -> str:
    """Write a chance in per cent; no finite number of trials makes one certain."""
    if chance > 0.999:
        return "over 99.9 %"
    return "below 0.1 %" if chance < 0.001 else f"{100 * chance:.1f} %"


PHRASES = {
    "asynchrony_ms": Phrase("closer to the bullet", "farther from the bullet", "ms", what="timing"),
    "lost_ratio": Phrase("fewer lost rounds", "more lost rounds", "%", 100.0, 1, "lost rounds"),
    "effort_N_s": Phrase("less effort", "more effort", "N s", digits=2, what="effort"),
    LIKING.name: Phrase("better liked", "worse liked", f"of {HIGHEST} points", digits=1, what="liking"),
    "rate_Hz": Phrase("faster", "slower", "taps per second", digits=2),
    "errors_ratio": Phrase("fewer errors", "more errors", "%", 100.0, 1),
}


def phrase_for(objective: Objective) -> Phrase:
    """Return how differences in an objective are written."""
    name = objective.name
    return PHRASES.get(name, Phrase("better", "worse", "", digits=2, what=name))


def phrase_of(session: RunState, objective: Objective | None = None) -> Phrase:
    """Return how differences in an objective of a run are written; None: in its first."""
    return phrase_for(objective or session.problem.objectives[0])


def verdict_kind(session: RunState) -> Kind | None:
    """Return what the retest says of the recommended design; None while it is not over."""
    if not session.finished or not session.trials:
        return None
    if session.recommended() == session.start:
        return "same"
    if session.setup.several:
        return _joined([one.kind for one in retests_of(session).values()])
    found = retest_of(session)
    return found.kind if found else None


def _joined(kinds: Sequence[Kind]) -> Kind | None:
    """Return what the kinds of several objectives come to; None of none."""
    if "better" in kinds:
        return "mixed" if "worse" in kinds else "better"
    return next((kind for kind in ("worse", "same") if kind in kinds), None)


def verdict_sentence(session: RunState) -> str | None:
    """Return what a run came to in one sentence; None while it is not over, or where nothing was retested."""
    kind, name = verdict_kind(session), session.setup.start_name
    if kind is None:
        return None
    played = ", simulated" if session.setup.simulated else ""
    found = retest_of(session)
    if found is None:
        return f"No better design found{played}; keep {name}."
    if session.setup.several:
        return _of_several(session, kind)
    if session.setup.preference:
        count = round((found.difference + 0.5) * found.pairs)
        share = f"95 %: {100 * (found.low + 0.5):.0f} to {100 * (found.high + 0.5):.0f} %"
        end = "." if kind == "better" else f"; keep {name}."
        return f"Preferred to {name} in {count} of {found.pairs} answers ({share}){played}{end}"
    phrase = phrase_of(session)
    doubt, by = phrase.doubt(found.low, found.high, found.chance), phrase.difference(found.difference)
    if kind == "same":
        return f"No difference found {doubt}{played}; keep {name}."
    if kind == "better":
        return f"{by} than {name} {doubt}{played}."
    doubt = phrase.doubt(-found.high, -found.low, found.chance)
    return f"{by} than {name} {doubt}{played}; keep {name}."


ENDS: Mapping[Kind, str] = {
    "better": "",
    "mixed": "; a gain for a loss: decide what counts more",
    "same": "; keep {name}",
    "worse": "; keep {name}",
}


def _of_several(session: RunState, kind: Kind) -> str:
    name, found = session.setup.start_name, retests_of(session)
    said = [
        phrase_of(session, one).among_others(found[one.name])
        for one in session.problem.objectives
        if one.name in found
    ]
    played = ", simulated" if session.setup.simulated else ""
    end = ENDS[kind].format(name=name)
    return f"Against {name}: {', '.join(said)}; the intervals hold together at 95 %{played}{end}."


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
