"""The statistics of an experiment in words, as a result section writes them."""

from __future__ import annotations

from fdvv.study import Anova, Effect, Estimate, PairedTest
from fdvv.workflow._experiment_setup import RANDOM
from fdvv.workflow._experiment_verdict import ExperimentVerdict

ALPHA = 0.05


def p_text(p: float) -> str:
    """Write a p value: p < .001, or three decimals without the zero before the point."""
    return "p < .001" if p < 0.001 else f"p = {p:.3f}".replace("0.", ".", 1)


def stars(p: float) -> str:
    """Mark a p value: *** below .001, ** below .01, * below .05, else n.s."""
    return next((mark for bound, mark in ((0.001, "***"), (0.01, "**"), (0.05, "*")) if p < bound), "n.s.")


def effect_text(effect: Effect) -> str:
    """Write an effect, degrees of freedom and p corrected where sphericity needs it."""
    first, second = effect.corrected_df
    if effect.effect_df == 1:
        return (
            f"F(1, {effect.error_df}) = {effect.F:.2f}, {p_text(effect.p)}, "
            f"generalized η² = {effect.generalized_eta2:.3f}"
        )
    return (
        f"F({first:.2f}, {second:.2f}) = {effect.F:.2f}, {p_text(effect.corrected_p)} "
        f"(Greenhouse-Geisser ε = {effect.sphericity.epsilon:.3f}), "
        f"generalized η² = {effect.generalized_eta2:.3f}, partial η² = {effect.partial_eta2:.3f}"
    )


def sphericity_text(effect: Effect) -> str:
    """Say what Mauchly's test says; nothing where it has nothing to say."""
    found = effect.sphericity
    if found.W is None or found.p is None:
        return ""
    verdict = "is denied" if found.p < ALPHA else "is not denied"
    return f"Sphericity of {effect.name} {verdict} (Mauchly's W = {found.W:.3g}, {p_text(found.p)})."


def anova_sentences(anova: Anova) -> tuple[str, ...]:
    """Tell every effect, significant or not, and sphericity."""
    told = []
    for effect in anova.effects:
        what = "interaction" if "×" in effect.name else "main effect"
        verdict = "is significant" if effect.corrected_p < ALPHA else "is not significant"
        told.append(f"The {what} of {effect.name} on mean asynchrony {verdict}, {effect_text(effect)}.")
    return (" ".join(told), " ".join(filter(None, map(sphericity_text, anova.effects))))


def pairs_sentence(verdict: ExperimentVerdict) -> str:
    """Tell which buttons the optimised one outperforms, and which it does not."""
    better = [one for one in verdict.against if one.bonferroni_p < ALPHA and one.difference.value < 0]
    worse = [one for one in verdict.against if one.bonferroni_p < ALPHA and one.difference.value > 0]
    alike = [one for one in verdict.against if one.bonferroni_p >= ALPHA]
    told = [f"Post-hoc tests with Bonferroni correction over {len(verdict.pairs)} pairs"]
    parts = [
        (better, "confirm that the optimised button outperforms"),
        (worse, "find the optimised button worse than"),
        (alike, "find no significant difference to"),
    ]
    said = [f"{words} {listed([one.second for one in group])}" for group, words in parts if group]
    return f"{told[0]} {'; they '.join(said)}."


def reductions_sentence(verdict: ExperimentVerdict) -> str:
    """Tell by how much asynchrony fell, per level, against the switches and the random design."""
    told = []
    for level, pairs in verdict.by_level.items():
        switches = [100 * one.reduction_ratio.value for one in pairs if one.second != RANDOM]
        random = next((100 * one.reduction_ratio.value for one in pairs if one.second == RANDOM), None)
        text = f"{level}: {min(switches):.0f} to {max(switches):.0f} % below the switches"
        told.append(text if random is None else f"{text}, {random:.0f} % below random")
    return f"Mean asynchrony with the optimised button, {'; '.join(told)}."


def means_sentence(verdict: ExperimentVerdict, level: str) -> str:
    """List means and standard deviations of a level as the paper does."""
    means = [one for one in verdict.means if one.level == level]
    told = ", ".join(f"{one.mean_ms:.1f} ms (SD {one.people_sd_ms:.1f})" for one in means)
    return (
        f"For the level {level}, mean asynchronies are {told} for {listed([one.button for one in means])}, "
        "respectively; SD is between people."
    )


def pair_cells(one: PairedTest) -> tuple[str, ...]:
    """Write a pair as a row of a table."""
    return (
        f"{button_text(one.first)} − {button_text(one.second)}",
        interval_text(one.difference, 1),
        f"{one.t:.2f}",
        _short_p(one.p),
        _short_p(one.bonferroni_p),
        _short_p(one.holm_p),
        interval_text(one.dz, 2),
        interval_text(one.reduction_ratio, 1, 100.0),
    )


PAIR_COLUMNS = (
    "pair", "difference (ms)", "t", "p", "Bonf. p", "Holm p", "dz", "reduction (%)"
)  # fmt: skip


def button_text(name: str) -> str:
    """Write a button's name where room is scarce: the switches are all MX."""
    return name.removeprefix("mx-")


def interval_text(one: Estimate, digits: int, scale: float = 1.0) -> str:
    """Write an estimate with its interval, where there is one."""
    value = f"{scale * one.value:.{digits}f}"
    if one.low is None or one.high is None:
        return value
    # spaces that no line breaks at: an interval stays in one piece
    return f"{value} [{scale * one.low:.{digits}f}, {scale * one.high:.{digits}f}]".replace(
        " ", "\N{NO-BREAK SPACE}"
    )


def listed(names: list[str]) -> str:
    """Join names: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _short_p(p: float) -> str:
    return "< .001" if p < 0.001 else f"{p:.3f}"
