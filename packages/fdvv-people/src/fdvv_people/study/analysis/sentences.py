"""What an analysis found, in sentences: written from the numbers, whatever they are."""

from __future__ import annotations

import math

from fdvv_people.report.prose import effect_text, listed, sphericity_text
from fdvv_people.study.analysis.records import (
    ButtonTest,
    ChoiceResult,
    ClaimResult,
    RatedResult,
    ScaleResult,
    StudyAnalysis,
    TimingResult,
)
from fdvv_people.study.analysis.words import (
    distance_text,
    exact_p,
    fixed,
    interval_of,
    listing,
    many,
    people_text,
    percent,
    rule_text,
    span,
    spread_text,
    test_text,
    unbroken,
)

ALPHA = 0.05
"""Level of everything but the main claim, which has its own."""

WIDE = 4.0
"""Ends of an interval over each other beyond which a JND is hardly known: a factor of two either way."""


def claim_sentence(found: ClaimResult) -> str:
    claim, test = found.claim, found.test
    stated = "stated before the first person" if found.registered else "not registered beforehand"
    text = f"Main claim ({stated}): {_claimed(found)}."
    if test.n < 2:
        return f"{text} One person cannot support it or speak against it."
    numbers = f"{test_text(test)}, {people_text(test.n)}, level {claim.alpha:g}"
    if test.n == test.zeros:
        return f"{text} The answers neither support it nor speak against it: nobody differs either way."
    if found.supported:
        return f"{text} The answers support it ({numbers})."
    if found.opposed:
        return f"{text} The answers say the opposite ({numbers})."
    return f"{text} The answers do not settle it ({numbers}); that is no proof that there is no difference."


def _claimed(found: ClaimResult) -> str:
    claim = found.claim
    if found.measure == "correct":
        return "answers are right more often than by guessing"
    if found.measure == "choice":
        return f"{claim.more} is chosen more often than {claim.less}"
    return f"{claim.more} is rated higher than {claim.less} in {found.measure}"


def choice_sentence(one: ChoiceResult) -> str:
    n = one.share.n
    text = (
        f"Of {many(n, 'answer')}, {one.more_count} ({percent(one.share.share)}; {interval_of(one.interval)})"
    )
    if one.more == "right":
        return f"{text} were right; guessing gives {percent(0.5, 0)}."
    rest = [f"{one.less_count} chose {one.less}"]
    rest += [f"{one.equal_count} said equal"] if one.equal_count else []
    return f"{text} chose {one.more}, {listed(rest)}."


def choice_asides(one: ChoiceResult) -> tuple[str, ...]:
    """Return what depends on how answers and ties are counted."""
    texts = []
    if one.people_share is not None:
        bounds = f"{fixed(100 * one.share.low, 1)} to {percent(one.share.high, 1)}"
        texts.append(f"Were all answers independent, the interval would be {bounds}.")
    if one.dropped is not None:
        texts.append(
            f"With ties split the share is {percent(one.split)}, with ties dropped "
            f"{percent(one.dropped.share)} of {many(one.dropped.n, 'answer')}."
        )
    if one.test is not None and one.more != "right":
        counted = f"{people_text(one.sign.plus)} more often for {one.more}, {one.sign.minus} for {one.less}"
        texts.append(f"Person by person: {counted}, {one.sign.zeros} even; {test_text(one.test)}.")
    return tuple(texts)


def button_sentence(one: ButtonTest) -> str:
    """Return the ratings of one button as the paper does."""
    numbers = f"({spread_text(one.more_spread)})", f"({spread_text(one.less_spread)})"
    if one.test.n < 2:
        return f"For {one.button}, the one person rated {one.more} {numbers[0]} and {one.less} {numbers[1]}."
    who = people_text(one.test.n)
    if one.test.n == one.test.zeros:
        return f"For {one.button}, all {who} rated {one.more} {numbers[0]} and {one.less} alike."
    significant = one.p_holm < ALPHA
    how = "higher" if one.test.effect > 0 else "lower"
    were = f"were significantly {how} than" if significant else "did not differ significantly from"
    zeros = f", {one.test.zeros} of them without a difference" if one.test.zeros else ""
    return (
        f"For {one.button}, ratings of {one.more} {numbers[0]} {were} those of {one.less} {numbers[1]}, with "
        f"{test_text(one.test)}; {who}{zeros}; with Holm's correction {unbroken(exact_p(one.p_holm))}."
    )


def ratings_sentence(tests: tuple[ButtonTest, ...]) -> str:
    """Return for which buttons ratings differ, Holm's correction over all of them."""
    if max(one.test.n for one in tests) < 2:
        return "One person's ratings are below; nothing is tested."
    yes = [one for one in tests if one.p_holm < ALPHA]
    if not yes:
        return (
            f"For none of {many(len(tests), 'button')} do ratings differ significantly (Holm's correction)."
        )
    parts = []
    for higher, word in ((True, "higher"), (False, "lower")):
        names = [one.button for one in yes if (one.test.effect > 0) == higher]
        every = "every button" if len(names) == len(tests) > 1 else listing(names)
        parts += [f"{tests[0].more} is rated {word} than {tests[0].less} for {every}"] if names else []
    rest = [one.button for one in tests if one not in yes]
    tail = f"; for {listing(rest)} there is no significant difference" if rest else ""
    return f"{' and '.join(parts)}{tail} (signed-rank tests of people's means, Holm's correction)."


def scale_sentence(one: ScaleResult) -> str:
    """Return the difference of ratings taken as ordered categories."""
    model, effect = one.model, one.model.of(one.more)
    if model.problem:
        return f"Taken as ordered categories, ratings show no difference: {model.problem}."
    text = (
        f"Taken as ordered categories over all buttons (cumulative probit, {people_text(model.people)} with "
        f"their own use of the scale and their own difference), the difference of {one.more} from {one.less} "
        f"is {fixed(effect.value)} {span(effect.low, effect.high)} standard deviations of a feeling, "
        f"z = {fixed(effect.z)}, {exact_p(effect.p)}; its SD between people is {fixed(model.person_sd[-1])}."
    )
    return unbroken(f"{text} But {model.singular}." if model.singular else text)


def smallest_sentence(tests: tuple[ButtonTest, ...]) -> str:
    """Return where the difference is smallest and largest; nothing where it is the same."""
    if len(tests) < 2 or all(one.test.zeros == one.test.n for one in tests):
        return ""
    by_size = sorted(tests, key=lambda one: abs(one.more_spread.mean - one.less_spread.mean))
    sizes = [fixed(one.more_spread.mean - one.less_spread.mean) for one in (by_size[0], by_size[-1])]
    if sizes[0] == sizes[1]:
        return ""
    return (
        f"The smallest difference of means is that of {by_size[0].button} ({sizes[0]}), "
        f"the largest that of {by_size[-1].button} ({sizes[1]})."
    )


def distance_sentences(one: ChoiceResult) -> tuple[str, ...]:
    """Return how far apart the renderings feel, by each rule."""
    what = "the renderings lie apart" if one.more == "right" else f"{one.more} lies above {one.less}"
    texts = [f"{rule_text(d)}: {distance_text(d)}" for d in one.d]
    return (
        f"In standard deviations of a single feeling, {what} by: {'; '.join(texts)}. A d′ of 0 is no "
        "difference, 1 is discriminated in 76 % of forced choices between two.",
    )


def name_rows(found: StudyAnalysis) -> tuple[ChoiceResult, ...]:
    """Return the rows of a table of choices: all buttons, then each where there are several."""
    rows = found.by_button if len(found.by_button) > 1 else ()
    return (found.preference, *rows) if found.preference else ()


def rated_sentence(one: RatedResult) -> str:
    where = f"over all buttons, {one.rating}" if not one.button else f"{one.button}, {one.rating}"
    means = [f"{name} {fixed(spread.mean, 1)}" for name, spread in one.spreads.items()]
    text = f"Means, {where}: {', '.join(means)}."
    if one.friedman is not None:
        f = one.friedman
        text += (
            f" Friedman's test of {people_text(f.people)}: χ²({f.df}) = {fixed(f.chi2)}, "
            f"{exact_p(f.p)}, W = {fixed(f.W)}."
        )
    alike = [f"{p.first} and {p.second}" for p in one.pairs if p.holm_p >= ALPHA]
    if one.pairs and not alike:
        return f"{text} All pairs differ significantly (Holm's correction)."
    if not alike:
        return text
    if len(alike) == len(one.pairs) > 1:
        return f"{text} No pair differs significantly (Holm's correction)."
    return f"{text} No significant difference between {listing(alike)} (Holm's correction)."


def threshold_sentences(found: StudyAnalysis) -> tuple[str, ...]:
    texts = []
    one = found.threshold
    without = sum(math.isnan(t.threshold.value) for t in found.thresholds)
    if one is not None:
        ends = f"{fixed(100 * one.low, 1)} to {percent(one.high, 1)}"
        bounds = "" if math.isnan(one.low) else f"; 95 % interval {ends}"
        texts.append(
            f"Added force is discriminated from {percent(one.mean, 1)} on (geometric mean of "
            f"{people_text(one.people)}{bounds}; median {percent(one.median, 1)})."
        )
    if without:
        texts.append(f"{many(without, 'staircase')} reversed too seldom to give a threshold.")
    return tuple(texts)


def jnd_sentences(found: StudyAnalysis) -> tuple[str, ...]:
    """Return how small a difference is noticed, and what to do next; nothing where none was measured."""
    if not found.jnds:
        return ()
    parts = []
    for name, one in found.jnd.items():
        low, high = one.low, one.high
        if math.isnan(low):  # one person: how well that person is known
            low, high = found.jnds[0].jnds[name].low, found.jnds[0].jnds[name].high
        parts.append(f"{name} by {percent(one.mean, 1)} ({fixed(100 * low, 1)} to {percent(high, 1)})")
    people = next(iter(found.jnd.values())).people
    what = f"geometric mean of {people_text(people)}, 95 % interval" if people > 1 else "95 % interval"
    return f"Three of four comparisons notice {listed(parts)} more ({what}).", _next_of(found)


def _next_of(found: StudyAnalysis) -> str:
    wide = {name: max(one.jnds[name].high / one.jnds[name].low for one in found.jnds) for name in found.jnd}
    widest = max(wide, key=lambda name: wide[name])
    sd = {name: one.sd for name, one in found.jnd.items() if not math.isnan(one.sd)}
    if wide[widest] > WIDE:
        return (
            f"Next: more trials a person, for {widest} is known least (in one person within a factor of "
            f"{fixed(wide[widest], 1)})."
        )
    if not sd:
        return "Next: measure more people; one person says nothing of how people differ."
    most = max(sd, key=lambda name: sd[name])
    differ = f"people differ most in {most} (SD {fixed(sd[most])} of its logarithm)"
    return f"Next: let a project judge by these figures (fdvv study jnds); {differ}."


def timing_sentences(found: TimingResult) -> tuple[str, ...]:
    """Return every effect of the analysis of variance, significant or not, and sphericity."""
    if found.anova is None:
        return ()
    texts = []
    for effect in found.anova.effects:
        what = "interaction" if "×" in effect.name else "main effect"
        verdict = "is significant" if effect.corrected_p < ALPHA else "is not significant"
        texts.append(f"The {what} of {effect.name} {verdict}, {effect_text(effect)}.")
    text = f"{found.measure_text.capitalize()} of {people_text(found.anova.people)}: {' '.join(texts)}"
    spheres = " ".join(filter(None, map(sphericity_text, found.anova.effects)))
    return tuple(unbroken(one) for one in (text, spheres) if one)
