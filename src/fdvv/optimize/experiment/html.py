"""The report of an experiment: one page that reads like a result section. Simulated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fdvv import __version__
from fdvv.io.documents import finite
from fdvv.io.files import write_atomic
from fdvv.optimize.experiment.experiment import ExperimentResult, ExperimentVerdict
from fdvv.optimize.experiment.prose import (
    anova_sentences,
    level_title,
    means_sentence,
    method_paragraphs,
    pairs_sentence,
    reductions_sentence,
    winner_paragraphs,
)
from fdvv.optimize.experiment.setup import LEVELS
from fdvv.optimize.experiment.winner import RenderedWinner, Winner, rendered_curves
from fdvv.optimize.run.report import DesignPanel, control_points, plot_designs
from fdvv.rendering.figures import plot_rendering
from fdvv.report.prose import PAIR_COLUMNS, button_text, effect_text, pair_cells, stars
from fdvv.report.report import Section, Table, render_html, write_report
from fdvv.report.score_figures import ScoreBars, TrainingScores, plot_score_bars, plot_training
from fdvv.report.svg import figure_svg

EXAMPLES = 3
"""People whose designs are drawn."""
SCORE = "asynchrony (ms)"
REPORT_FILE, RESULT_FILE = "report.html", "result.json"


def experiment_report(
    result: ExperimentResult, verdict: ExperimentVerdict, rendered: RenderedWinner | None = None
) -> dict[str, Any]:
    """Return everything an experiment found, for a file; units are in the names."""
    winner = {"winner": rendered.to_dict()} if rendered else {}
    return {**result.to_dict(), "statistics": verdict.to_dict(), **winner}


def write_experiment(
    folder: Path, result: ExperimentResult, verdict: ExperimentVerdict, rendered: RenderedWinner | None = None
) -> dict[str, Any]:
    """Write report.html and result.json into a folder, each atomically; return the content of result.json.

    Needs matplotlib (BuildError without it). OSError.
    """
    document = experiment_report(result, verdict, rendered)
    write_report(folder / REPORT_FILE, experiment_html(result, verdict, rendered))
    write_atomic(folder / RESULT_FILE, json.dumps(finite(document), indent=1, allow_nan=False) + "\n")
    return document


def experiment_html(
    result: ExperimentResult, verdict: ExperimentVerdict, rendered: RenderedWinner | None = None
) -> str:
    """Write the report as HTML. Needs matplotlib (BuildError without it)."""
    setup = result.setup
    sections = [
        Section("Method", method_paragraphs(setup)),
        _training(result),
        _results(result, verdict),
        _pairs(verdict),
        _designs(result),
    ]
    if rendered:
        sections.append(_winner(rendered))
    summary = f"{reductions_sentence(verdict)} {pairs_sentence(verdict)}"
    simulated = (
        f"{setup.people} simulated people press the twin on the rig {setup.rig}; no human took part, and no "
        "figure here is a human result"
    )
    footer = f"fdvv {__version__}; engine {setup.engine}, seed {setup.seed}, begun {setup.created}"
    return render_html(
        "Optimised buttons in temporal pointing", summary, sections, footer, simulated=simulated
    )


def _training(result: ExperimentResult) -> Section:
    panels = [TrainingScores(level_title(level), result.training_ms(level)) for level in LEVELS]
    svg = figure_svg(plot_training(panels, SCORE, simulated=True), "Scores of the designs tried in training")
    failed = sum(not t.scores for one in result.trainings for t in one.trials)
    text = (
        "Each dot is the score of one trial of one person. The best so far counts lucky scores; what went "
        "into validation is the design that the engine believes to be best.",
        *((f"{failed} trials failed: the rig cannot hold those designs.",) if failed else ()),
    )
    return Section("Training", text, (svg,))


def _results(result: ExperimentResult, verdict: ExperimentVerdict) -> Section:
    scores = result.scores_ms().mean(axis=3)
    panels = []
    for i, level in enumerate(LEVELS):
        marks = ("", *(stars(one.holm_p) for one in verdict.by_level[level]))
        names = tuple(button_text(name) for name in result.setup.buttons)
        spread = scores[:, :, i].std(axis=0, ddof=1)
        panels.append(ScoreBars(level_title(level), names, scores[:, :, i], spread, marks))
    svg = figure_svg(plot_score_bars(panels, SCORE, simulated=True), "Mean asynchrony by button and level")
    rounds = verdict.rounds_anova
    note = (
        "Marks compare with the optimised button within the level, Holm's correction: *** p < .001, "
        "** p < .01, * p < .05, n.s. not significant. Error bars are 1 SD between people; a dot is a person."
    )
    readings = (
        (
            "Counted as the paper's F(5, 95) counts, every round as another person, the main effect of "
            f"button is {effect_text(rounds.effects[0])}. Rounds of one person are alike, so this reading "
            "finds more than there is; it is shown for comparison only.",
        )
        if rounds
        else ()
    )
    switches = verdict.switches_anova.effects[0]
    aside = (
        "Without the random design, some of which can hardly be pressed and spread by far the most, the main "
        f"effect of button is {effect_text(switches)}."
    )
    sentences = (
        *(means_sentence(verdict, level) for level in LEVELS),
        f"A two-way repeated measures ANOVA was conducted over {verdict.anova.people} people, rounds "
        f"averaged first. {anova_sentences(verdict.anova)[0]}",
        *filter(None, anova_sentences(verdict.anova)[1:]),
        f"{pairs_sentence(verdict)} {reductions_sentence(verdict)}",
        aside,
        *readings,
        note,
    )
    return Section("Results", sentences, (svg,), (_means_table(verdict), _anova_table(verdict)))


def _means_table(verdict: ExperimentVerdict) -> Table:
    rows = tuple(
        (
            f"{one.button}, {one.level}",
            f"{one.mean_ms:.2f}",
            f"{one.people_sd_ms:.2f}",
            f"{one.rounds_sd_ms:.2f}",
            f"{100 * one.lost_ratio:.1f}",
        )
        for one in verdict.means
    )
    columns = ("button and level", "mean (ms)", "SD of people (ms)", "SD of rounds (ms)", "lost presses (%)")
    return Table(columns, rows, "Simulated. Mean asynchrony; a lost press counts 400 ms.")


def _anova_table(verdict: ExperimentVerdict) -> Table:
    rows = []
    readings = [
        ("people", verdict.anova),
        ("people, without random", verdict.switches_anova),
        ("rounds as people", verdict.rounds_anova),
    ]
    for counted, anova in readings:
        for effect in anova.effects if anova else ():
            df = f"{effect.effect_df}, {effect.error_df}"
            cells = (effect.F, effect.p, effect.sphericity.epsilon, effect.corrected_p)
            figures = (f"{v:.3g}" for v in (*cells, effect.partial_eta2, effect.generalized_eta2))
            rows.append((f"{effect.name}, {counted}", df, *figures))
    columns = ("effect, what is counted", "df", "F", "p", "ε", "p corrected", "partial η²", "generalized η²")
    return Table(
        columns, tuple(rows), "Simulated. Two-way repeated measures ANOVA; ε of Greenhouse and Geisser."
    )


def _pairs(verdict: ExperimentVerdict) -> Section:
    tables = [
        Table(
            PAIR_COLUMNS,
            tuple(pair_cells(one) for one in pairs),
            f"Simulated. {title}; corrected for {len(pairs)} pairs; 95 % intervals.",
        )
        for title, pairs in (
            ("Both levels together, all pairs", verdict.pairs),
            *((f"Level {level}", pairs) for level, pairs in verdict.by_level.items()),
        )
    ]
    text = (
        "Paired t tests of people's means. dz is the mean difference in units of the standard deviation of "
        "the differences; its interval and that of the reduction are resampled over people (BCa).",
    )
    return Section("Pairs", text, (), tuple(tables))


def _designs(result: ExperimentResult) -> Section:
    panels = []
    for person in range(min(EXAMPLES, result.setup.people)):
        for level in LEVELS:
            design = result.training_of(person, level).best
            model = Winner(person, level, design, 0.0).model
            panels.append(DesignPanel(f"person {person + 1}, {level}", model, control_points(design)))
    svg = figure_svg(plot_designs(panels, len(LEVELS), simulated=True), "Designs found for three people")
    text = ("What the engine recommends after training, for the first people as examples.",)
    return Section("Designs found", text, (svg,))


def _winner(rendered: RenderedWinner) -> Section:
    figure = plot_rendering(rendered_curves(rendered))
    svg = figure_svg(figure, "The design, fresh presses of it, and the model captured of it")
    return Section("The winner on the device", winner_paragraphs(rendered), (svg,))
