"""The report of a study: one page that reads like a result section, written from the numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv._version import __version__
from fdvv.report.report import Section, render_html, write_report
from fdvv.report.svg import figure_svg
from fdvv_people.report.prose import listed
from fdvv_people.study.analysis import figures, sentences, tables
from fdvv_people.study.analysis.answer_figures import plot_choices
from fdvv_people.study.analysis.export import PROXY
from fdvv_people.study.analysis.records import StudyAnalysis
from fdvv_people.study.analysis.sentences import name_rows
from fdvv_people.study.analysis.words import fixed, listing, many, people_text, report_texts
from fdvv_people.study.plan.plan import StudyPlan


def data_paragraphs(found: StudyAnalysis) -> tuple[str, ...]:
    """Return who took part, what was answered and what does not count."""
    screening = found.screening
    who = "simulated participants" if found.simulated else "people"
    people = f"{len(screening.people)} {who}" if len(screening.people) != 1 else f"1 {who.removesuffix('s')}"
    people = people.replace("1 people", "1 person")
    missing = screening.planned - screening.answered
    every = f"All {many(screening.planned, 'trial')} were answered."
    whole = every if screening.planned > 1 else "The one trial was answered."
    part = f"Of {many(screening.planned, 'trial')} {screening.answered} were answered, {missing} are missing."
    answered = part if missing else whole
    trials = (
        f"{people} met {many(len(found.buttons), 'button')} ({listing(found.buttons)}). Task: "
        f"{report_texts()['task'].get(found.kind, found.kind)}. {answered}"
    )
    return tuple(filter(None, [trials, _left_out(found), _time(found), *found.notes, _proxy(found)]))


def _left_out(found: StudyAnalysis) -> str:
    screening = found.screening
    if not screening.reasons and not screening.left_out:
        return "No trial and nobody was left out."
    trials = [f"{count}: {reason}" for reason, count in _grouped(screening.reasons).items()]
    out = screening.answered - screening.counted
    does = "does" if out == 1 else "do"
    text = f"{many(out, 'answered trial')} {does} not count ({'; '.join(trials)})." if trials else ""
    left = f"{people_text(screening.people_counted)} {'is' if screening.people_counted == 1 else 'are'} left."
    if not screening.left_out:
        return f"{text} {left}"
    alike: dict[str, list[str]] = {}
    for person, reason in screening.left_out.items():
        alike.setdefault(reason, []).append(person)
    names = [f"{listing(people)} ({reason})" for reason, people in alike.items()]
    return f"{text} Left out as people: {listed(names)}. {left}".strip()


def _grouped(reasons: Mapping[str, int]) -> dict[str, int]:
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
    there = {
        "tests": found.tests or found.rated or found.preference,
        "shares": found.preference,
        "thresholds": found.thresholds,
        "jnds": found.jnds,
        "timing": found.timing,
    }
    return tuple(report_texts()["method"][name] for name, results in there.items() if results)


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
        *_choices(found),
        *_thresholds(found),
        *_jnds(found),
        *_timing(found),
        *_people(found),
        Section("How this was computed", method_paragraphs(found)),
    ]
    title = f"{found.title} ({PROXY})" if found.simulated else found.title
    simulated = f"{PROXY}. No person took part, and no number here is a finding about people"
    origin = f"fdvv {__version__}" + (f"; {footer}" if footer else "")
    marked = [_marked(one, found.simulated) for one in sections]
    return render_html(title, study_summary(found), marked, origin, simulated if found.simulated else None)


def _marked(section: Section, simulated: bool) -> Section:
    if not simulated or not (section.figures or section.tables):
        return section
    first = section.paragraphs[0] if section.paragraphs else "All participants are."
    tables = tuple(replace(one, caption=f"Simulated. {one.caption}") for one in section.tables)
    return replace(section, paragraphs=(f"Simulated. {first}", *section.paragraphs[1:]), tables=tables)


def study_summary(found: StudyAnalysis) -> str:
    texts = [sentences.claim_sentence(found.claim)] if found.claim else []
    texts += [sentences.choice_sentence(found.preference)] if found.preference else []
    texts += [sentences.rated_sentence(found.rated[0])] if found.rated else []
    texts += sentences.threshold_sentences(found)[:1]
    texts += sentences.jnd_sentences(found)
    texts += sentences.timing_sentences(found.timing)[:1] if found.timing else []
    proxy = [f"{PROXY.capitalize()}."] if found.simulated and texts else []
    return " ".join([*proxy, *texts, *found.notes[:1]])


def _ratings(found: StudyAnalysis, plan: StudyPlan | None) -> list[Section]:
    """Return a section for each rating: of all renderings beside each other, else of the claim's two."""
    scales = {one.name: one.ends for one in plan.ratings} if plan else {}
    sections = []
    for rating in dict.fromkeys(one.rating for one in found.rated or found.tests):
        scale = scales.get(rating) or figures.scale_around(found.screening.answers, rating)
        svg = figure_svg(figures.draw_ratings(found, rating, scale), f"Mean {rating} by button")
        if found.rated:
            rows = [one for one in found.rated if one.rating == rating]
            texts = tuple(sentences.rated_sentence(one) for one in rows)
            listed_tables = tuple(tables.rated_table(one) for one in rows if one.pairs)
        else:
            tests = tuple(one for one in found.tests if one.rating == rating)
            several = tests[0].test.n > 1
            texts = (
                sentences.ratings_sentence(tests),
                *(sentences.button_sentence(one) for one in tests),
                *filter(None, [sentences.smallest_sentence(tests)]),
                *(sentences.scale_sentence(one) for one in found.scales if one.rating == rating),
                *([report_texts()["error_bars"]] if several else []),
            )
            listed_tables = (tables.ratings_table(tests),) if several else ()
        sections.append(Section(f"Ratings: {rating}", texts, (svg,), listed_tables))
    return sections


def _choices(found: StudyAnalysis) -> list[Section]:
    whole = found.preference
    if whole is None:
        return []
    choices = Section(
        "Right answers" if whole.more == "right" else "Choices",
        (sentences.choice_sentence(whole), *sentences.choice_asides(whole)),
        (figure_svg(plot_choices(name_rows(found), found.simulated), "What was chosen, by button"),),
        (tables.choices_table(found),),
    )
    if not whole.d:  # its task has no rule for d'
        return [choices]
    distances = Section(
        "How far apart it feels",
        sentences.distance_sentences(whole),
        (figure_svg(figures.draw_distances(found), "Distance felt, by button"),),
        (tables.distances_table(found),),
    )
    return [choices, distances]


def _thresholds(found: StudyAnalysis) -> list[Section]:
    if not found.thresholds:
        return []
    tracks = figures.plot_tracks(found.thresholds, found.simulated, len(found.buttons) > 1)
    svgs = (figure_svg(figures.draw_thresholds(found), "Thresholds"), figure_svg(tracks, "Staircases"))
    texts = (
        *sentences.threshold_sentences(found),
        "In the staircases a filled dot is a right answer, an open one a wrong one, the dashed line the "
        "threshold.",
    )
    return [Section("Thresholds", texts, svgs, (tables.thresholds_table(found),))]


def _jnds(found: StudyAnalysis) -> list[Section]:
    if not found.jnds:
        return []
    svgs = [figure_svg(figures.draw_jnds(found, name), f"JND of {name}") for name in found.jnd]
    texts = list(sentences.jnd_sentences(found))
    if found.jnds[0].surfaces:
        surfaces = figures.plot_surfaces(found.jnds, found.simulated)
        svgs.append(figure_svg(surfaces, "Just noticeable changes of two at once"))
        texts.append("In the last figure a line joins all changes of two at once that are just noticed.")
    return [Section("Just noticeable differences", tuple(texts), tuple(svgs), (tables.jnds_table(found),))]


def _timing(found: StudyAnalysis) -> list[Section]:
    timing = found.timing
    if timing is None:
        return []
    svg = figure_svg(figures.draw_timing(timing, found.simulated), "Mean scores by button and level")
    title = timing.measure_text.capitalize()
    return [Section(title, sentences.timing_sentences(timing), (svg,), tables.timing_tables(timing))]


def _people(found: StudyAnalysis) -> list[Section]:
    several = found.preference is not None and len(found.people) > 1
    svgs = (figure_svg(figures.draw_people(found), "Every person's share"),) if several else ()
    texts = ("How each leans, and what each did; the diamond counts all who count.",) if several else ()
    return [Section("Person by person", texts, svgs, (tables.people_table(found),))]
