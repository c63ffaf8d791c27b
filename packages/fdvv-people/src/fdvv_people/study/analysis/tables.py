"""Tables of a study's report."""

from __future__ import annotations

import math

from fdvv.report.report import Table
from fdvv_people.report.prose import pair_cells
from fdvv_people.study.analysis.jnds import UNITS
from fdvv_people.study.analysis.records import ButtonTest, RatedResult, StudyAnalysis, TimingResult
from fdvv_people.study.analysis.sentences import name_rows
from fdvv_people.study.analysis.words import button_name, fixed, percent, rule_text, short_p, span


def ratings_table(tests: tuple[ButtonTest, ...]) -> Table:
    rows = []
    for one in tests:
        test = one.test
        shift = f"{fixed(test.shift)} {span(test.low, test.high)}"
        rows.append(
            (
                one.button, str(test.n), str(test.zeros),
                fixed(test.statistic, 1), fixed(test.z), short_p(test.p_asymptotic), short_p(test.p_exact),
                short_p(one.p_holm), fixed(test.effect), shift,
            )
        )  # fmt: skip
    columns = (
        "button", "people", "zeros", "W", "Z", "p, of Z", "p, exact", "p, Holm", "r", "shift",
    )  # fmt: skip
    caption = (
        "Wilcoxon signed-rank tests of people's means. W: smaller sum of ranks. r: matched-pairs "
        "rank-biserial correlation. shift: Hodges and Lehmann's, with its 95 % interval. "
        "Holm: of the exact p."
    )
    return Table(columns, tuple(rows), caption)


def choices_table(found: StudyAnalysis) -> Table:
    whole = name_rows(found)[0]
    ties = whole.equal_count > 0
    rows = []
    for one in name_rows(found):
        counts = [one.more_count, *([one.equal_count] if ties else []), one.less_count, one.missing]
        share = f"{percent(one.share.share)} {span(one.interval.low, one.interval.high, 1, 100.0)}"
        exact = short_p(one.test.p_exact if one.test else None)
        rows.append((button_name(one), *map(str, counts), share, exact, short_p(one.p_holm)))
    names = [whole.more, *(["equal"] if ties else []), whole.less, "missing"]
    columns = ("button", *names, "share, 95 % interval", "p, exact", "p, Holm")
    return Table(
        columns, tuple(rows), "p: signed-rank test of people's shares against one half, ties as halves."
    )


def distances_table(found: StudyAnalysis) -> Table:
    rows = [
        (
            button_name(one), rule_text(d), fixed(d.d), span(d.low, d.high),
            "–" if d.tau is None else fixed(d.tau), short_p(d.p),
        )
        for one in name_rows(found)
        for d in one.d
    ]  # fmt: skip
    caption = (
        "p: exact binomial, answers counted as independent. τ: difference that is still called equal. Where "
        "people are counted as people, the test is that of their shares, above."
    )
    return Table(("button", "rule", "d′", "95 %", "τ", "p"), tuple(rows), caption)


def rated_table(one: RatedResult) -> Table:
    rows = tuple(
        (
            f"{p.first} − {p.second}", str(p.test.n), fixed(p.test.z), short_p(p.test.p_exact),
            short_p(p.holm_p), fixed(p.test.effect),
            f"{fixed(p.test.shift, 1)} {span(p.test.low, p.test.high, 1)}",
        )
        for p in one.pairs
    )  # fmt: skip
    columns = ("pair", "people", "Z", "p, exact", "p, Holm", "r", "shift")
    return Table(
        columns, rows, f"{one.rating}, {one.button or 'all buttons'}: signed-rank tests of people's means."
    )


def thresholds_table(found: StudyAnalysis) -> Table:
    rows = tuple(
        (
            one.person, one.button, str(one.ratios.size), fixed(100 * one.threshold.value, 1),
            span(one.threshold.low, one.threshold.high, 1, 100.0),
        )
        for one in found.thresholds
    )  # fmt: skip
    caption = "Threshold: geometric mean of the ratios at which a staircase turned round."
    return Table(("person", "button", "trials", "threshold (%)", "95 % (%)"), rows, caption)


def jnds_table(found: StudyAnalysis) -> Table:
    rows = []
    for one in found.jnds:
        for name, jnd in one.jnds.items():
            size = found.standards.get(one.button, {}).get(name)
            unit = "" if size is None else f"{fixed(size * jnd.ratio, 2)} of {fixed(size, 1)} {UNITS[name]}"
            share = fixed(100 * jnd.ratio, 1), span(jnd.low, jnd.high, 1, 100.0)
            rows.append((one.person, one.button, name, str(jnd.trials), *share, unit))
    caption = (
        "JND: the change that three of four comparisons notice, as a part of the standard's; of force at the "
        "peak, of the fall behind it, of the vibration's largest amplitude. Trials: with this change alone."
    )
    return Table(("person", "button", "of", "trials", "JND (%)", "95 % (%)", "JND"), tuple(rows), caption)


def timing_tables(found: TimingResult) -> tuple[Table, ...]:
    """List the effects of the analysis of variance, then the pairs of buttons."""
    if found.anova is None:
        return ()
    rows = tuple(
        (
            e.name, f"{e.effect_df}, {e.error_df}", fixed(e.F), short_p(e.p), fixed(e.sphericity.epsilon, 3),
            short_p(e.corrected_p), fixed(e.partial_eta2, 3), fixed(e.generalized_eta2, 3),
        )
        for e in found.anova.effects
    )  # fmt: skip
    columns = ("effect", "df", "F", "p", "ε", "p corrected", "partial η²", "generalized η²")
    effects = Table(columns, rows, "Two-way repeated measures ANOVA; ε of Greenhouse and Geisser.")
    heads = ("pair", "difference", "t", "p", "Bonf. p", "Holm p", "dz", "reduction (%)")
    pairs = [
        Table(heads, tuple(pair_cells(one) for one in pairs), f"Pairs of buttons, {level}; 95 % intervals.")
        for level, pairs in found.pairs.items()
    ]
    return effects, *pairs


def people_table(found: StudyAnalysis) -> Table:
    ratings = list(found.people[0].differences)
    choices = found.preference is not None
    timed = not all(math.isnan(one.median_s) for one in found.people)
    rows = []
    for one in found.people:
        cells = [one.person, str(one.planned), str(one.answered), str(one.left_out)]
        cells += [fixed(100 * one.share, 1)] if choices else []
        cells += [fixed(one.differences[name]) for name in ratings]
        cells += [fixed(one.median_s, 1)] if timed else []
        cells.append(one.reason or "yes")
        rows.append(tuple(cells))
    share = [f"{found.preference.more} (%)"] if found.preference else []
    names = [f"{name}, difference" for name in ratings]
    columns = (
        "person",
        "trials",
        "answered",
        "left out",
        *share,
        *names,
        *(["median (s)"] if timed else []),
        "counts",
    )
    return Table(columns, tuple(rows), "All answers of each person, those that do not count among them.")
