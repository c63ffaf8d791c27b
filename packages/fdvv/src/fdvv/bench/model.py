"""The model of a recording of presses, and the outcome of every press."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.bench.vibration import RecordedVibrations, find_vibrations
from fdvv.button.compare import curve_spread, spread_reports
from fdvv.button.fit import DECIMALS_mm, FitSettings, fit_report, one_line
from fdvv.errors import FdvvError, InputError
from fdvv.force_text import force_text
from fdvv.model.curve import MeasuredCurve, Stroke, reading_order
from fdvv.model.fit import CurveFit, fit_curve
from fdvv.model.landmarks import landmark_errors, landmarks
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.spread import CurveSpread, PointSpread
from fdvv.preprocess.average import AveragedCurve
from fdvv.preprocess.probe import Probe
from fdvv.preprocess.process import Feature, Processed, Settings, process
from fdvv.preprocess.reject import Judged
from fdvv.recording.file import load_recording
from fdvv.recording.types import Recording

OFF_VELOCITY_ratio = 0.15
"""A velocity whose presses are further off on the median is reported."""
FEW_TAKES = 6
"""Takes that are named one by one; more are counted."""


def source_of(recording: Recording) -> str:
    files = ", ".join(f"{source.name} ({source.format})" for source in recording.sources)
    parts = [f"{len(recording.takes)} takes of {recording.name}", recording.person, files]
    return one_line("; ".join(part for part in parts if part))


def method_of(recording: Recording, processed: Processed) -> str:
    clock, bench = processed.clock, recording.bench
    steps = []
    if clock.edges:
        refused = f", {clock.refused} refused" if clock.refused else ""
        doubt = f"doubt {1e6 * clock.doubt_s:.2g} µs"
        steps.append(f"clocks joined on {clock.edges} edges of a light ({doubt}{refused})")
    if bench.force_filter_ms:
        steps.append(f"the force filter of {bench.force_filter_ms:g} ms undone")
    if bench.force_play_cN:
        steps.append(f"the force sensor's play of {force_text(bench.force_play_cN)} undone")
    steps.append("paths between frames found from frames and force together")
    steps.append(explain_rejections(processed))
    if processed.probe:
        probes = "a slow probe" if processed.probe.probes == 1 else f"{processed.probe.probes} slow probes"
        steps.append(f"zero and slowest curves from {probes}")
    return "; ".join(steps)


def explain_rejections(processed: Processed) -> str:
    left = [entry for entry in processed.judged if entry.reason is not None]
    used = len(processed.judged) - len(left)
    summary = f"{used} of {len(processed.judged)} presses averaged at their own samples on 50 µm"
    counts = Counter(str(entry.reason) for entry in left)
    reasons = [f"{reason} ({_takes(left, reason)})" for reason, _ in counts.most_common()]
    return f"{summary}, left out: {', '.join(reasons)}" if reasons else summary


def _takes(left: Sequence[Judged], reason: str) -> str:
    numbers = list(dict.fromkeys(str(entry.press.take) for entry in left if entry.reason == reason))
    more = len(numbers) - FEW_TAKES
    listed = ", ".join(numbers[:FEW_TAKES]) + (f" and {more} more" if more > 0 else "")
    return f"take {listed}" if len(numbers) == 1 else f"takes {listed}"


def assumptions_of(recording: Recording, settings: Settings) -> tuple[str, ...]:
    """List what no measurement of this recording supports."""
    bench = recording.bench
    facts = [
        (bench.tip_mass_g, f"the force sensor's tip weighs {bench.tip_mass_g:g} g"),
        (bench.force_filter_ms, f"the filter before its converter has {bench.force_filter_ms:g} ms"),
        (bench.force_play_cN, f"it reads {force_text(bench.force_play_cN)} more on the way back"),
        (bench.exposure_ms, f"the camera exposes for {bench.exposure_ms:g} ms"),
    ]
    return (
        f"the cap, with stem, markers and a third of its spring, moves {settings.cap_g:g} g",
        *(f"{sentence}, as the bench states" for value, sentence in facts if value),
        "spreads are between presses of one recording; what all of them share is not in them",
    )


def velocity_warnings(processed: Processed) -> list[str]:
    """Warn of velocities whose presses were on the median more than 15 % too fast or too slow."""
    return [
        f"presses asked at {curve.velocity_mm_s:g} mm/s were made at {curve.achieved_mm_s:.0f} mm/s"
        for curve in processed.curves
        if curve.stroke is Stroke.PRESS
        and curve.velocity_mm_s is not None
        and abs(curve.achieved_mm_s / curve.velocity_mm_s - 1) > OFF_VELOCITY_ratio
    ]


DECIMALS_cN = 4
"""Of a spread, which presses determine to some per cent; a file need not hold more digits."""
FindVibrations = Callable[[Recording, Processed], RecordedVibrations]
"""Finds the vibrations of the presses of a processed recording."""


@dataclass(frozen=True, eq=False)
class RecordedModel:
    """A model of recorded presses and how it came about.

    Attributes
    ----------
    recording : what it was made of.
    model : displacement 0 is the first contact with the resting cap.
    processed : every step between the streams and the averaged curves.
    fits : one per curve of the model, in the model's order; the probe's are among them.
    measured : the averaged curve behind each fit, in fits' order.
    vibration : found by microphone or accelerometer, with the strokes that lack one.
    warnings : what was repaired, left out or could not be found.
    """

    recording: Recording
    model: FDVVModel
    processed: Processed
    fits: tuple[CurveFit, ...]
    measured: tuple[MeasuredCurve, ...]
    vibration: RecordedVibrations
    warnings: tuple[str, ...]


def process_recording(
    path: Path | str,
    settings: Settings | None = None,
    fit_settings: FitSettings | None = None,
    find_vibrations: FindVibrations = find_vibrations,
) -> RecordedModel:
    """Read a file of a recording and make its model. Raises InputError."""
    recording = load_recording(path)
    try:
        return model_of_recording(recording, settings, fit_settings, find_vibrations)
    except FdvvError as error:
        remedy = "check that its takes hold force, displacement and what joins their clocks"
        raise InputError(path, "recording", str(error), remedy) from error


def model_of_recording(
    recording: Recording,
    settings: Settings | None = None,
    fit_settings: FitSettings | None = None,
    find_vibrations: FindVibrations = find_vibrations,
) -> RecordedModel:
    """Process a recording and fit every averaged curve; the slow probe is the slowest one.

    Parameters
    ----------
    settings, fit_settings : of the processing and of the fits; by default those of fdvv process.
    find_vibrations : finds the vibrations of the presses.

    Curves carry the requested velocity, or the achieved one where none was requested. Raises ModelError
    where a step finds nothing to work on, FitError.
    """
    settings, fit_settings = settings or Settings(), fit_settings or FitSettings()
    processed = process(recording, settings)
    warnings = [*recording.warnings, *processed.warnings, *velocity_warnings(processed)]
    parts = [_curve_and_spread(curve) for curve in processed.curves]
    parts += _probe_curves(processed.probe, {part.velocity_mm_s for part, _ in parts}, warnings)
    parts.sort(key=lambda pair: reading_order(pair[0]))
    fits = tuple(_fit(part, spread, fit_settings) for part, spread in parts)
    vibration = find_vibrations(recording, processed)
    warnings += vibration.warnings
    travel_mm = round(processed.travel_mm.value, DECIMALS_mm)
    actuation = _switch_point("actuation", processed.actuation_mm, processed.probe, travel_mm, warnings)
    reset = _switch_point("reset", processed.reset_mm, processed.probe, travel_mm, warnings)
    model = FDVVModel(
        name=one_line(recording.name) or "unnamed",
        travel_mm=travel_mm,
        curves=tuple(fit.curve for fit in fits),
        actuation_mm=round(actuation.value, DECIMALS_mm) if actuation else None,
        reset_mm=round(reset.value, DECIMALS_mm) if reset else None,
        vibrations=vibration.vibrations,
        provenance=Provenance(
            source=source_of(recording),
            licence=one_line(recording.licence),
            method=f"{method_of(recording, processed)}; {fit_settings.describe()}",
            assumptions=(*assumptions_of(recording, settings), *vibration.assumptions),
            simulated=recording.simulated,
        ),
        travel_spread=_point(processed.travel_mm),
        actuation_spread=_point(actuation),
        reset_spread=_point(reset),
    )
    measured, warned = tuple(part for part, _ in parts), tuple(dict.fromkeys(warnings))
    return RecordedModel(recording, model, processed, fits, measured, vibration, warned)


def _curve_and_spread(curve: AveragedCurve) -> tuple[MeasuredCurve, CurveSpread | None]:
    """Return a curve as a fit takes it, at the achieved velocity where none was requested."""
    x_mm = np.round(curve.displacement_mm, DECIMALS_mm)
    requested_mm_s = curve.velocity_mm_s or round(curve.achieved_mm_s, 1)
    spread_cN = np.round(curve.spread_cN, DECIMALS_cN)
    speeds = (round(curve.achieved_mm_s, 2), round(curve.achieved_spread_mm_s, 2))
    spread = CurveSpread(x_mm, spread_cN, curve.presses, *speeds) if curve.presses > 1 else None
    return MeasuredCurve(x_mm, curve.force_cN, curve.stroke, requested_mm_s), spread


def _probe_curves(
    probe: Probe | None, velocities_mm_s: set[float | None], warnings: list[str]
) -> list[tuple[MeasuredCurve, CurveSpread | None]]:
    """Return both strokes of the slow probe; none if its velocity is unknown or that of presses."""
    if probe is None:
        return []
    if probe.velocity_mm_s is None or probe.velocity_mm_s in velocities_mm_s:
        reason = "unknown" if probe.velocity_mm_s is None else "that of presses"
        warnings.append(f"the speed of the slow probe is {reason}: it gives the zero, but no curve")
        return []
    x_mm = np.round(probe.displacement_mm, DECIMALS_mm)
    curves: list[tuple[MeasuredCurve, CurveSpread | None]] = []
    for stroke, force_cN, spread_cN in zip(
        Stroke, (probe.press_cN, probe.release_cN), probe.spread_cN, strict=True
    ):
        spread = (
            CurveSpread(x_mm, np.round(spread_cN, DECIMALS_cN), probe.probes) if probe.probes > 1 else None
        )
        curves.append((MeasuredCurve(x_mm, force_cN, stroke, probe.velocity_mm_s), spread))
    return curves


def _fit(part: MeasuredCurve, spread: CurveSpread | None, settings: FitSettings) -> CurveFit:
    fit = fit_curve(part, settings.method, settings.control_points, settings.degree, settings.smoothing_mm)
    return replace(fit, curve=replace(fit.curve, spread=spread))


def _switch_point(
    what: str, point: Feature | None, probe: Probe | None, travel_mm: float, warnings: list[str]
) -> Feature | None:
    """Return where the circuit switched, by the presses, else by the probe; None beyond the travel."""
    if point is None and probe is not None:
        positions_mm = probe.closed_mm if what == "actuation" else probe.open_mm
        spread_mm = float(np.std(positions_mm, ddof=1)) if len(positions_mm) > 1 else 0.0
        point = Feature(float(np.mean(positions_mm)), spread_mm, len(positions_mm)) if positions_mm else None
    if point is not None and not 0 <= point.value <= travel_mm:
        outside = f"lies outside the travel of {travel_mm:.3f} mm"
        warnings.append(f"{what} at {point.value:.3f} mm {outside}: left out")
        return None
    return point


def _point(feature: Feature | None) -> PointSpread | None:
    if feature is None or feature.presses < 2:
        return None
    return PointSpread(round(feature.spread, DECIMALS_mm), feature.presses)


def capture_report(recorded: RecordedModel) -> dict[str, Any]:
    """Return all figures of a recorded model, units in the names."""
    model = recorded.model
    pressed = bool(model.of(Stroke.PRESS))
    errors = landmark_errors(model) if pressed else {}
    return {
        "name": model.name,
        "simulated": model.provenance.simulated,
        "clock": {name: float(value) for name, value in vars(recorded.processed.clock).items()},
        "curves": [{**curve_spread(fit.curve), **fit_report(fit)} for fit in recorded.fits],
        "presses": press_reports(recorded.processed),
        "landmarks": landmarks(model).to_dict() if pressed else {"travel_mm": model.travel_mm},
        "landmark_errors": {name: vars(error) for name, error in errors.items()},
        "vibrations": {
            "heard": [stroke.report() for stroke in recorded.vibration.strokes],
            "in_model": spread_reports(model)["vibrations"],
            "scalings": [scaling.report() for scaling in recorded.vibration.scalings],
        },
        "method": model.provenance.method,
        "assumptions": list(model.provenance.assumptions),
        "warnings": list(recorded.warnings),
    }


def press_reports(processed: Processed) -> list[dict[str, Any]]:
    """Return the outcome of every press; reason is null where it was used."""
    return [
        {
            "take": entry.press.take,
            "part": entry.press.part,
            "velocity_mm_s": entry.press.velocity_mm_s,
            "achieved_mm_s": float(entry.achieved_mm_s),
            "bottom_mm": float(entry.spans.bottom_mm),
            "reason": str(entry.reason) if entry.reason else None,
        }
        for entry in processed.judged
    ]
