"""Does what is predicted of a rig before upload agree with what it then does? Simulated; two minutes.

Run as ``python -m benchmarks.feasibility``, or with the first and the last seed. Rigs and fingers drawn at
random over their plausible ranges, loop of 4 kHz, voltage and current drive in turn. The known rig is made
from the truth, so that only the verdict is judged, not the identification; the stability bounds assume the
nominal finger, the simulation has the drawn one. Rigs are left out whose coil is weaker than the firmware can
be predicted.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensation.feasibility.limits import RigLimits, inverse_dynamics_cN, minimum_jerk
from fdvv.compensation.feasibility.stability import (
    NominalFinger,
    SampledLoop,
    stability,
    step_limit_cN,
    stiffness_limit_N_m,
)
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.tables import grid_mm
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import compensate
from fdvv.rendering.feasibility import feasibility
from fdvv.rendering.probe import probe
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.units import FloatArray
from tests.support.held import swings_held
from tests.support.rig_truth import draw_fast_rig, rig_truth
from tests.support.table_press import simulate

SEEDS = range(400, 420)
BUTTONS = ("mx-clear", "mx-brown", "mx-blue", "mx-red", "mx-black", "rubber-dome")
RATIOS = np.geomspace(0.25, 16.0, 25)
"""Stiffness, or step, over what the bound says."""
CUTS = (0.7, 0.9, 1.1, 1.3)
"""Force limit over the largest command that a curve needs."""
MIDDLE_mm, TRAVEL_mm, HELD_cN, GENTLE_N_m = 2.0, 4.0, 60.0, 100.0
SPEED_mm_s = 100.0
STILL_mm, RELAY_mm = 0.01, 0.05
"""Swings that count; those of a step between strokes are no smaller than half the reversal distance."""


@dataclass(frozen=True)
class Drawn:
    """One rig with its finger, and what is known of it."""

    seed: int
    rig: Rig
    finger: Finger
    known: RigModel
    limits: RigLimits


def draw(seeds: range) -> Iterator[Drawn]:
    """Draw the rigs that can be pressed."""
    for seed in seeds:
        rig, finger = draw_fast_rig(seed, "voltage" if seed % 2 else "current")
        try:
            limits = RigLimits.of_settings(settings_of(rig))
        except ModelError:
            continue
        yield Drawn(seed, rig, finger, rig_truth(rig), limits)


def table(drawn: Drawn, x: FloatArray, press_cN: FloatArray, release_cN: FloatArray) -> ForceSurface:
    """Return the command that puts these forces under a finger that rests."""
    most, gain = drawn.limits.force_limit_cN, drawn.known.gain_at(x)
    rows = [
        np.clip((f + drawn.known.weight_cN) / gain, -most, most)[np.newaxis] for f in (press_cN, release_cN)
    ]
    return ForceSurface(x, np.array([50.0]), *rows)


def straight(drawn: Drawn, stiffness_N_m: float, step_cN: float) -> ForceSurface:
    """Return a table that rises evenly through 60 cN at 2 mm, release below press by a step."""
    x = 0.05 * np.arange(81.0)
    middle = HELD_cN + 0.1 * stiffness_N_m * (x - MIDDLE_mm)
    return table(drawn, x, middle + 0.5 * step_cN, middle - 0.5 * step_cN)


def onset_ratio(drawn: Drawn, surface: Callable[[float], ForceSurface], still_mm: float) -> float:
    """Return the least of RATIOS whose table swings; infinite if none does."""
    for ratio in RATIOS:
        made = surface(float(ratio))
        if swings_held(drawn.rig, drawn.finger, made, TRAVEL_mm, MIDDLE_mm, HELD_cN, still_mm):
            return float(ratio)
    return float("inf")


def onsets(drawn: Drawn) -> tuple[float, float]:
    """Return where a rise and where a step between strokes begin to swing, over the prediction."""
    finger, known = NominalFinger(), drawn.known
    loop = SampledLoop.of_rig(known, drawn.limits.tick_s, MIDDLE_mm, finger, HELD_cN)
    rise = stiffness_limit_N_m(loop)
    step = step_limit_cN(finger, HELD_cN, GENTLE_N_m, drawn.limits.reversal_mm, known.friction_cN)
    return (
        onset_ratio(drawn, lambda ratio: straight(drawn, ratio * rise, 0.0), STILL_mm),
        onset_ratio(drawn, lambda ratio: straight(drawn, GENTLE_N_m, ratio * step), RELAY_mm),
    )


def held_button(drawn: Drawn, model: FDVVModel) -> tuple[bool, bool]:
    """Return (a button is said to be quiet, it is) at its steepest rises and its largest step, at 50 mm/s."""
    x = grid_mm(model.travel_mm, 0.01)
    press, release = (model.force_cN(x, 50.0, stroke) for stroke in Stroke)
    judged = [
        stability(drawn.known, drawn.limits, x, press),
        stability(drawn.known, drawn.limits, x, release, press),
    ]
    coarse = grid_mm(model.travel_mm, 0.05)
    surface = table(drawn, coarse, *(np.interp(coarse, x, f) for f in (press, release)))
    places = [(j.slope.rise_mm, j.slope.rise_cN, STILL_mm) for j in judged]
    at = judged[1].step_mm
    places.append((at, float(np.interp(at, x, 0.5 * (press + release))), RELAY_mm))
    swings = any(swings_held(drawn.rig, drawn.finger, surface, model.travel_mm, *place) for place in places)
    return not any("buzz" in j.holds for j in judged), not swings


def saturates(drawn: Drawn, model: FDVVModel, cut: float) -> tuple[bool, bool]:
    """Return (a limit is said to cut a press, one does) for the predicted table, under a force limit."""
    x = grid_mm(model.travel_mm, 0.05)
    tables = []
    for stroke in Stroke:
        motion = minimum_jerk(stroke, model.travel_mm, SPEED_mm_s, drawn.limits.tick_s)
        along = model.force_cN(motion.displacement_mm, SPEED_mm_s, stroke)
        tables.append(motion.at_places(inverse_dynamics_cN(drawn.known, motion, along), x))
    limit_N = cut * 0.01 * max(float(np.abs(t).max()) for t in tables)
    rig = replace(drawn.rig, controller=replace(drawn.rig.controller, force_limit_N=min(4.9, limit_N)))
    surface = ForceSurface(x, np.array([SPEED_mm_s]), *(t[np.newaxis] for t in tables))
    random, image = np.random.default_rng(drawn.seed), image_of(surface, model.travel_mm).image
    pace_s = solve_program_pace(rig, drawn.finger, image, SPEED_mm_s)
    gesture = vary(drawn.finger, 1e-3 * model.travel_mm, pace_s, 1e-3 * SPEED_mm_s, random)
    noise = draw_noise(rig, drawn.finger, gesture, random)
    trace = simulate(rig, drawn.finger, gesture, surface, model.travel_mm, noise, SPEED_mm_s)
    predicted = feasibility(model, drawn.known, settings_of(rig), [SPEED_mm_s])
    said = any(curve.reached.saturated.any() for curve in predicted.curves)
    return said, bool(trace.saturated[trace.displacement_mm > 0.05].any())


def learned_button(drawn: Drawn, model: FDVVModel) -> list[tuple[float, ...]]:
    """Learn a button with the paper's law; per curve: speed, error and command, predicted and found.

    Errors are those of fresh presses; commands the largest of either sign, where a probe judges.
    """
    speeds = (50.0, 100.0, 150.0, 200.0)
    learned = compensate(TwinDevice(drawn.rig, drawn.finger, drawn.seed), model, speeds, PaperLaw(rounds=2))
    fresh = TwinDevice(drawn.rig, drawn.finger, drawn.seed + 5000)
    found = probe(fresh, model, learned.surface, speeds, 8)
    predicted = feasibility(model, drawn.known, settings_of(drawn.rig), speeds, found)
    rows: list[tuple[float, ...]] = []
    for curve in predicted.curves:
        assert curve.measured
        reached, error_cN = curve.reached, float(np.median(curve.measured.mean_errors_cN))
        place_mm = reached.displacement_mm[reached.inner_rows]
        row = learned.surface.table_cN(curve.stroke)[speeds.index(curve.velocity_mm_s)]
        command_cN = np.interp(place_mm, learned.surface.displacement_mm, row)
        largest = [float(np.abs(c).max()) for c in (reached.command_cN[reached.inner_rows], command_cN)]
        rows.append((curve.velocity_mm_s, curve.expected.mean_cN, error_cN, *largest))
    return rows


def agreement(title: str, pairs: list[tuple[bool, bool]], good: str, bad: str) -> str:
    """Count predictions against what happened."""
    parts = []
    for said, word, other in ((True, good, bad), (False, bad, good)):
        happened = [was for predicted, was in pairs if predicted is said]
        parts.append(
            f"predicted {word} {len(happened)}, of them {sum(w is not said for w in happened)} {other}"
        )
    return f"{title}: {'; '.join(parts)}"


def spread(title: str, ratios: list[float]) -> str:
    """Return median, range and how many lie below 1."""
    return (
        f"{title}: begins at {np.median(ratios):.2f} times the prediction (median; {min(ratios):.2f} to "
        f"{max(ratios):.2f}), below it on {sum(r < 0.99 for r in ratios)} of {len(ratios)} rigs"
    )


def main(seeds: range = SEEDS) -> None:
    rigs = list(draw(seeds))
    print(f"{len(rigs)} rigs of seeds {seeds.start} to {seeds.stop - 1}, 4 kHz, simulated")
    rise, step = zip(*(onsets(drawn) for drawn in rigs), strict=True)
    print(spread("swing on a straight rise", list(rise)))
    print(spread("swing on a step between strokes", list(step)))
    models = [load_builtin(name) for name in BUTTONS]
    print(
        agreement(
            "buzz of six buttons", [held_button(d, m) for d in rigs for m in models], "quiet", "buzzing"
        )
    )
    cuts = [saturates(d, models[d.seed % len(models)], cut) for d in rigs for cut in CUTS]
    print(agreement("saturation", cuts, "cut", "uncut"))
    rows: list[tuple[float, ...]] = []
    for drawn in rigs:
        try:
            rows += learned_button(drawn, models[0])
        except DeviceError:
            print(f"seed {drawn.seed}: too many presses in a row could not be used, nothing learned")
    for speed in sorted({row[0] for row in rows}):
        print(against(speed, np.array([row[1:] for row in rows if row[0] == speed])))


def against(speed_mm_s: float, rows: FloatArray) -> str:
    """Compare the predicted error and command at one speed, (n, 4), with what was found."""
    parts = [f"{speed_mm_s:g} mm/s, {len(rows)} curves"]
    for name, predicted, found in (("error", *rows.T[:2]), ("largest command", *rows.T[2:])):
        low, middle, high = np.percentile(found / predicted, [5, 50, 95])
        parts.append(
            f"{name} predicted {np.median(predicted):.1f} cN, learned {np.median(found):.1f} cN, "
            f"ratio {middle:.2f} (5 to 95 %: {low:.2f} to {high:.2f})"
        )
    return "; ".join(parts)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    main(range(given[0], given[1] + 1) if given else SEEDS)
