"""How well do captured curves, points and verdicts agree with what happened? Simulated; half an hour in all.

Run as ``python -m benchmarks.capture``, or with parts: accuracy, presses, budget, speed. Sessions have
everything that goes wrong at a bench: noise of all sensors, clock offset and drift, lost frames, 4 %
incomplete presses and 10 % wild ones. Truth is the mean of the true force at the true displacement over the
good presses of a pace.
"""

from __future__ import annotations

import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from fdvv.bench.model import model_of_recording
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.preprocess.average import AveragedCurve
from fdvv.preprocess.paper import AS_PRINTED, PaperRecipe, paper_average
from fdvv.preprocess.process import Processed, process
from fdvv.preprocess.reject import Reason
from fdvv.testing.captured import PERFECT_RIG, PERFECT_SENSOR, CapturedSession, captured_session, top_mm
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import button_names
from fdvv.twin.finger import Finger, PressVariability
from fdvv.twin.rig import ForceSensor
from fdvv.units import FloatArray

FIRST_SEED, SEEDS = 700, 6
FROM_mm = 0.15
"""Errors count from here on: above it the upper stop has part in the force."""

BUDGET_PACES_mm_s = (50.0, 100.0, 200.0)
BUDGET_SEEDS = range(900, 903)


def truth_and_found(
    session: CapturedSession, curve: AveragedCurve
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return displacement, true and found force where both are known."""
    true_cN = session.true_cN(curve)
    inside = (curve.displacement_mm > FROM_mm) & np.isfinite(true_cN)
    return curve.displacement_mm[inside], true_cN[inside], curve.force_cN[inside]


def errors(session: CapturedSession, curve: AveragedCurve) -> dict[str, float]:
    """Return the errors of one curve; those of the bump only where there is one."""
    x, true_cN, found_cN = truth_and_found(session, curve)
    result = {"rms_cN": float(np.sqrt(np.mean((found_cN - true_cN) ** 2)))}
    wanted, found = find_bump(x, true_cN), find_bump(x, found_cN)
    if wanted and found:
        result["peak_cN"] = found.peak_cN - wanted.peak_cN
        result["top_mm"] = top_mm(x, found_cN) - top_mm(x, true_cN)
    elif wanted:
        result["lost"] = 1.0
    return result


def spread(values: Iterable[float]) -> str:
    found = np.array(list(values))
    if not found.size:
        return "-"
    low, middle, high = np.percentile(found, [5, 50, 95])
    return f"{middle:+.3g} ({low:+.3g} to {high:+.3g}; largest {np.abs(found).max():.3g})"


def paper(recipe: PaperRecipe) -> Callable[[Processed, AveragedCurve], AveragedCurve]:
    def average(done: Processed, curve: AveragedCurve) -> AveragedCurve:
        return paper_average(done.judged, curve.stroke, curve.velocity_mm_s, recipe, done.zero_mm)

    return average


METHODS: dict[str, Callable[[Processed, AveragedCurve], AveragedCurve]] = {
    "ours": lambda _done, curve: curve,
    "paper's recipe, sigmas in samples": paper(PaperRecipe()),
    "paper's recipe, sigmas in mm as printed": paper(AS_PRINTED),
}


def accuracy() -> None:
    """Return errors of curves and points, ours beside the paper's recipe on the same presses and clocks."""
    print(
        f"accuracy: six buttons, seeds {FIRST_SEED} to {FIRST_SEED + SEEDS - 1}, 15 presses a pace, simulated"
    )
    points: dict[str, list[float]] = defaultdict(list)
    found: dict[tuple[str, str], dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for name in button_names():
        for seed in range(FIRST_SEED, FIRST_SEED + SEEDS):
            session = captured_session(name, seed)
            done = process(session.recording)
            _points(session, done, points)
            for curve in done.curves:
                for method, average in METHODS.items():
                    row = errors(session, average(done, curve))
                    where = f"{curve.stroke} {curve.velocity_mm_s:g} mm/s"
                    for what, value in row.items():
                        found[method, where][what].append(value)
                        found[method, f"{where} {name}"][what].append(value)
    for what, values in points.items():
        print(f"{what}: {spread(values)}")
    for (method, where), lists in found.items():
        line = "; ".join(f"{what} {spread(values)}" for what, values in lists.items() if what != "lost")
        lost = f"; bump lost in {len(lists['lost'])}" if lists.get("lost") else ""
        print(f"{method}, {where}: {line}{lost}")


def _points(session: CapturedSession, done: Processed, points: dict[str, list[float]]) -> None:
    board_s = np.array([take.truth.begin_s for take in session.takes])
    camera_s = session.takes[0].truth.setup.camera_s(board_s)
    points["clock_ms"].append(1e3 * float(np.abs(done.clock.board_s(camera_s) - board_s).max()))
    points["travel_mm"].append(done.travel_mm.value - session.travel_mm)
    if done.actuation_mm:
        points["actuation_mm"].append(done.actuation_mm.value - session.true_actuation_mm())


def presses() -> None:
    """Count verdicts against what the participant really did."""
    counts: Counter[tuple[str, str]] = Counter()
    seeds = range(FIRST_SEED, FIRST_SEED + 3 * SEEDS)
    for name in button_names():
        for seed in seeds:
            session = captured_session(name, seed)
            verdicts: dict[int, list[Reason | None]] = defaultdict(list)
            for one in process(session.recording).judged:
                verdicts[one.press.take].append(one.reason)
            for outcome in ("good", "incomplete", "wild"):
                for take in session.of(outcome):
                    verdict = verdicts[take.take.number]
                    reason = "used" if None in verdict else str(verdict[0]) if verdict else "not seen"
                    counts[take.truth.intent.kind or outcome, reason] += 1
    print(f"presses: six buttons, seeds {seeds.start} to {seeds.stop - 1}, simulated")
    for (kind, reason), count in sorted(counts.items()):
        print(f"{kind}: {reason}: {count}")


RIG_ERRORS = (
    "exposure_s",
    "marker_noise_m",
    "marker_bias_m",
    "rocking_rad",
    "sideways_m",
    "askew_rad",
    "dropped_ratio",
)
"""Errors of cameras that are put into a bench whose cameras give 256 frames a second."""

SENSOR_ERRORS = {
    "cone's mass and contact": ("mass_kg", "contact_stiffness_N_m", "contact_loss_s_m"),
    "RC filter": ("filter_s",),
    "10 bit over 19.6 N": ("converter_bits",),
    "force noise": ("noise_N",),
    "play": ("hysteresis_N",),
}


def budget() -> None:
    """Report what each error does alone, then all: MX Clear, a steady participant, three sessions each."""
    sensor, rig, finger = ForceSensor(), CaptureRig(), Finger()
    paces = ", ".join(f"{pace:g}" for pace in BUDGET_PACES_mm_s)
    print(f"budget: mx-clear, cN rms from 0.15 mm, press / release at {paces} mm/s, medians, simulated")
    _tell("nothing: a perfect bench", PERFECT_RIG, PERFECT_SENSOR, finger)
    framed = replace(PERFECT_RIG, frame_Hz=rig.frame_Hz)
    _tell("256 frames a second", framed, PERFECT_SENSOR, finger)
    for name in RIG_ERRORS:
        _tell(f"256 frames and {name}", replace(framed, **{name: getattr(rig, name)}), PERFECT_SENSOR, finger)
    light = replace(framed, exposure_s=rig.exposure_s, clock_ppm=rig.clock_ppm, light_noise=rig.light_noise)
    _tell("256 frames, drift and a noisy light", light, PERFECT_SENSOR, finger)
    _tell("force_zero_N", replace(PERFECT_RIG, force_zero_N=rig.force_zero_N), PERFECT_SENSOR, finger)
    for what, names in SENSOR_ERRORS.items():
        changed = replace(PERFECT_SENSOR, **{name: getattr(sensor, name) for name in names})
        _tell(what, PERFECT_RIG, changed, finger)
    off = replace(PERFECT_SENSOR, gain_error_ratio=0.03)
    _tell("gain 3 % off, which nothing corrects", PERFECT_RIG, off, finger)
    _tell("all of them but gain", rig, sensor, finger)
    _tell("all of them, no slow probe", rig, sensor, finger, probe=False)
    _tell("all of them, finger from 2 mm above", rig, sensor, Finger(habit=PressVariability(lift_m=0.002)))


def _tell(what: str, rig: CaptureRig, sensor: ForceSensor, finger: Finger, probe: bool = True) -> None:
    print(f"{what}: {_budget_line(rig, sensor, finger, probe)}", flush=True)


def _budget_line(rig: CaptureRig, sensor: ForceSensor, finger: Finger, probe: bool) -> str:
    found: dict[tuple[Stroke, float | None], list[float]] = defaultdict(list)
    for seed in BUDGET_SEEDS:
        session = captured_session(
            "mx-clear", seed, rig, sensor, finger, PARTICIPANTS["steady"], 15, BUDGET_PACES_mm_s, probe
        )
        # a filter that is not worth undoing is stated as none
        facts = session.recording.bench
        if sensor.filter_s == PERFECT_SENSOR.filter_s:
            session = replace(
                session, recording=replace(session.recording, bench=replace(facts, force_filter_ms=0.0))
            )
        for curve in process(session.recording).curves:
            found[curve.stroke, curve.velocity_mm_s].append(errors(session, curve)["rms_cN"])
    return ", ".join(
        " / ".join(f"{np.median(found[stroke, pace]):.2f}" for stroke in Stroke) for pace in BUDGET_PACES_mm_s
    )


def speed() -> None:
    """Time 60 presses of four streams from the recording in memory to the finished model."""
    for name in button_names():
        session = captured_session(name, FIRST_SEED)
        times = []
        for _ in range(3):
            begun = time.perf_counter()
            model_of_recording(session.recording)
            times.append(time.perf_counter() - begun)
        print(f"speed, {name}: {np.median(times):.2f} s to the model ({min(times):.2f} to {max(times):.2f})")


PARTS = {"accuracy": accuracy, "presses": presses, "budget": budget, "speed": speed}


def main(parts: Sequence[str]) -> None:
    for part in parts or PARTS:
        PARTS[part]()


if __name__ == "__main__":
    main(sys.argv[1:])
