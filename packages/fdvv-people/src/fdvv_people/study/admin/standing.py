"""How far a study is, in a sentence: what is missing before it is frozen, who is done, what was found."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from fdvv_people.study.admin.study import Study
from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.analysis.sentences import claim_sentence
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.study.files.people import people_of
from fdvv_people.study.plan.plan import ADAPTIVE, StudyPlan

SHARE = 0.7
"""Of answers for the claim, in truth: what a study is sized for."""
ALIKE = 0.1
"""How alike the answers of one person are (intraclass correlation, assumed)."""
Kind = Literal["", "good", "warning"]


def planned_power(plan: StudyPlan) -> float | None:
    """Return the power to find that SHARE of the answers are for a claim about choices; None of any other.

    Exact binomial, two-sided at the claim's level, of as many independent answers as those of all people come
    to; nobody answers "equal". `fdvv study power` simulates people instead.
    """
    from scipy.stats import binom

    from fdvv_people.stats.share import binomial_p

    if plan.claim is None or plan.claim.measure != "choice" or plan.kind in ("mushra", *ADAPTIVE):
        return None
    n = max(2, round(plan.people * plan.trials / (1 + (plan.trials - 1) * ALIKE)))
    counts = np.arange(math.floor(n / 2) + 1, n + 1)
    found = counts[binomial_p(counts, np.full_like(counts, n)) <= plan.claim.alpha]
    return float(binom.pmf(found, n, SHARE).sum())


def draft_sentence(plan: StudyPlan, problems: tuple[str, ...]) -> tuple[str, Kind]:
    """Return what a plan comes to, or what is missing before it can be frozen."""
    if problems:
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        return f"Not ready to freeze: {problems[0]}{more}.", "warning"
    people = f"{plan.people} participant{'s' * (plan.people != 1)}"
    power = planned_power(plan)
    text = (
        "" if power is None else f", power {power:.2f} if {100 * SHARE:.0f} % of the answers favour the claim"
    )
    return f"Ready to freeze: {people} × {plan.trials} trials{text}.", "good"


def standing(study: Study) -> tuple[str, Kind]:
    """Return how far a frozen study is, or what an unsealed one found. InputError."""
    history = study.history()
    if any("unsealed" in record for record in history):
        return _found(study)
    done = sum("finished" in record for record in history)
    people = len([one for one in people_of(history) if one.state not in ("withdrawn", "deleted")])
    planned = study.plan.people
    if done >= planned:
        return f"All {planned} participants are done: unseal the study to see what they said.", "good"
    now = f"; {people - done} at it" if people > done else ""
    return f"{done} of {planned} participants done{now}.", ""


def _found(study: Study) -> tuple[str, Kind]:
    found = analyse(read_answers(study.folder / UNSEALED), study.plan)
    if found.claim is None:
        return "The study is open; it claims nothing, so read its report.", ""
    return claim_sentence(found.claim), "good" if found.claim.supported else "warning"
