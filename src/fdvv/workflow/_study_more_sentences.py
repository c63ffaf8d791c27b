"""What ratings of many, staircases, timing and the multiverse say, in sentences written from the numbers."""

from __future__ import annotations

import math

from fdvv.study import Multiverse
from fdvv.workflow._experiment_words import effect_text, sphericity_text
from fdvv.workflow._study_records import RatedResult, StudyAnalysis, TimingResult
from fdvv.workflow._study_sentences import ALPHA
from fdvv.workflow._study_words import exact_p, fixed, listing, many, people_text, percent, unbroken

HALF = 0.5


def rated_sentence(one: RatedResult) -> str:
    """Tell what Friedman's test and the pairs say of all renderings."""
    where = f"over all buttons, {one.rating}" if not one.button else f"{one.button}, {one.rating}"
    means = [f"{name} {fixed(spread.mean, 1)}" for name, spread in one.spreads.items()]
    told = f"Means, {where}: {', '.join(means)}."
    if one.friedman is not None:
        f = one.friedman
        told += (
            f" Friedman's test of {people_text(f.people)}: χ²({f.df}) = {fixed(f.chi2)}, "
            f"{exact_p(f.p)}, W = {fixed(f.W)}."
        )
    alike = [f"{p.first} and {p.second}" for p in one.pairs if p.holm_p >= ALPHA]
    if one.pairs and not alike:
        return f"{told} All pairs differ significantly (Holm's correction)."
    if not alike:
        return told
    if len(alike) == len(one.pairs) > 1:
        return f"{told} No pair differs significantly (Holm's correction)."
    return f"{told} No significant difference between {listing(alike)} (Holm's correction)."


def threshold_sentences(found: StudyAnalysis) -> tuple[str, ...]:
    """Tell the threshold over people, and how many staircases have none."""
    told = []
    one = found.threshold
    without = sum(math.isnan(t.threshold.value) for t in found.thresholds)
    if one is not None:
        ends = f"{fixed(100 * one.low, 1)} to {percent(one.high, 1)}"
        bounds = "" if math.isnan(one.low) else f"; 95 % interval {ends}"
        told.append(
            f"Added force is told apart from {percent(one.mean, 1)} on (geometric mean of "
            f"{people_text(one.people)}{bounds}; median {percent(one.median, 1)})."
        )
    if without:
        told.append(f"{many(without, 'staircase')} turned round too seldom to tell a threshold.")
    return tuple(told)


def multiverse_sentences(found: Multiverse) -> tuple[str, ...]:
    """Tell how far the main claim depends on how it is analysed."""
    shares = [one.share for one in found.specifications]
    main, count = found.registered, len(found.specifications)
    ends = [percent(min(shares), 1), percent(max(shares), 1)]
    ranges = f"is {ends[0]} in each" if ends[0] == ends[1] else f"ranges from {ends[0]} to {ends[1]}"
    ways = many(count, "reasonable way", "reasonable ways")
    said = _agreement(found) if main.share != HALF else "the main analysis finds no difference"
    return (
        f"{ways} to analyse the main claim: the share for it {ranges}; {said}.",
        "Ways differ in who and what is left out, in the measure, in what is counted as one (people, people "
        "and buttons, trials), in ties split or dropped, and in the test. Ways that count trials treat one "
        "person's answers as independent, which they are not; they are shown because they are often used.",
    )


def _agreement(found: Multiverse) -> str:
    """Tell how many ways point the same way, and how many of them are significant."""
    main, count = found.registered, len(found.specifications)
    every = "all" if found.agreeing == count else str(found.agreeing)
    significant = "all" if found.significant == count else f"{found.significant} of them"
    same = f"{every} point the same way as the main analysis"
    return f"{same} ({percent(main.share, 1)}, {exact_p(main.p)}), {significant} with p < {found.alpha:g}"


def timing_sentences(found: TimingResult) -> tuple[str, ...]:
    """Tell every effect of the analysis of variance, significant or not, and sphericity."""
    if found.anova is None:
        return ()
    told = []
    for effect in found.anova.effects:
        what = "interaction" if "×" in effect.name else "main effect"
        verdict = "is significant" if effect.corrected_p < ALPHA else "is not significant"
        told.append(f"The {what} of {effect.name} {verdict}, {effect_text(effect)}.")
    text = f"{found.measure_text.capitalize()} of {people_text(found.anova.people)}: {' '.join(told)}"
    spheres = " ".join(filter(None, map(sphericity_text, found.anova.effects)))
    return tuple(unbroken(one) for one in (text, spheres) if one)
