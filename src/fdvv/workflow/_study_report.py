"""The report of a study: one page that reads like a result section, written from the numbers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from fdvv import __version__
from fdvv.plot import Section, figure_svg, render_html, write_report
from fdvv.study import StudyPlan
from fdvv.workflow._study_dict import PROXY
from fdvv.workflow._study_drawn import (
    drawn_choices,
    drawn_distances,
    drawn_multiverse,
    drawn_people,
    drawn_ratings,
    drawn_thresholds,
    drawn_timing,
    drawn_tracks,
    scale_of,
)
from fdvv.workflow._study_method import data_paragraphs, method_paragraphs
from fdvv.workflow._study_more_sentences import (
    multiverse_sentences,
    rated_sentence,
    threshold_sentences,
    timing_sentences,
)
from fdvv.workflow._study_records import StudyAnalysis
from fdvv.workflow._study_sentences import (
    button_sentence,
    choice_asides,
    choice_sentence,
    claim_sentence,
    distance_sentences,
    ratings_sentence,
    scale_sentence,
    smallest_sentence,
)
from fdvv.workflow._study_tables import (
    choices_table,
    distances_table,
    people_table,
    rated_table,
    ratings_table,
    thresholds_table,
    timing_tables,
)

BARS = (
    "Thin error bars are 1 SD between people, thick ones the 95 % interval of the mean; a dot is a person's "
    "mean. *** p < .001, ** p < .01, * p < .05, n.s. not significant (exact, Holm's correction)."
)


def write_study_report(
    path: Path, found: StudyAnalysis, plan: StudyPlan | None = None, footer: str = ""
) -> None:
    """Write the report as one HTML file, whole or not at all. BuildError without matplotlib; OSError."""
    write_report(path, study_html(found, plan, footer))


def study_html(found: StudyAnalysis, plan: StudyPlan | None = None, footer: str = "") -> str:
    """Write the report as HTML. plan : knows the ends of scales. footer : where the answers came from.

    Needs matplotlib (BuildError without it).
    """
    sections = [
        Section("Participants and data", data_paragraphs(found)),
        *_ratings(found, plan),
        *_rated(found, plan),
        *_choices(found),
        *_thresholds(found),
        *_timing(found),
        *_people(found),
        *_multiverse(found),
        Section("How this was computed", method_paragraphs(found)),
    ]
    title = f"{found.title} ({PROXY})" if found.simulated else found.title
    simulated = f"{PROXY}. No person took part, and no number here is a finding about people"
    told = f"fdvv {__version__}" + (f"; {footer}" if footer else "")
    marked = [_marked(one, found.simulated) for one in sections]
    return render_html(title, study_summary(found), marked, told, simulated if found.simulated else None)


def _marked(section: Section, simulated: bool) -> Section:
    """Say in every section, and above every table, that what it tells of is simulated."""
    if not simulated or not (section.figures or section.tables):
        return section
    first = section.paragraphs[0] if section.paragraphs else "All participants are."
    tables = tuple(replace(one, caption=f"Simulated. {one.caption}") for one in section.tables)
    return replace(section, paragraphs=(f"Simulated. {first}", *section.paragraphs[1:]), tables=tables)


def study_summary(found: StudyAnalysis) -> str:
    """Tell the main result in a few sentences."""
    told = [claim_sentence(found.claim)] if found.claim else []
    told += [choice_sentence(found.preference)] if found.preference else []
    told += [rated_sentence(found.rated[0])] if found.rated else []
    told += threshold_sentences(found)[:1]
    told += timing_sentences(found.timing)[:1] if found.timing else []
    told += [multiverse_sentences(found.multiverse)[0]] if found.multiverse else []
    proxy = [f"{PROXY.capitalize()}."] if found.simulated and told else []
    return " ".join([*proxy, *told, *found.notes[:1]])


def _ratings(found: StudyAnalysis, plan: StudyPlan | None) -> list[Section]:
    """Tell each rating of two renderings; where all are compared, that tells of two of them as well."""
    if found.rated:
        return []
    sections = []
    for rating in dict.fromkeys(one.rating for one in found.tests):
        tests = tuple(one for one in found.tests if one.rating == rating)
        figure = drawn_ratings(found, rating, _scale(found, plan, rating))
        told = (
            ratings_sentence(tests),
            *(button_sentence(one) for one in tests),
            *filter(None, [smallest_sentence(tests)]),
            *(scale_sentence(one) for one in found.scales if one.rating == rating),
            *([BARS] if tests[0].test.n > 1 else []),
        )
        svg = figure_svg(figure, f"Mean {rating} by button")
        tables = (ratings_table(tests),) if tests[0].test.n > 1 else ()
        sections.append(Section(f"Ratings: {rating}", told, (svg,), tables))
    return sections


def _scale(found: StudyAnalysis, plan: StudyPlan | None, rating: str) -> tuple[float, float]:
    points = {one.name: one.points for one in plan.ratings} if plan else {}
    return scale_of(found.screening.answers, rating, points.get(rating))


def _rated(found: StudyAnalysis, plan: StudyPlan | None) -> list[Section]:
    """Tell ratings of many renderings beside each other."""
    sections = []
    for rating in dict.fromkeys(one.rating for one in found.rated):
        rows = [one for one in found.rated if one.rating == rating]
        svg = figure_svg(
            drawn_ratings(found, rating, _scale(found, plan, rating)), f"Mean {rating} by button"
        )
        told = tuple(rated_sentence(one) for one in rows)
        tables = tuple(rated_table(one) for one in rows if one.pairs)
        sections.append(Section(f"Ratings: {rating}", told, (svg,), tables))
    return sections


def _choices(found: StudyAnalysis) -> list[Section]:
    """Tell choices and the distances they mean."""
    whole = found.preference
    if whole is None:
        return []
    title = "Right answers" if whole.more == "right" else "Choices"
    svg = figure_svg(drawn_choices(found), "What was chosen, by button")
    choices = Section(title, (choice_sentence(whole), *choice_asides(whole)), (svg,), (choices_table(found),))
    svg = figure_svg(drawn_distances(found), "Distance felt, by button")
    distances = Section(
        "How far apart it feels", distance_sentences(whole), (svg,), (distances_table(found),)
    )
    return [choices, distances]


def _thresholds(found: StudyAnalysis) -> list[Section]:
    if not found.thresholds:
        return []
    figures = (
        figure_svg(drawn_thresholds(found), "Thresholds"),
        figure_svg(drawn_tracks(found), "Staircases"),
    )
    told = (
        *threshold_sentences(found),
        "In the staircases a filled dot is a right answer, an open one a wrong one, the dashed line the "
        "threshold.",
    )
    return [Section("Thresholds", told, figures, (thresholds_table(found),))]


def _timing(found: StudyAnalysis) -> list[Section]:
    if found.timing is None:
        return []
    svg = figure_svg(drawn_timing(found.timing, found.simulated), "Mean scores by button and level")
    return [
        Section(
            found.timing.measure_text.capitalize(),
            timing_sentences(found.timing),
            (svg,),
            timing_tables(found.timing),
        )
    ]


def _people(found: StudyAnalysis) -> list[Section]:
    several = found.preference is not None and len(found.people) > 1
    figures = (figure_svg(drawn_people(found), "Every person's share"),) if several else ()
    told = ("How each leans, and what each did; the diamond counts all who count.",) if several else ()
    return [Section("Person by person", told, figures, (people_table(found),))]


def _multiverse(found: StudyAnalysis) -> list[Section]:
    if found.multiverse is None or found.claim is None:
        return []
    claim = "right answers" if found.claim.measure == "correct" else f"share for {found.claim.claim.more}"
    figure = drawn_multiverse(found.multiverse, found.claim.registered, claim, found.simulated)
    svg = figure_svg(figure, "The main claim under every reasonable analysis")
    return [Section("Does it depend on the analysis?", multiverse_sentences(found.multiverse), (svg,))]
