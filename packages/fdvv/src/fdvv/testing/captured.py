"""Whole capture sessions on the twin, with what really happened beside what was recorded. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.preprocess.average import AveragedCurve
from fdvv.recording.types import Recording, Stage
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.capture.bench import CaptureBench, SimulatedTake
from fdvv.twin.capture.participant import PARTICIPANTS, Participant
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace
from fdvv.units import FloatArray, mm_from_m

PACES_mm_s = (50.0, 100.0, 150.0, 200.0)
"""Of the paper's procedure, 15 presses each."""

PERFECT_RIG = CaptureRig(
    frame_Hz=2000.0, exposure_s=0.0, marker_noise_m=0.0, marker_bias_m=0.0, rocking_rad=0.0,
    sideways_m=0.0, askew_rad=0.0, dropped_ratio=0.0, unseen_ratio=0.0, light_noise=0.0, clock_ppm=0.0,
    force_zero_N=0.0, sound_low_Hz=0.0, sound_filter_s=0.0, sound_noise_V=0.0, sound_bits=0,
    shake_noise_m_s2=0.0, shake_step_m_s2=0.0,
)  # fmt: skip
"""A bench without an error of its own."""

PERFECT_SENSOR = ForceSensor(
    mass_kg=2e-4, filter_s=2e-5, noise_N=0.0, hysteresis_N=0.0, converter_bits=0, contact_stiffness_N_m=2e4,
    contact_loss_s_m=1.0,
)  # fmt: skip
"""The lightest sensor that the twin can compute, without an error of its own."""

NEAR_mm = 0.02
"""A cap so near to its deepest place has arrived, and so near to its rest has left."""

TOP_cN = 1.5
"""The top of a bump is what lies less than this below its peak."""


@dataclass(frozen=True, eq=False)
class CapturedSession:
    """A session: the recording that a person would have, and the truth of every take."""

    button: ButtonPhysics
    recording: Recording
    takes: tuple[SimulatedTake, ...]

    def of(self, outcome: str, velocity_mm_s: float | None = None) -> list[SimulatedTake]:
        """Return presses that came out good, incomplete or wild, at one pace or at all."""
        presses = [t for t in self.takes if t.take.stage is Stage.PRESS]
        paces = (velocity_mm_s,) if velocity_mm_s else {t.take.velocity_mm_s for t in presses}
        return [t for t in presses if t.truth.intent.outcome == outcome and t.take.velocity_mm_s in paces]

    def true_cN(self, curve: AveragedCurve) -> FloatArray:
        """Average the true force at the true displacement over the good presses, on a curve's grid, (n,).

        NaN where the cap of no good press was in its stroke.
        """
        assert curve.velocity_mm_s is not None
        traces = [t.truth.trace for t in self.of("good", curve.velocity_mm_s)]
        forces = np.array([true_stroke_cN(t, curve.stroke, curve.displacement_mm) for t in traces if t])
        seen = np.isfinite(forces).sum(axis=0)
        return np.where(seen > 0, np.nansum(forces, axis=0) / np.maximum(seen, 1), np.nan)

    def true_actuation_mm(self) -> float:
        """Return the median over good presses of where the circuit closed."""
        traces = [t.truth.trace for t in self.of("good") if t.truth.trace]
        places = [
            float(np.interp(t.closing_s, t.t_s, t.displacement_mm)) for t in traces if t.closing_s is not None
        ]
        return float(np.median(places))

    @property
    def travel_mm(self) -> float:
        return float(mm_from_m(self.button.curve.travel_m))


def captured_session(
    name: str,
    seed: int,
    rig: CaptureRig | None = None,
    sensor: ForceSensor | None = None,
    finger: Finger | None = None,
    participant: Participant | None = None,
    presses: int = 15,
    paces_mm_s: Sequence[float] = PACES_mm_s,
    probe: bool = True,
) -> CapturedSession:
    """Record the paper's procedure at a bench: rest, slow probe, presses at every pace.

    Whoever presses is the typical participant unless said: 4 % incomplete presses, 10 % wild ones.
    """
    button, random = load_button(name), np.random.default_rng(seed)
    parts = (rig or CaptureRig(), finger or Finger(), sensor or ForceSensor())
    bench = CaptureBench(button, *parts, participant or PARTICIPANTS["typical"], random)
    steps: list[tuple[Stage, float | None]] = [(Stage.REST, None)]
    steps += [(Stage.PROBE, None)] if probe else []
    steps += [(Stage.PRESS, pace) for pace in paces_mm_s for _ in range(presses)]
    takes = tuple(bench.take(number, stage, pace) for number, (stage, pace) in enumerate(steps, 1))
    facts = bench.facts()
    if sensor is PERFECT_SENSOR:
        facts = replace(facts, force_filter_ms=0.0)
    recording = Recording(name, tuple(t.take for t in takes), facts, simulated=True)
    return CapturedSession(button, recording, takes)


def true_stroke_cN(trace: ButtonTrace, stroke: Stroke, displacement_mm: FloatArray) -> FloatArray:
    """Read the true force of one stroke off at displacements; NaN where its cap was not on its way."""
    x, force = trace.displacement_mm, trace.force_cN
    low = np.flatnonzero(x >= float(x.max()) - NEAR_mm)
    if stroke is Stroke.PRESS:
        before = np.flatnonzero(x[: low[0]] < 4 * NEAR_mm)
        part = slice(int(before[-1]) if before.size else 0, int(low[0]) + 1)
        way = np.maximum.accumulate(x[part])
    else:
        after = np.flatnonzero(x[low[-1] :] < 4 * NEAR_mm)
        part = slice(int(low[-1]), int(low[-1] + after[0]) + 1 if after.size else x.size)
        way = np.minimum.accumulate(x[part])
    places, first = np.unique(way, return_index=True)
    return np.interp(displacement_mm, places, force[part][first], left=np.nan, right=np.nan)


def top_mm(displacement_mm: FloatArray, force_cN: FloatArray) -> float:
    """Return where the top of a bump is: midway between the places 1.5 cN below its peak; NaN without a bump.

    A peak's own place is worth less: on a flat top a tenth of a centinewton moves it by 50 um.
    """
    bump = find_bump(displacement_mm, force_cN)
    if bump is None:
        return float("nan")
    peak = int(np.argmin(np.abs(displacement_mm - bump.peak_mm)))
    level = float(force_cN[peak]) - TOP_cN
    first = peak - int(np.argmax(force_cN[peak::-1] <= level)) if np.any(force_cN[: peak + 1] <= level) else 0
    last = peak + int(np.argmax(force_cN[peak:] <= level))
    ends = [
        _crossing(displacement_mm, force_cN, level, i, j) for i, j in ((first, first + 1), (last - 1, last))
    ]
    return float(np.mean(ends))


def _crossing(x: FloatArray, force: FloatArray, level: float, i: int, j: int) -> float:
    rise = float(force[j] - force[i])
    return float(x[i] + (level - force[i]) / rise * (x[j] - x[i])) if rise else float(x[i])
