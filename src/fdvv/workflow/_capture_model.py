"""From a recording of presses to a finished model, and what was made of every press on the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fdvv.errors import FdvvError, InputError
from fdvv.model import (
    CurveFit,
    CurveSpread,
    FDVVModel,
    MeasuredCurve,
    PointSpread,
    Provenance,
    Stroke,
    fit_curve,
    reading_order,
)
from fdvv.preprocess import AveragedCurve, Feature, Probe, Processed, Settings, process
from fdvv.recording import Recording, load_recording
from fdvv.workflow._capture_vibration import RecordedVibrations, recorded_vibrations
from fdvv.workflow._capture_words import assumptions_of, method_of, pace_warnings, source_of
from fdvv.workflow._fit import DECIMALS_mm, FitSettings, one_line

DECIMALS_cN = 4
"""Of a spread: presses tell it to some per cent, and a file need not hold more digits than that by far."""

FindVibrations = Callable[[Recording, Processed], RecordedVibrations]
"""From a recording and what its force came to, to the vibrations of its presses."""


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
    heard : what microphone or accelerometer told of vibration, and where it told nothing.
    warnings : what was repaired, left out or could not be found.
    """

    recording: Recording
    model: FDVVModel
    processed: Processed
    fits: tuple[CurveFit, ...]
    measured: tuple[MeasuredCurve, ...]
    heard: RecordedVibrations
    warnings: tuple[str, ...]


def process_recording(
    path: Path | str,
    settings: Settings | None = None,
    fit_settings: FitSettings | None = None,
    find_vibrations: FindVibrations = recorded_vibrations,
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
    find_vibrations: FindVibrations = recorded_vibrations,
) -> RecordedModel:
    """Process a recording and fit every averaged curve; the slow probe is the slowest one.

    Parameters
    ----------
    settings, fit_settings : of the processing and of the fits; by default those of fdvv process.
    find_vibrations : finds the vibrations of the presses.

    Curves carry the pace that was asked for, or the one that was achieved where none was. Raises ModelError
    where a step finds nothing to work on, FitError.
    """
    settings, fit_settings = settings or Settings(), fit_settings or FitSettings()
    processed = process(recording, settings)
    warnings = [*recording.warnings, *processed.warnings, *pace_warnings(processed)]
    parts = [_averaged(curve) for curve in processed.curves]
    parts += _probed(processed.probe, {part.velocity_mm_s for part, _ in parts}, warnings)
    parts.sort(key=lambda pair: reading_order(pair[0]))
    fits = tuple(_fit(part, spread, fit_settings) for part, spread in parts)
    heard = find_vibrations(recording, processed)
    warnings += heard.warnings
    travel_mm = round(processed.travel_mm.value, DECIMALS_mm)
    actuation = _switched("actuation", processed.actuation_mm, processed.probe, travel_mm, warnings)
    reset = _switched("reset", processed.reset_mm, processed.probe, travel_mm, warnings)
    model = FDVVModel(
        name=one_line(recording.name) or "unnamed",
        travel_mm=travel_mm,
        curves=tuple(fit.curve for fit in fits),
        actuation_mm=round(actuation.value, DECIMALS_mm) if actuation else None,
        reset_mm=round(reset.value, DECIMALS_mm) if reset else None,
        vibrations=heard.vibrations,
        provenance=Provenance(
            source=source_of(recording),
            licence=one_line(recording.licence),
            method=f"{method_of(recording, processed)}; {fit_settings.describe()}",
            assumptions=(*assumptions_of(recording, settings), *heard.assumptions),
            simulated=recording.simulated,
        ),
        travel_spread=_point(processed.travel_mm),
        actuation_spread=_point(actuation),
        reset_spread=_point(reset),
    )
    measured = tuple(part for part, _ in parts)
    return RecordedModel(recording, model, processed, fits, measured, heard, tuple(dict.fromkeys(warnings)))


def _averaged(curve: AveragedCurve) -> tuple[MeasuredCurve, CurveSpread | None]:
    """Give a curve as a fit takes it; where no pace was asked for, that which was achieved stands for it."""
    x_mm = np.round(curve.displacement_mm, DECIMALS_mm)
    asked_mm_s = curve.velocity_mm_s or round(curve.achieved_mm_s, 1)
    spread_cN = np.round(curve.spread_cN, DECIMALS_cN)
    speeds = (round(curve.achieved_mm_s, 2), round(curve.achieved_spread_mm_s, 2))
    spread = CurveSpread(x_mm, spread_cN, curve.presses, *speeds) if curve.presses > 1 else None
    return MeasuredCurve(x_mm, curve.force_cN, curve.stroke, asked_mm_s), spread


def _probed(
    probe: Probe | None, paces_mm_s: set[float | None], warnings: list[str]
) -> list[tuple[MeasuredCurve, CurveSpread | None]]:
    """Give both strokes of the slow probe; without a speed of its own it cannot stand beside presses."""
    if probe is None:
        return []
    if probe.velocity_mm_s is None or probe.velocity_mm_s in paces_mm_s:
        told = "unknown" if probe.velocity_mm_s is None else "that of presses"
        warnings.append(f"the speed of the slow probe is {told}: it gives the zero, but no curve")
        return []
    x_mm = np.round(probe.displacement_mm, DECIMALS_mm)
    forces_cN = zip(Stroke, (probe.press_cN, probe.release_cN), probe.spread_cN, strict=True)
    return [
        (
            MeasuredCurve(x_mm, force_cN, stroke, probe.velocity_mm_s),
            CurveSpread(x_mm, np.round(spread_cN, DECIMALS_cN), probe.probes) if probe.probes > 1 else None,
        )
        for stroke, force_cN, spread_cN in forces_cN
    ]


def _fit(part: MeasuredCurve, spread: CurveSpread | None, settings: FitSettings) -> CurveFit:
    fit = fit_curve(part, settings.method, settings.control_points, settings.degree, settings.smoothing_mm)
    return replace(fit, curve=replace(fit.curve, spread=spread))


def _switched(
    what: str, found: Feature | None, probe: Probe | None, travel_mm: float, warnings: list[str]
) -> Feature | None:
    """Tell where the circuit switched: as presses say, else as the probe does; None beyond the travel."""
    if found is None and probe is not None:
        places_mm = probe.closed_mm if what == "actuation" else probe.open_mm
        spread_mm = float(np.std(places_mm, ddof=1)) if len(places_mm) > 1 else 0.0
        found = Feature(float(np.mean(places_mm)), spread_mm, len(places_mm)) if places_mm else None
    if found is not None and not 0 <= found.value <= travel_mm:
        told = f"{what} at {found.value:.3f} mm lies outside the travel of {travel_mm:.3f} mm"
        warnings.append(f"{told}: left out")
        return None
    return found


def _point(feature: Feature | None) -> PointSpread | None:
    """Give the spread of a point; a single press has none."""
    if feature is None or feature.presses < 2:
        return None
    return PointSpread(round(feature.spread, DECIMALS_mm), feature.presses)
