"""The statistics of an experiment in words, as a result section writes them."""

from __future__ import annotations

from fdvv.optimize.experiment.experiment import ExperimentVerdict
from fdvv.optimize.experiment.setup import LEVELS, RANDOM, ExperimentSetup
from fdvv.optimize.experiment.winner import RenderedWinner
from fdvv.optimize.tasks import LEVELS_px_s
from fdvv.report.prose import ALPHA, effect_text, listed, sphericity_text
from fdvv.stats.anova import Anova


def anova_sentences(anova: Anova) -> tuple[str, ...]:
    """Report every effect, significant or not, and sphericity."""
    sentences = []
    for effect in anova.effects:
        what = "interaction" if "×" in effect.name else "main effect"
        verdict = "is significant" if effect.corrected_p < ALPHA else "is not significant"
        sentences.append(f"The {what} of {effect.name} on mean asynchrony {verdict}, {effect_text(effect)}.")
    return (" ".join(sentences), " ".join(filter(None, map(sphericity_text, anova.effects))))


def pairs_sentence(verdict: ExperimentVerdict) -> str:
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


def reductions_sentence(verdict: ExperimentVerdict) -> str:
    """Report the fall of asynchrony by level, against the switches and the random design."""
    levels = []
    for level, pairs in verdict.by_level.items():
        switches = [100 * one.reduction_ratio.value for one in pairs if one.second != RANDOM]
        random = next((100 * one.reduction_ratio.value for one in pairs if one.second == RANDOM), None)
        text = f"{level}: {min(switches):.0f} to {max(switches):.0f} % below the switches"
        levels.append(text if random is None else f"{text}, {random:.0f} % below random")
    return f"Mean asynchrony with the optimised button, {'; '.join(levels)}."


def means_sentence(verdict: ExperimentVerdict, level: str) -> str:
    """List means and standard deviations of a level as the paper does."""
    means = [one for one in verdict.means if one.level == level]
    values = ", ".join(f"{one.mean_ms:.1f} ms (SD {one.people_sd_ms:.1f})" for one in means)
    return (
        f"For the level {level}, mean asynchronies are {values} for {listed([one.button for one in means])}, "
        "respectively; SD is between people."
    )


def level_title(level: str) -> str:
    """Name a level with its speed."""
    return f"{level} ({LEVELS_px_s[level]:.0f} px/s)"


def method_paragraphs(setup: ExperimentSetup) -> tuple[str, ...]:
    """Describe training, validation and the week between them."""
    return _training(setup), _validation(setup), _week(setup)


def _training(setup: ExperimentSetup) -> str:
    levels = " and ".join(level_title(level) for level in LEVELS)
    others = " and ".join(f"{len(trials)} designs ({level})" for level, trials in setup.prior.items())
    prior = f" Every training begins from the mean scores that other simulated people gave {others}."
    return (
        f"{setup.people} simulated people play temporal pointing without visual feedback of the press at two "
        f"levels, {levels}. In training, each has {setup.trials} trials of {setup.presses} presses per "
        f"level; the engine {setup.engine} suggests the next design from the mean asynchronies so far. Every "
        f"second person begins with the hard level.{prior if others else ''}"
    )


def _validation(setup: ExperimentSetup) -> str:
    blocks = setup.people * setup.rounds * len(LEVELS)
    return (
        "A week later they press the design that the engine recommends for them and the level, "
        f"{len(setup.rivals)} switches ({', '.join(setup.rivals)}) and a random design, {setup.rounds} times "
        "per level, in Williams' orders: over the experiment every button is in every place, and follows "
        f"every other, as equally often as {blocks} blocks allow. That gives {setup.observations} "
        f"observations of mean asynchrony, each over {setup.presses} presses."
    )


def _week(setup: ExperimentSetup) -> str:
    gap = setup.gap
    return (
        f"The week is a stated change of the person (assumed): {100 * gap.kept_ratio:.0f} % of the practice "
        f"is kept, adaptation begins anew, bias shifts by {gap.bias_ms:g} ms and anticipation by "
        f"{gap.anticipated_ms:g} ms (standard deviations), timing noise by {100 * gap.clock_ratio:.0f} % and "
        f"pace by {100 * gap.pace_ratio:.0f} %."
    )


def winner_paragraphs(rendered: RenderedWinner) -> tuple[str, ...]:
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
    return ", ".join(f"{stroke} {error:.2f} cN" for stroke, error in by_stroke.items())
