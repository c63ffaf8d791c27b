"""The report of an experiment: one page that reads like a result section. Simulated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fdvv._version import __version__
from fdvv.force_text import force_text
from fdvv.io.documents import finite
from fdvv.io.files import write_atomic
from fdvv.rendering.figures import plot_rendering
from fdvv.report.report import Section, Table, render_html, write_report
from fdvv.report.svg import figure_svg
from fdvv_people.optimize.experiment.experiment import ExperimentResult, ExperimentVerdict
from fdvv_people.optimize.experiment.setup import LEVELS, RANDOM, ExperimentSetup
from fdvv_people.optimize.experiment.winner import RenderedWinner, method_curves
from fdvv_people.optimize.paper_space import paper_model
from fdvv_people.optimize.run.report import DesignPanel, control_points, plot_designs
from fdvv_people.report.prose import (
    ALPHA,
    ANOVA_COLUMNS,
    PAIR_COLUMNS,
    anova_cells,
    anova_sentences,
    button_text,
    effect_text,
    listed,
    pair_cells,
    stars,
)
from fdvv_people.report.score_figures import ScoreBars, TrainingScores, plot_score_bars, plot_training
from fdvv_people.task.pointing import LEVELS_px_s

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
        Section("Method", (_training_text(setup), _validation_text(setup), _week_text(setup))),
        _training(result),
        _results(result, verdict),
        _pairs(verdict),
        _designs(result),
    ]
    if rendered:
        sections.append(_winner(rendered))
    summary = f"{_reductions_sentence(verdict)} {_pairs_sentence(verdict)}"
    simulated = (
        f"{setup.people} simulated people press the twin on the rig {setup.rig}; no human took part, and no "
        "figure here is a human result"
    )
    footer = f"fdvv {__version__}; engine {setup.engine}, seed {setup.seed}, begun {setup.created}"
    return render_html(
        "Optimised buttons in temporal pointing", summary, sections, footer, simulated=simulated
    )


def _training(result: ExperimentResult) -> Section:
    panels = [TrainingScores(_level_title(level), result.training_ms(level)) for level in LEVELS]
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
        panels.append(ScoreBars(_level_title(level), names, scores[:, :, i], spread, marks))
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
    effects, *spheres = anova_sentences(verdict.anova, "mean asynchrony")
    sentences = (
        *(_means_sentence(verdict, level) for level in LEVELS),
        f"A two-way repeated measures ANOVA was conducted over {verdict.anova.people} people, rounds "
        f"averaged first. {effects}",
        *filter(None, spheres),
        f"{_pairs_sentence(verdict)} {_reductions_sentence(verdict)}",
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
    rows: list[tuple[str, ...]] = []
    readings = [
        ("people", verdict.anova),
        ("people, without random", verdict.switches_anova),
        ("rounds as people", verdict.rounds_anova),
    ]
    for counted, anova in readings:
        rows += anova_cells(counted, anova) if anova else ()
    return Table(
        ANOVA_COLUMNS, tuple(rows), "Simulated. Two-way repeated measures ANOVA; ε of Greenhouse and Geisser."
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
    panels = [
        DesignPanel(f"person {one.person + 1}, {one.level}", paper_model(one.best), control_points(one.best))
        for one in result.trainings
        if one.person < EXAMPLES
    ]
    svg = figure_svg(plot_designs(panels, len(LEVELS), simulated=True), "Designs found for three people")
    text = ("What the engine recommends after training, for the first people as examples.",)
    return Section("Designs found", text, (svg,))


def _winner(rendered: RenderedWinner) -> Section:
    figure = plot_rendering(method_curves(rendered))
    svg = figure_svg(figure, "The design, fresh presses of it, and the model captured of it")
    return Section("The winner on the device", _winner_paragraphs(rendered), (svg,))


def _pairs_sentence(verdict: ExperimentVerdict) -> str:
    """Name the buttons that the optimised one outperforms, and those that it does not."""
    better = [one for one in verdict.against if one.bonferroni_p < ALPHA and one.difference.value < 0]
    worse = [one for one in verdict.against if one.bonferroni_p < ALPHA and one.difference.value > 0]
    alike = [one for one in verdict.against if one.bonferroni_p >= ALPHA]
    tests = f"Post-hoc tests with Bonferroni correction over {len(verdict.pairs)} pairs"
    parts = [
        (better, "confirm that the optimised button outperforms"),
        (worse, "find the optimised button worse than"),
        (alike, "find no significant difference to"),
    ]
    findings = [f"{words} {listed([one.second for one in group])}" for group, words in parts if group]
    return f"{tests} {'; they '.join(findings)}."


def _reductions_sentence(verdict: ExperimentVerdict) -> str:
    """Report the fall of asynchrony by level, against the switches and the random design."""
    levels = []
    for level, pairs in verdict.by_level.items():
        switches = [100 * one.reduction_ratio.value for one in pairs if one.second != RANDOM]
        random = next((100 * one.reduction_ratio.value for one in pairs if one.second == RANDOM), None)
        text = f"{level}: {min(switches):.0f} to {max(switches):.0f} % below the switches"
        levels.append(text if random is None else f"{text}, {random:.0f} % below random")
    return f"Mean asynchrony with the optimised button, {'; '.join(levels)}."


def _means_sentence(verdict: ExperimentVerdict, level: str) -> str:
    """List means and standard deviations of a level as the paper does."""
    means = [one for one in verdict.means if one.level == level]
    values = ", ".join(f"{one.mean_ms:.1f} ms (SD {one.people_sd_ms:.1f})" for one in means)
    return (
        f"For the level {level}, mean asynchronies are {values} for {listed([one.button for one in means])}, "
        "respectively; SD is between people."
    )


def _level_title(level: str) -> str:
    """Name a level with its speed."""
    return f"{level} ({LEVELS_px_s[level]:.0f} px/s)"


def _training_text(setup: ExperimentSetup) -> str:
    levels = " and ".join(_level_title(level) for level in LEVELS)
    others = " and ".join(f"{len(trials)} designs ({level})" for level, trials in setup.prior.items())
    prior = f" Every training begins from the mean scores that other simulated people gave {others}."
    return (
        f"{setup.people} simulated people play temporal pointing without visual feedback of the press at two "
        f"levels, {levels}. In training, each has {setup.trials} trials of {setup.presses} presses per "
        f"level; the engine {setup.engine} suggests the next design from the mean asynchronies so far. Every "
        f"second person begins with the hard level.{prior if others else ''}"
    )


def _validation_text(setup: ExperimentSetup) -> str:
    blocks = setup.people * setup.rounds * len(LEVELS)
    return (
        "A week later they press the design that the engine recommends for them and the level, "
        f"{len(setup.rivals)} switches ({', '.join(setup.rivals)}) and a random design, {setup.rounds} times "
        "per level, in Williams' orders: over the experiment every button is in every place, and follows "
        f"every other, as equally often as {blocks} blocks allow. That gives {setup.observations} "
        f"observations of mean asynchrony, each over {setup.presses} presses."
    )


def _week_text(setup: ExperimentSetup) -> str:
    gap = setup.gap
    return (
        f"The week is a stated change of the person (assumed): {100 * gap.kept_ratio:.0f} % of the practice "
        f"is kept, adaptation begins anew, bias shifts by {gap.bias_ms:g} ms and anticipation by "
        f"{gap.anticipated_ms:g} ms (standard deviations), timing noise by {100 * gap.clock_ratio:.0f} % and "
        f"pace by {100 * gap.pace_ratio:.0f} %."
    )


def _winner_paragraphs(rendered: RenderedWinner) -> tuple[str, ...]:
    """Describe the design that was rendered, its errors, and the model captured from it."""
    winner, figures = rendered.winner, rendered.to_dict()
    return (
        *(f"Did better but could not be rendered: {reason}." for reason in rendered.refused),
        f"The design of person {winner.person + 1} at the level {winner.level} did best in validation, "
        f"{100 * winner.reduction_ratio:.0f} % below that person's switches. As the best of many noisy "
        "scores it shows a design, not how good it is.",
        "Its parameters: " + ", ".join(f"{name} {value:.2f}" for name, value in winner.design.items()) + ".",
        f"Its actuation was learned on the {figures['device']} with the rig {figures['rig']} (simulated) and "
        f"measured on fresh presses: mean error {_errors(figures['probed_mean_error_cN'])}, in true "
        "displacement.",
        "Further presses, as the device's own sensors saw them, went through the capturing process back into "
        f"a model: travel {figures['captured_travel_mm']:.2f} mm, mean difference to the design "
        f"{_errors(rendered.difference_cN)}. Its curves begin where the cap was first felt.",
    )


def _errors(by_stroke: dict[str, float]) -> str:
    return ", ".join(f"{stroke} {force_text(error, '.2f')}" for stroke, error in by_stroke.items())
