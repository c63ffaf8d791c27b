"""The result of a probe in one sentence, and what to do next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.force_text import force_number, force_unit
from fdvv.model.curve import Stroke
from fdvv.rendering.evaluation.noticed import summarize
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.vibration_presses import NOT_ASKED, RenderedVibration, principal_Hz

ON_TIME_ms, AT_LEVEL_dB, NOTHING_dB = 0.15, 0.5, -20.0
RETURNED_ratio = 0.97
"""Less than that of a stroke reached means that the cap did not come back."""
FEW_ratio = 0.1
"""Less of a stroke than that above one JND counts as little."""
STEPS = {
    "stuck": "The cap did not come back in every press: strengthen the release, or stand the rig upright.",
    "learn": "Learn the actuation with fdvv compensate, then probe again.",
    "play": "Play the vibration too: probe without --vibration-presses 0.",
    "fit": "The rig has no exciter, and the vibration is missed: fit one, and mind the mass that it adds.",
    "identify": "Identify the exciter (fdvv device exciter) and play through its inverse: --exciter FILE.",
    "tune": "Let a person tune the vibration: fdvv tune.",
    "people": "By these numbers little is left that one would notice: try it on people with fdvv study.",
    "rig": "Ask fdvv feasible which limit the rig meets; a load cell (--rig recommended) comes closer.",
    "pace": "Much of the error is a missed speed: press closer to the speed that is asked for.",
    "more": "Learn more rounds (fdvv compensate --rounds), or ask fdvv feasible which limit the rig meets.",
}


@dataclass(frozen=True)
class RenderingMeans:
    """What a rig had to render with.

    Attributes
    ----------
    learned : the table was learned on a rig. force_loop : the loop at the finger was closed.
    exciter, exciter_known : there is one, and it was identified.
    """

    learned: bool = True
    force_loop: bool = False
    exciter: bool = False
    exciter_known: bool = False


def verdict(curves: Sequence[ProbeCurve]) -> str:
    """Return one sentence, which says whose JNDs it judges by; empty without a curve."""
    if not curves:
        return ""
    return f"By {curves[0].jnds.origin}, {_force(curves)}; {_vibration(curves)}."


def headline(curves: Sequence[ProbeCurve], before: Sequence[ProbeCurve] = (), presses: str = "") -> str:
    """Return what is left of the error, and at which speeds a finger would notice it, in one line.

    before : the same without compensation, whose errors come first. Empty without a curve.
    presses : what it was judged on, such as "simulated presses"; left out if empty.
    """
    if not curves:
        return ""
    parts = (_fell(_mean_cN(before), _mean_cN(curves)), _fell(_largest_cN(before), _largest_cN(curves)))
    where = f" on {presses}" if presses else ""
    mean, largest = (f"{part} {force_unit()}" for part in parts)
    judged = f"{_where_noticed(curves)}, by {curves[0].jnds.origin}"
    return f"Mean error {mean}{where}, largest {largest}; {judged}"


def headline_figures(
    curves: Sequence[ProbeCurve], before: Sequence[ProbeCurve] = ()
) -> tuple[tuple[str, str], ...]:
    """Return the three figures of a rendering, each with what it is of; before : without compensation.

    The mean and the largest error of force, and how much of the strokes is above one JND of force.
    """
    return (
        (f"{_fell(_mean_cN(before), _mean_cN(curves))} {force_unit()}", "mean error of force"),
        (f"{_fell(_largest_cN(before), _largest_cN(curves))} {force_unit()}", "largest error"),
        (
            f"{_percents(_percent_noticed(before), _percent_noticed(curves))} %",
            "of the strokes a finger would notice",
        ),
    )


def _percent_noticed(curves: Sequence[ProbeCurve]) -> float | None:
    return 100 * float(np.mean([summarize(c.force_JND).above_ratio for c in curves])) if curves else None


def next_step(curves: Sequence[ProbeCurve], means: RenderingMeans) -> str:
    """Return what improves the rendering most, judged by the worst that was found; empty without a curve."""
    if not curves:
        return ""
    worst = max(summarize(curve.force_JND).above_ratio for curve in curves)
    if min(curve.reached_ratio for curve in curves) < RETURNED_ratio:
        return STEPS["stuck"]
    if worst > FEW_ratio and not means.learned:
        return STEPS["learn"]
    if step := _for_vibration(curves, means):
        return STEPS[step]
    if worst <= FEW_ratio:
        return STEPS["people"]
    if not means.force_loop:
        return STEPS["rig"]
    return STEPS["pace" if _misses_speed(curves) else "more"]


def _misses_speed(curves: Sequence[ProbeCurve]) -> bool:
    """Return whether the speed achieved explains much of what is noticed."""
    pairs = [(summarize(c.force_JND).above_ratio, summarize(c.own_speed_JND).above_ratio) for c in curves]
    return float(np.mean([asked - achieved for asked, achieved in pairs])) > FEW_ratio / 2


def _for_vibration(curves: Sequence[ProbeCurve], means: RenderingMeans) -> str:
    """Return the step that a vibration needs which is missing or off by a JND; else empty."""
    errors = [c.vibration.error for c in curves if c.vibration.error]
    if not errors or all(e.played and e.total_JND <= 1 for e in errors):
        return ""
    if not any(e.played for e in errors):
        return "play" if means.exciter else ("fit" if max(e.total_JND for e in errors) > 1 else "")
    return "tune" if means.exciter_known else "identify"


def _mean_cN(curves: Sequence[ProbeCurve]) -> float | None:
    return float(np.mean([c.outcome.mean_error_cN for c in curves])) if curves else None


def _largest_cN(curves: Sequence[ProbeCurve]) -> float | None:
    return max((c.outcome.max_error_cN for c in curves), default=None)


def _fell(before_cN: float | None, after_cN: float | None) -> str:
    both = (cN for cN in (before_cN, after_cN) if cN is not None)
    return " → ".join(force_number(cN, f".{0 if cN >= 10 else 1}f") for cN in both)


def _percents(*percents: float | None) -> str:
    return " → ".join(f"{p:.{0 if p >= 10 else 1}f}" for p in percents if p is not None)


def _where_noticed(curves: Sequence[ProbeCurve]) -> str:
    speeds = list(dict.fromkeys(sorted(c.velocity_mm_s for c in curves)))
    noticed_mm_s = [
        v
        for v in speeds
        if any(summarize(c.force_JND).above_ratio > FEW_ratio for c in curves if c.velocity_mm_s == v)
    ]
    if not noticed_mm_s:
        return "a finger would not notice it"
    if len(noticed_mm_s) == len(speeds):
        return "a finger would notice it" + (" at every speed" if len(speeds) > 1 else "")
    *first, last = (f"{v:g}" for v in noticed_mm_s)
    return f"a finger would notice it at {', '.join(first)}{' and ' if first else ''}{last} mm/s only"


def _force(curves: Sequence[ProbeCurve]) -> str:
    unnoticed = {c: 1 - summarize(c.force_JND).above_ratio for c in curves}
    strokes = [s for s in Stroke if any(c.stroke is s for c in curves)]
    parts = [
        f"{_percent(float(np.mean([v for c, v in unnoticed.items() if c.stroke is s])))} of the {s}"
        for s in strokes
    ]
    least = min(unnoticed, key=lambda c: unnoticed[c])
    where = f"{least.stroke} at {least.velocity_mm_s:g} mm/s"
    worst = f" (least: {_percent(unnoticed[least])}, {where})" if len(curves) > len(strokes) else ""
    return f"a finger would not notice the force on {' and '.join(parts)}{worst}"


def _vibration(curves: Sequence[ProbeCurve]) -> str:
    asked = [c for c in curves if c.vibration.asked]
    if not asked:
        return "no vibration was asked for"
    compared = [c for c in asked if c.vibration.error]
    if not compared:
        return f"the vibration was {asked[0].vibration.reason}"
    worst = max(compared, key=lambda c: c.vibration.total_JND)
    vibration = worst.vibration.asked
    assert vibration is not None
    what = f"the {principal_Hz(vibration):.0f} Hz vibration at {vibration.onset_mm:g} mm"
    where = (
        f"{worst.stroke} at {worst.velocity_mm_s:g} mm/s, the most noticed"
        if len(compared) > 1
        else str(worst.stroke)
    )
    return f"{what} {outcome_words(worst.vibration)} ({worst.vibration.total_JND:.1f} JND, {where})"


def outcome_words(rendered: RenderedVibration) -> str:
    """Return in words how one vibration came out, as the end of a sentence about it."""
    error = rendered.error
    if rendered.asked is None or error is None:
        return rendered.reason or "was not asked for"
    own = f"{abs(error.own_dB):.0f} dB {'above' if error.own_dB >= 0 else 'below'} it"
    if not error.played:
        return f"is not played; the cap's own motion is {own}"
    assert error.level_dB is not None
    if error.level_dB < NOTHING_dB:
        return f"does not reach the cap; its own motion is {own}"
    if error.onset_ms is None:
        return f"cannot be found beside the cap's own motion, {own}"
    return f"comes {_late(error.onset_ms)} and {_loud(error.level_dB)}"


def short_outcome(rendered: RenderedVibration) -> str:
    """Return how one vibration came out in a few words, for a title."""
    error = rendered.error
    if rendered.asked is None:
        return NOT_ASKED
    if error is None or not error.played:
        return "not played" if error else "not measured"
    if error.onset_ms is None or error.level_dB is None:
        return "not found"
    return f"{_late(error.onset_ms)}, {_loud(error.level_dB)}"


def _late(onset_ms: float) -> str:
    if abs(onset_ms) < ON_TIME_ms:
        return "on time"
    return f"{abs(onset_ms):.1f} ms {'late' if onset_ms > 0 else 'early'}"


def _loud(level_dB: float) -> str:
    if abs(level_dB) < AT_LEVEL_dB:
        return "as strong as asked"
    return f"{abs(level_dB):.0f} dB {'strong' if level_dB > 0 else 'weak'}"


def _percent(ratio: float) -> str:
    return f"{100 * ratio:.0f} %"
