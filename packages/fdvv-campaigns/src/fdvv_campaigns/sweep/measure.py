"""What a sweep can find out of a cell: each measure with its factors, settings and figures. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from fdvv.compensation.feasibility.verdict import Following
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import Method, Tuning
from fdvv.compensation.paper import PaperLaw, tuned_paper_law
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.rendering.compensate import compensate, start_surface
from fdvv.rendering.feasibility import feasibility
from fdvv.rendering.probe import probe
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv_people.optimize.population.plan import seed_of
from fdvv_studio.live.simulated_press import press_physics, quasi_static_peak_cN

Figures = dict[str, float | int | str | None]
LEARN, JUDGE, KNOW = 1, 2, 3
"""Purposes of random numbers: what is learned from is never what judges."""
NOT_COMPENSATED = "none"
METHODS = (NOT_COMPENSATED, "rig-aware", "paper", "paper-literal", "paper-tuned")
MET_ON = "mx-clear"
"""On which button a rig is identified for `feasible`."""


@dataclass(frozen=True, eq=False)
class Subjects:
    """What a cell is about, opened: only what its measure has."""

    rig: Rig | None
    finger: Finger | None
    button: FDVVModel | ButtonPhysics
    method: str
    speed_mm_s: float
    seed: int


@dataclass(frozen=True)
class Figure:
    name: str
    meaning: str
    type: str = "double"


@dataclass(frozen=True)
class Measure:
    """Something to find out of a cell.

    Attributes
    ----------
    factors : what may vary, each with its value where a plan leaves it out.
    settings : what holds for all cells, likewise.
    figures : what is found; the first number sums a sweep up. about_s : of a cell on one core, roughly.
    real : its buttons are simulated real ones, not models that a rig renders.
    """

    about: str
    factors: Mapping[str, str | float]
    settings: Mapping[str, Any]
    figures: tuple[Figure, ...]
    find: Callable[[Subjects, Mapping[str, Any]], Figures]
    about_s: float
    real: bool = False


def _probe(about: Subjects, settings: Mapping[str, Any]) -> Figures:
    """Compensate, then judge on fresh presses."""
    assert isinstance(about.button, FDVVModel)
    speeds, presses = settings["velocities_mm_s"], settings["presses"]
    device = TwinDevice(about.rig, about.finger, seed_of(about.seed, LEARN))
    judge = TwinDevice(about.rig, about.finger, seed_of(about.seed, JUDGE))
    if about.method == NOT_COMPENSATED:
        surface, tuning = start_surface(device, about.button, speeds), Tuning()
        learned, skipped = 0, 0
    else:
        result = compensate(device, about.button, speeds, _law(about.method, settings["rounds"]))
        surface, tuning = result.surface, result.outcome.tuning
        learned, skipped = result.presses, len(result.skipped)
    judged = probe(judge, about.button, surface, speeds, presses, tuning=tuning)
    means = {(c.stroke, c.velocity_mm_s): c.outcome.mean_error_cN for c in judged.curves}
    strokes = {s: [e for (stroke, _), e in means.items() if stroke is s] for s in Stroke}
    return {
        "mean_error_cN": float(np.mean(list(means.values()))),
        "worst_mean_error_cN": max(means.values()),
        "press_error_cN": _mean(strokes[Stroke.PRESS]),
        "release_error_cN": _mean(strokes[Stroke.RELEASE]),
        "max_error_cN": max(c.outcome.max_error_cN for c in judged.curves),
        "reached_ratio": min(c.reached_ratio for c in judged.curves),
        "learning_presses": learned,
        "skipped_presses": skipped + len(judged.skipped),
    }


def _mean(values: list[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _law(method: str, rounds: int) -> PaperLaw | Method[Any]:
    if method == "rig-aware":
        return RigAware(rounds)
    if method == "paper-tuned":
        return tuned_paper_law()
    return PaperLaw.literal() if method == "paper-literal" else PaperLaw()


def _feasible(about: Subjects, settings: Mapping[str, Any]) -> Figures:
    """Judge whether a rig that was identified from presses can render a button."""
    assert isinstance(about.button, FDVVModel)
    assert about.rig is not None
    device, speeds = TwinDevice(about.rig, about.finger), settings["velocities_mm_s"]
    known = _identify_rig(about.rig, about.finger, seed_of(about.seed, KNOW), tuple(speeds))
    report = feasibility(about.button, known, device.settings(), speeds, info=device.info())
    worst = max((curve.verdict.following for curve in report.curves), key=list(Following).index)
    kept = [c.reached.kept_ratio for c in report.curves if c.reached.kept_ratio is not None]
    return {
        "verdict": str(worst),
        "followed_ratio": float(np.mean([c.verdict.following is Following.FOLLOWS for c in report.curves])),
        "expected_error_cN": max(curve.expected.mean_cN for curve in report.curves),
        "largest_command_cN": max(float(np.abs(c.reached.command_cN).max()) for c in report.curves),
        "saturated_ratio": max(float(c.reached.saturated.mean()) for c in report.curves),
        "bump_kept_ratio": min(kept) if kept else None,
        "lag_mm": max(c.reached.lag_mm for c in report.curves),
        "margin": min(float(c.stable.margin) for c in report.curves),
    }


@lru_cache(maxsize=16)
def _identify_rig(rig: Rig, finger: Finger | None, seed: int, speeds_mm_s: tuple[float, ...]) -> RigModel:
    """Identify a rig from its presses; cells of one rig share it, and it is the same wherever it is done."""
    device = TwinDevice(rig, finger, seed)
    learned = compensate(device, load_builtin(MET_ON), speeds_mm_s, RigAware()).learned_rig
    assert learned is not None  # RigAware always remembers
    return learned.rig


def _press(about: Subjects, settings: Mapping[str, Any]) -> Figures:
    assert isinstance(about.button, ButtonPhysics)
    count = settings["presses"]
    presses = press_physics(about.button, about.finger or Finger(), (about.speed_mm_s,), count, about.seed)
    closing = [press.closing_ms for press in presses if press.closing_ms is not None]
    return {
        "achieved_mm_s": float(np.median([press.achieved_mm_s for press in presses])),
        "before_stop_cN": float(np.median([press.before_stop_cN for press in presses])),
        "quasi_static_peak_cN": _slow_peak_cN(about.button),
        "largest_cN": float(np.median([press.largest_cN for press in presses])),
        "closing_ms": float(np.median(closing)) if closing else None,
        "closing_spread_ms": float(np.std(closing, ddof=1)) if len(closing) > 1 else None,
        "closed_ratio": len(closing) / len(presses),
    }


_slow_peak_cN = lru_cache(maxsize=256)(quasi_static_peak_cN)
"""Fingers and speeds do not change it, and it takes as long as a press."""
SPEEDS_mm_s = (50.0, 100.0, 200.0)
MEASURES = {
    "probe": Measure(
        "compensate a rig for a model, then judge it on held-out presses in true displacement",
        {"rig": "voltage", "finger": "default", "button": "mx-clear", "method": "rig-aware"},
        {"velocities_mm_s": list(SPEEDS_mm_s), "presses": 5, "rounds": 3},
        (
            Figure("mean_error_cN", "mean error of all strokes and speeds"),
            Figure("worst_mean_error_cN", "mean error of the worst stroke and speed"),
            Figure("press_error_cN", "mean error of the presses"),
            Figure("release_error_cN", "mean error of the releases; null if the model has none"),
            Figure("max_error_cN", "largest error anywhere"),
            Figure("reached_ratio", "part of the travel that the worst press reached"),
            Figure("learning_presses", "presses that were made to learn", "int64"),
            Figure("skipped_presses", "presses that could not be used", "int64"),
        ),
        _probe,
        0.5,
    ),
    "feasible": Measure(
        "show whether a rig that was identified from its presses can render a model",
        {"rig": "voltage", "finger": "default", "button": "mx-clear"},
        {"velocities_mm_s": list(SPEEDS_mm_s)},
        (
            Figure("expected_error_cN", "error to expect of the worst after learning, an estimate"),
            Figure("verdict", "of the worst stroke and speed: can follow, follows in part, cannot", "string"),
            Figure("followed_ratio", "part of strokes and speeds that can be followed"),
            Figure("largest_command_cN", "largest force the coil is asked for"),
            Figure("saturated_ratio", "part of the travel beyond the rig's force, of the worst"),
            Figure("bump_kept_ratio", "part of the bump that is reached, of the worst; null without"),
            Figure("lag_mm", "by how much the force comes late, of the worst"),
            Figure("margin", "of the sampled loop's stability, of the worst"),
        ),
        _feasible,
        0.1,
    ),
    "press": Measure(
        "press a simulated real button with a finger",
        {"finger": "default", "button": "mx-clear", "speed_mm_s": 100.0},
        {"presses": 5},
        (
            Figure("closing_ms", "when the circuit closed, after the cap began to move, median"),
            Figure("closing_spread_ms", "its standard deviation over the presses"),
            Figure("closed_ratio", "part of the presses that closed the circuit"),
            Figure("achieved_mm_s", "mean speed of the stroke down that was reached, median"),
            Figure("before_stop_cN", "largest force before the last 0.1 mm of the travel, median"),
            Figure("quasi_static_peak_cN", "the same at 0.5 mm/s, as a force tester has it"),
            Figure("largest_cN", "largest force, impact at the bottom included, median"),
        ),
        _press,
        0.05,
        real=True,
    ),
}
"""By name."""
