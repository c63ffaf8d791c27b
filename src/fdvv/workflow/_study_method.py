"""What data there were and how they were analysed, in paragraphs of a study's report."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np

from fdvv.workflow._experiment_words import listed
from fdvv.workflow._study_dict import PROXY
from fdvv.workflow._study_records import StudyAnalysis
from fdvv.workflow._study_words import fixed, listing, many, people_text

KINDS = {
    "realism": "which of two hidden renderings is closer to a named reference, or neither",
    "abx": "strict ABX: which of two renderings is the hidden X",
    "2afc": "two-alternative forced choice",
    "2ac": "two alternatives, with no difference allowed (2-AC)",
    "preference": "paired preference",
    "mushra": "ratings of all renderings, the named reference and anchors hidden among them",
    "staircase": "a transformed up-down staircase",
    "timing": "scores of timing by button and level",
}


def data_paragraphs(found: StudyAnalysis) -> tuple[str, ...]:
    """Tell who took part, what was answered and what does not count."""
    told = found.screening
    who = "simulated participants" if found.simulated else "people"
    people = f"{len(told.people)} {who}" if len(told.people) != 1 else f"1 {who.removesuffix('s')}"
    people = people.replace("1 people", "1 person")
    missing = told.planned - told.answered
    every = f"All {many(told.planned, 'trial')} were answered."
    whole = every if told.planned > 1 else "The one trial was answered."
    part = f"Of {many(told.planned, 'trial')} {told.answered} were answered, {missing} are missing."
    answered = part if missing else whole
    trials = (
        f"{people} met {many(len(found.buttons), 'button')} ({listing(found.buttons)}). Task: "
        f"{KINDS.get(found.kind, found.kind)}. {answered}"
    )
    return tuple(filter(None, [trials, _left_out(found), _time(found), *found.notes, _proxy(found)]))


def _left_out(found: StudyAnalysis) -> str:
    """Tell what does not count, and why."""
    told = found.screening
    if not told.reasons and not told.left_out:
        return "No trial and nobody was left out."
    trials = [f"{count}: {reason}" for reason, count in _grouped(told.reasons).items()]
    out = told.answered - told.counted
    does = "does" if out == 1 else "do"
    text = f"{many(out, 'answered trial')} {does} not count ({'; '.join(trials)})." if trials else ""
    left = f"{people_text(told.people_counted)} {'is' if told.people_counted == 1 else 'are'} left."
    if not told.left_out:
        return f"{text} {left}"
    alike: dict[str, list[str]] = {}
    for person, reason in told.left_out.items():
        alike.setdefault(reason, []).append(person)
    names = [f"{listing(people)} ({reason})" for reason, people in alike.items()]
    return f"{text} Left out as people: {listed(names)}. {left}".strip()


def _grouped(reasons: Mapping[str, int]) -> dict[str, int]:
    """Count reasons together that differ in what was measured alone, which is the first number in them."""
    alike: dict[str, list[str]] = {}
    for reason in reasons:
        alike.setdefault(re.sub(r"\d+(\.\d+)?", "…", reason, count=1), []).append(reason)
    return {
        (masked if len(group) > 1 else group[0]): sum(reasons[one] for one in group)
        for masked, group in alike.items()
    }


def _time(found: StudyAnalysis) -> str:
    times = [one.median_s for one in found.people if not math.isnan(one.median_s)]
    if not times:
        return ""
    return f"A trial took {fixed(float(np.median(times)), 1)} s (median of people's medians)."


def _proxy(found: StudyAnalysis) -> str:
    if not found.simulated:
        return ""
    return f"These are {PROXY}. They test the pipeline and plan power; they say nothing about people."


def method_paragraphs(found: StudyAnalysis) -> tuple[str, ...]:
    """Tell how everything in the report was computed, as far as it is in it."""
    told = []
    if found.tests or found.rated or found.preference:
        told.append(
            "Wilcoxon's signed-rank tests compare people's means over rounds; who does not differ is left "
            "out before ranking. Z carries the correction for ties and none for continuity, as SPSS prints "
            "it; the exact p counts all turns of the signs, with ties as they are, and decides what is "
            "called significant, after Holm's correction over buttons, at .05."
        )
    if found.preference is not None:
        told.append(
            "Intervals of shares count people: Clopper and Pearson's of as many answers as the spread "
            "between people leaves (Korn and Graubard 1998); of one person Wilson's, answers "
            "counted as independent. d′ is Thurstone's, by maximum likelihood; where answers may be equal, "
            "with τ, the difference that is still called equal (2-AC), and the interval of the profile "
            "likelihood; with people counted as people, a mixed model in which each has an own d′."
        )
    if found.thresholds:
        told.append(
            "A threshold is the geometric mean of the ratios at which a staircase turned round, the first "
            "turns left out (Levitt 1971); over people, the geometric mean with Student's interval on the "
            "logarithm."
        )
    if found.timing is not None:
        told.append("Scores are averaged over rounds; people are what is counted.")
    if found.multiverse is not None:
        told.append(
            "In the last figure every estimate is the share of answers for the claim, so that choices and "
            "ratings lie on one axis: a rating counts for the rendering that it puts higher, a tie as one "
            "half."
        )
    return tuple(told)
