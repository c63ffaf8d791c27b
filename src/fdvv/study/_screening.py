"""Who and what does not count, by rules that were fixed beforehand."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fdvv.study._answers import Answers
from fdvv.study._claim_values import is_answered
from fdvv.study._plan import Exclusion

REFERENCE_SHARE = 0.15
"""Part of the trials in which the hidden reference may be rated too low (ITU-R BS.1534-3, 4.1.2)."""
WIDE_SCALE = 20.0
"""A rating above this tells a scale to 100; on a scale of 7 the rule on the hidden reference says nothing."""


@dataclass(frozen=True)
class Screening:
    """What the rules left.

    Attributes
    ----------
    answers : with the reason of every row that does not count. planned, answered, counted : rows.
    reasons : rows left out, by reason; a row that nobody answered is missing, not left out.
    people : all of them. left_out : why, by person that counts with no row.
    """

    answers: Answers
    planned: int
    answered: int
    counted: int
    reasons: Mapping[str, int]
    people: tuple[str, ...]
    left_out: Mapping[str, str]

    @property
    def people_counted(self) -> int:
        """Get how many people are left with an answer."""
        counts = self.answers.counts & is_answered(self.answers)
        return len(set(self.answers.person[counts].tolist()))


def screen(answers: Answers, rule: Exclusion | None = None) -> Screening:
    """Leave out people by rule, in addition to the trials that are left out already.

    Who lacks more than rule.share_missing of the trials is left out, and of a MUSHRA-like study who failed to
    find the hidden reference. Rules about trials and labels need telemetry and the labels: they are applied
    where a study is unsealed.
    """
    rule = rule or Exclusion()
    answered = is_answered(answers)
    excluded = np.full(len(answers.person), "", object)
    if answers.excluded is not None:
        excluded[:] = answers.excluded
    left_out: dict[str, str] = {}
    for person in dict.fromkeys(answers.person.tolist()):
        rows = answers.person == person
        reason = _reason(answers, rows, answered & (excluded == ""), rule)
        if reason:
            left_out[person] = reason
            excluded[rows & (excluded == "")] = reason
    names, counts = np.unique(excluded[answered & (excluded != "")].astype(str), return_counts=True)
    return Screening(
        replace(answers, excluded=excluded.astype(str)),
        planned=len(answered),
        answered=int(answered.sum()),
        counted=int(np.sum(answered & (excluded == ""))),
        reasons=dict(zip(names.tolist(), counts.tolist(), strict=True)),
        people=tuple(dict.fromkeys(answers.person.tolist())),
        left_out=left_out,
    )


def unscreened(answers: Answers) -> Answers:
    """Give all answers back, as if no rule left any out."""
    return replace(answers, excluded=None)


def _reason(answers: Answers, rows: np.ndarray, valid: np.ndarray, rule: Exclusion) -> str:
    """Tell why a person does not count; "" where they do."""
    told: Counter[str] = Counter() if answers.excluded is None else Counter(answers.excluded[rows].tolist())
    if told and not valid[rows].any() and not told[""]:
        return str(told.most_common(1)[0][0])
    missing = 1.0 - valid[rows].mean()
    if missing > rule.share_missing:
        return f"more than {100 * rule.share_missing:.0f} % of the person's trials are missing"
    if answers.kind == "mushra" and _misses_reference(answers, rows & valid, rule.reference_points):
        return "the person did not find the hidden reference"
    return ""


def _misses_reference(answers: Answers, rows: np.ndarray, least: float) -> bool:
    for columns in answers.ratings.values():
        reference = columns[rows, 0]
        reference = reference[np.isfinite(reference)]
        if np.nanmax(columns, initial=0.0) > WIDE_SCALE and reference.size:
            return bool(np.mean(reference < least) > REFERENCE_SHARE)
    return False
