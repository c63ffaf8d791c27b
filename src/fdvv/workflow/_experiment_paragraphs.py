"""How an experiment was made, in paragraphs of its report."""

from __future__ import annotations

from fdvv.optimize import LEVELS_px_s
from fdvv.workflow._experiment_setup import LEVELS, ExperimentSetup
from fdvv.workflow._experiment_winner import RenderedWinner


def level_title(level: str) -> str:
    """Name a level with its speed."""
    return f"{level} ({LEVELS_px_s[level]:.0f} px/s)"


def method_paragraphs(setup: ExperimentSetup) -> tuple[str, ...]:
    """Tell training, validation and what a week did."""
    return _training(setup), _validation(setup), _week(setup)


def _training(setup: ExperimentSetup) -> str:
    levels = " and ".join(level_title(level) for level in LEVELS)
    others = " and ".join(f"{len(trials)} designs ({level})" for level, trials in setup.prior.items())
    told = f" Every training begins from the mean scores that other simulated people gave {others}."
    return (
        f"{setup.people} simulated people play temporal pointing without visual feedback of the press at two "
        f"levels, {levels}. In training, each has {setup.trials} trials of {setup.presses} presses per "
        f"level; the engine {setup.engine} suggests the next design from the mean asynchronies so far. Every "
        f"second person begins with the hard level.{told if others else ''}"
    )


def _validation(setup: ExperimentSetup) -> str:
    blocks = setup.people * setup.rounds * len(LEVELS)
    return (
        "A week later they meet the design that the engine recommends for them and the level, "
        f"{len(setup.rivals)} switches ({', '.join(setup.rivals)}) and a random design, {setup.rounds} times "
        "per level, in Williams' orders: over the experiment every button stands in every place, and follows "
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
    """Tell which design was rendered, how well, and what was captured of it."""
    winner, told = rendered.winner, rendered.to_dict()
    return (
        *(f"Did better but could not be rendered: {reason}." for reason in rendered.refused),
        f"The design of person {winner.person + 1} at the level {winner.level} did best in validation, "
        f"{100 * winner.reduction_ratio:.0f} % below that person's switches. As the best of many noisy "
        "scores it shows a design, not how good it is.",
        "Its parameters: " + ", ".join(f"{name} {value:.2f}" for name, value in winner.design.items()) + ".",
        f"Its actuation was learned on the {told['device']} with the rig {told['rig']} (simulated) and "
        f"measured on fresh presses: mean error {_errors(told['probed_mean_error_cN'])}, in true "
        "displacement.",
        "Further presses, as the device's own sensors saw them, went through the capturing process back into "
        f"a model: travel {told['captured_travel_mm']:.2f} mm, mean difference to the design "
        f"{_errors(rendered.difference_cN)}. Its curves begin where the cap was first felt.",
    )


def _errors(by_stroke: dict[str, float]) -> str:
    return ", ".join(f"{stroke} {error:.2f} cN" for stroke, error in by_stroke.items())
