"""Trials and people that do not count, by the rules that were frozen with the study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fdvv.study import EQUAL, Answers, Exclusion, Rendered, screen


def trial_reason(rule: Exclusion, rendered: Sequence[Rendered]) -> str:
    """Tell why an answered trial does not count, from what was rendered in it; empty if it does."""
    if not rendered:
        return "no record of what was rendered"
    faults = next((one.faults for one in rendered if one.faults), ())
    if rule.fault and faults:
        return f"device fault: {faults[0]}"
    fewest = min(one.presses for one in rendered)
    if fewest < rule.presses:
        return f"a rendering was pressed {fewest} times, fewer than {rule.presses}"
    worst = max(_typical_cN(one) for one in rendered)
    if worst > rule.error_cN:
        return (
            f"half the presses of a rendering missed its force by {worst:.1f} cN, more than {rule.error_cN:g}"
        )
    return ""


def _typical_cN(one: Rendered) -> float:
    """Give the error of the middle press: one that was too fast for any rig says nothing of the rendering."""
    errors = [error for error in one.error_cN if error is not None]
    return float(np.median(errors)) if errors else 0.0


def exclude_people(answers: Answers, labels: Sequence[str], rule: Exclusion) -> Answers:
    """Leave out people by rule, beside the trials that are left out already.

    labels : (n,) the label that was chosen in each row, "" where none was: only here it is still known.
    """
    assert answers.excluded is not None
    excluded = answers.excluded.astype(object)
    for person in dict.fromkeys(answers.person.tolist()):
        rows = answers.person == person
        given = [label for label, here in zip(labels, rows, strict=True) if here and label]
        # "equal" is no label: who never feels a difference answers in earnest
        labelled = Counter(label for label in given if label != EQUAL)
        share = max(labelled.values(), default=0) / max(1, len(given))
        if share > rule.same_choice:
            reason = f"the person gave one label in {100 * share:.0f} % of the trials"
            excluded[rows & (excluded == "")] = reason
    return screen(replace(answers, excluded=excluded.astype(np.str_)), rule).answers
