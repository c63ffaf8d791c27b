"""Statistics in words and cells, as a result section writes them."""

from __future__ import annotations

from fdvv_people.stats.anova import Anova, AnovaEffect
from fdvv_people.stats.effect_size import Estimate
from fdvv_people.stats.post_hoc import PairedTest

ALPHA = 0.05  # the usual level; a study's main claim has its own, in its plan


def p_text(p: float) -> str:
    """Write a p value: p < .001, or three decimals without the zero before the point."""
    return "p < .001" if p < 0.001 else f"p = {p:.3f}".replace("0.", ".", 1)


def stars(p: float) -> str:
    """Mark a p value: *** below .001, ** below .01, * below .05, else n.s."""
    return next((mark for bound, mark in ((0.001, "***"), (0.01, "**"), (0.05, "*")) if p < bound), "n.s.")


def effect_text(effect: AnovaEffect) -> str:
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


def sphericity_text(effect: AnovaEffect) -> str:
    """Say what Mauchly's test says; nothing where it has nothing to say."""
    found = effect.sphericity
    if found.W is None or found.p is None:
        return ""
    verdict = "is rejected" if found.p < ALPHA else "is not rejected"
    return f"Sphericity of {effect.name} {verdict} (Mauchly's W = {found.W:.3g}, {p_text(found.p)})."


def anova_sentences(anova: Anova, measure: str) -> tuple[str, ...]:
    """Report every effect on a measure, significant or not; then sphericity, empty where it says nothing."""
    sentences = []
    for effect in anova.effects:
        what = "interaction" if "×" in effect.name else "main effect"
        verdict = "is significant" if effect.corrected_p < ALPHA else "is not significant"
        sentences.append(f"The {what} of {effect.name} on {measure} {verdict}, {effect_text(effect)}.")
    return (" ".join(sentences), " ".join(filter(None, map(sphericity_text, anova.effects))))


def anova_cells(counted: str, anova: Anova) -> tuple[tuple[str, ...], ...]:
    """Return the rows of a table of effects, see ANOVA_COLUMNS. counted : what was counted as a person."""
    rows = []
    for effect in anova.effects:
        df = f"{effect.effect_df}, {effect.error_df}"
        cells = (effect.F, effect.p, effect.sphericity.epsilon, effect.corrected_p)
        figures = (f"{v:.3g}" for v in (*cells, effect.partial_eta2, effect.generalized_eta2))
        rows.append((f"{effect.name}, {counted}", df, *figures))
    return tuple(rows)


ANOVA_COLUMNS = (
    "effect, what is counted", "df", "F", "p", "ε", "p corrected", "partial η²", "generalized η²"
)  # fmt: skip


def pair_cells(one: PairedTest) -> tuple[str, ...]:
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


def interval_text(one: Estimate, digits: int, scale: float = 1.0) -> str:
    """Write an estimate with its interval, where there is one."""
    value = f"{scale * one.value:.{digits}f}"
    if one.low is None or one.high is None:
        return value
    whole = f"{value} [{scale * one.low:.{digits}f}, {scale * one.high:.{digits}f}]"
    # no line breaks at such a space: an interval stays in one piece
    return whole.replace(" ", "\N{NO-BREAK SPACE}")


def listed(names: list[str]) -> str:
    """Join names: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _short_p(p: float) -> str:
    return "< .001" if p < 0.001 else f"{p:.3f}"


def button_text(name: str) -> str:
    """Write a button's name where room is scarce: the switches are all MX."""
    return name.removeprefix("mx-")
