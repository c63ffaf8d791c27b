"""The report of a timing study: a result section in the paper's form, the paper's own figures beside it."""

from __future__ import annotations

import csv
import math
from dataclasses import asdict
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from fdvv._version import __version__
from fdvv.io.documents import finite
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg
from fdvv.units import FloatArray
from fdvv_people.report.prose import (
    ANOVA_COLUMNS,
    PAIR_COLUMNS,
    anova_cells,
    anova_sentences,
    effect_text,
    interval_text,
    listed,
    pair_cells,
    stars,
)
from fdvv_people.report.score_figures import ScoreBars, TrainingScores, plot_score_bars, plot_training
from fdvv_people.stats.anova import Anova
from fdvv_people.study.timing import paper
from fdvv_people.study.timing.analyse import ConditionMean, TimingAnalysis, better_of
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.sentences import (
    gap_sentence,
    measure_of,
    next_sentence,
    rival_sentences,
    strokes_sentence,
    verdict_sentence,
)
from fdvv_people.study.timing.unseal import TRAINING_FILE
from fdvv_people.task.pointing import LEVELS_px_s, LOST_ms


def timing_html(found: TimingAnalysis, folder: Path, origin: str) -> str:
    """Return the report as HTML. folder : of what was unsealed. Needs matplotlib (BuildError without it)."""
    plan = found.scores.plan
    training = _training(plan, folder / TRAINING_FILE, found.simulated) if plan.training else None
    sections = [
        Section("Method", _method(found)),
        *([training] if training else ()),
        _results(found),
        *([_beside_paper(found)] if plan.levels else ()),
        _model(found),
        _pairs(found),
    ]
    simulated = (
        f"{len(found.scores.people)} simulated people pressed the twin; no human took part, and no figure "
        "here but those cited is a human result"
    )
    title = plan.title.get("en") or next(iter(plan.title.values()))
    summary = f"{capitalised(verdict_sentence(found))} {next_sentence(found)}"
    footer = f"fdvv {__version__}; {origin}"
    return render_html(title, summary, sections, footer, simulated=simulated if found.simulated else None)


def capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]


def _marked(found: TimingAnalysis, text: str) -> str:
    return f"Simulated. {text}" if found.simulated else text


def _method(found: TimingAnalysis) -> tuple[str, ...]:
    plan, people = found.scores.plan, len(found.scores.people)
    who = f"{people} {'simulated ' if found.simulated else ''}people"
    names = listed([one.name for one in plan.conditions])
    if plan.tapping:
        return (
            f"{who} tapped as fast as they could, {plan.tap_s} seconds a trial, {plan.rounds} trials on each "
            f"of {names}, in Williams' orders under codes. A score is the rate of keystrokes.",
        )
    levels = listed([f"{level} ({LEVELS_px_s[level]:.0f} px/s)" for level in plan.levels])
    training = plan.training
    texts = [
        f"{who} played temporal pointing without visual feedback of the press: {levels}. A trial has "
        f"{plan.presses} presses; its mean asynchrony is one score, and a lost press counts {LOST_ms:g} ms.",
    ]
    if training:
        texts.append(
            f"In training the engine {training.engine} suggested {training.trials} designs per level. "
            f"{gap_sentence(found)}"
        )
    texts.append(
        f"In the validation everybody pressed {names}, {plan.rounds} times per level, in Williams' orders "
        "under codes that name no button."
    )
    return tuple(texts)


def _training(plan: TimingPlan, path: Path, simulated: bool) -> Section | None:
    if not path.is_file():
        return None
    panels = [TrainingScores(level, scores) for level, scores in training_scores(plan, path).items()]
    svg = figure_svg(plot_training(panels, "asynchrony (ms)", simulated=simulated), "Scores in training")
    text = "Each dot is the score of one trial of one person. What went into validation is the design that "
    return Section("Training", (f"{text}the engine believes to be best, not the luckiest one.",), (svg,))


def training_scores(plan: TimingPlan, path: Path) -> dict[str, FloatArray]:
    """Return the scores of training.csv by level, (people, trials), nan where a trial has none."""
    rows = list(csv.DictReader(StringIO(path.read_text(encoding="utf-8"))))
    people = sorted({row["person"] for row in rows})
    count = plan.training.trials if plan.training else 0
    size = max(1, len(people)), count
    found: dict[str, FloatArray] = {level: np.full(size, np.nan) for level in plan.levels}
    for row in rows:
        if row["score"]:
            found[row["level"]][people.index(row["person"]), int(row["trial"])] = float(row["score"])
    return found


def _results(found: TimingAnalysis) -> Section:
    plan = found.scores.plan
    measure, unit = measure_of(plan)
    sentences = [_means_sentence(found, level) for level in plan.all_levels]
    if found.anova:
        effects, *spheres = anova_sentences(found.anova, measure)
        sentences.append(
            f"A two-way repeated measures ANOVA was conducted over {found.anova.people} people"
            f"{'' if plan.tapping else ', rounds averaged first'}. {effects}"
        )
        sentences += filter(None, spheres)
    if found.rounds_anova:
        sentences.append(
            "Counted as the paper's F(5, 95) counts, every round as another person, the main effect of "
            f"button is {effect_text(found.rounds_anova.effects[0])}. Rounds of one person are alike, so "
            "this reading finds more than there is; it is shown for comparison only."
        )
    svg = figure_svg(plot_score_bars(_bars(found), f"{measure} ({unit})", simulated=found.simulated), measure)
    note = "Error bars are 1 SD between people; a dot is a person. Marks compare with the first bar, Holm's."
    figures = (svg,) if len(found.scores.complete) > 1 else ()
    strokes = strokes_sentence(found)
    texts = *sentences, *((strokes,) if strokes else ()), note, *found.notes
    return Section("Results", texts, figures, _anova_tables(found))


def _bars(found: TimingAnalysis) -> list[ScoreBars]:
    scores, plan = found.scores, found.scores.plan
    cells = scores.array(scores.complete).mean(axis=3)
    first = scores.conditions.index(better_of(plan))
    order = [first, *(i for i in range(len(scores.conditions)) if i != first)]
    panels = []
    for i, level in enumerate(plan.all_levels):
        p = {one.second: one.holm_p for one in found.by_level.get(level, ())}
        names = tuple(scores.conditions[k] for k in order)
        marks = tuple(stars(p[name]) if name in p else "" for name in names)
        column = cells[:, order, i]
        spread = column.std(axis=0, ddof=1) if len(column) > 1 else np.zeros(len(order))
        panels.append(ScoreBars(level, names, column, spread, marks))
    return panels


def _means_sentence(found: TimingAnalysis, level: str) -> str:
    measure, unit = measure_of(found.scores.plan)
    means = [one for one in found.means if one.level == level]
    values = ", ".join(f"{one.mean:.1f} {unit} (SD {one.people_sd:.1f})" for one in means)
    of = f"For the level {level}, " if level else ""
    names = listed([one.condition for one in means])
    return capitalised(f"{of}{measure} is {values} for {names}, respectively; SD is between people.")


def _anova_tables(found: TimingAnalysis) -> tuple[Table, ...]:
    readings: list[tuple[str, Anova | None]] = [
        ("people", found.anova),
        ("rounds as people", found.rounds_anova),
    ]
    rows = [row for counted, anova in readings if anova for row in anova_cells(counted, anova)]
    caption = _marked(found, "Two-way repeated measures ANOVA; ε of Greenhouse and Geisser.")
    return (Table(ANOVA_COLUMNS, tuple(rows), caption),) if rows else ()


def _beside_paper(found: TimingAnalysis) -> Section:
    rows = tuple(_paper_cells(found, one) for one in found.means)
    columns = (
        "button and level",
        "mean (ms)",
        "SD of people",
        "SD of rounds",
        "lost (%)",
        "paper: mean (ms)",
        "paper: STD",
    )
    text = (
        f"The paper's figures are cited from {paper.SOURCE}. Its main effect of button is "
        f"{paper.BUTTON_EFFECT}, and its optimised button outperforms each other one with p < .05 "
        "(Bonferroni).",
        "Other people, screens and latencies shift every mean alike; compare differences between buttons.",
    )
    table = Table(columns, rows, _marked(found, "Mean asynchrony beside the paper's, which is cited."))
    return Section("Beside the paper", text, (), (table,))


def _paper_cells(found: TimingAnalysis, one: ConditionMean) -> tuple[str, ...]:
    cited = paper.cited(found.scores.plan.condition(one.condition), one.level)
    own = (one.mean, one.people_sd, one.rounds_sd)
    return (
        f"{one.condition}, {one.level}",
        *(_figure(value) for value in own),
        _figure(100 * one.lost_ratio, 1),
        *((f"{cited[0]:g}", f"{cited[1]:g}") if cited else ("–", "–")),
    )


def _figure(value: float, digits: int = 2) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"


def _model(found: TimingAnalysis) -> Section:
    _, unit = measure_of(found.scores.plan)
    text = (
        "Every trial is a score. The model has a mean for every button and level, and random intercepts of "
        "people and, within people, of buttons and levels (REML). So people are counted as people, and who "
        "lacks a score is not left out.",
        "Each contrast is fitted to the trials of its two buttons alone, for buttons differ in their spread. "
        "It averages the levels; t has people − 1 degrees of freedom.",
        "p (flipped signs) is a permutation test of people's mean differences; it assumes no distribution. "
        "Intervals are 95 %; those of the reduction are resampled over people (BCa).",
        *rival_sentences(found),
    )
    rows = tuple(
        (
            f"{one.better} − {one.rival}",
            interval_text(one.mixed.value, 2),
            f"{one.mixed.t:.2f}",
            _short(one.mixed.p),
            _short(one.holm_p),
            _short(one.flip_p),
            interval_text(one.reduction_ratio, 1, 100.0) if one.reduction_ratio else "–",
        )
        for one in found.rivals
    )
    columns = ("contrast", f"difference ({unit})", "t", "p", "Holm p", "p (flipped signs)", "reduction (%)")
    variances = found.model.variances if found.model else {}
    parts = tuple((name, f"{math.sqrt(value):.2f}") for name, value in variances.items())
    tables = (
        Table(columns, rows, _marked(found, "Contrasts of the mixed model.")),
        Table(("spread of", f"SD ({unit})"), parts, _marked(found, "Variance components of all trials.")),
    )
    return Section("Mixed model", text, (), tables if found.model else ())


def _short(p: float | None) -> str:
    return "–" if p is None else "< .001" if p < 0.001 else f"{p:.3f}"


def _pairs(found: TimingAnalysis) -> Section:
    _, unit = measure_of(found.scores.plan)
    columns = tuple(one.replace("(ms)", f"({unit})") for one in PAIR_COLUMNS)
    groups = [("All pairs", found.pairs), *((f"Level {k}", pairs) for k, pairs in found.by_level.items())]
    tables = [
        Table(
            columns,
            tuple(pair_cells(one) for one in pairs),
            _marked(found, f"{title}; corrected for {len(pairs)} pairs."),
        )
        for title, pairs in groups
        if pairs
    ]
    text = ("Paired t tests of people's means, as the paper's post-hoc tests; Bonferroni's and Holm's p.",)
    return Section("Pairs", text, (), tuple(tables))


def timing_dict(found: TimingAnalysis) -> dict[str, Any]:
    """Return every figure by name; units are in the names."""
    plan = found.scores.plan
    claim = {
        "better": better_of(plan),
        "holds": found.holds,
        "sentence": verdict_sentence(found),
        "next": next_sentence(found),
        "rate": None if found.rate is None else {**asdict(found.rate), "reached": found.rate.reached},
    }
    document = {
        "study": plan.name,
        "kind": plan.kind,
        "score": plan.score,
        "simulated": found.simulated,
        "people": len(found.scores.people),
        "complete": len(found.scores.complete),
        "claim": claim,
        "means": [asdict(one) for one in found.means],
        "anova": found.anova and asdict(found.anova),
        "anova_rounds_counted_as_people": found.rounds_anova and asdict(found.rounds_anova),
        "variances": found.model and dict(found.model.variances),
        "contrasts": [asdict(one) for one in found.rivals],
        "pairs": [asdict(one) for one in found.pairs],
        "by_level": {level: [asdict(one) for one in pairs] for level, pairs in found.by_level.items()},
        "notes": list(found.notes),
    }
    return dict(finite(document))
