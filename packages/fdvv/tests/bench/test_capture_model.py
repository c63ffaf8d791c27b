"""From a recording to a model: what it keeps of its presses, and what it says of itself."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.bench.model import (
    assumptions_of,
    capture_report,
    explain_rejections,
    method_of,
    model_of_recording,
    process_recording,
    source_of,
)
from fdvv.bench.vibration import RecordedVibrations
from fdvv.button.fit import FitSettings
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv.preprocess.clock import ClockFit
from fdvv.preprocess.process import Processed, Settings
from fdvv.preprocess.reject import Reason
from fdvv.recording.file import RECORDING_SUFFIX, save_recording
from fdvv.recording.types import Bench, Recording, Source, Stage
from tests.support.captures import SHORT_STROKE, capture, recorded


def without(recording: Recording, *stages: Stage) -> Recording:
    """Leave out the takes of some stages and count the others anew."""
    kept = [take for take in recording.takes if take.stage not in stages]
    return replace(recording, takes=tuple(replace(take, number=i) for i, take in enumerate(kept, 1)))


def paced(recording: Recording, stage: Stage, velocity_mm_s: float | None) -> Recording:
    """Say of the takes of a stage that another pace was asked for, or none."""
    takes = (replace(t, velocity_mm_s=velocity_mm_s) if t.stage is stage else t for t in recording.takes)
    return replace(recording, takes=tuple(takes))


def test_every_pace_and_the_probe_become_curves_of_both_strokes() -> None:
    model = recorded().model
    for stroke in Stroke:
        assert model.velocities_mm_s(stroke) == (0.5, 50.0, 150.0)
    assert model.travel_mm == pytest.approx(4.0, abs=0.1)
    assert model.actuation_mm is not None
    assert model.provenance.simulated


def test_a_curve_keeps_the_spread_that_its_presses_had() -> None:
    found = recorded()
    for curve in found.processed.curves:
        (kept,) = [
            c
            for c in found.model.curves
            if c.stroke is curve.stroke and c.velocity_mm_s == curve.velocity_mm_s
        ]
        assert kept.spread is not None
        np.testing.assert_allclose(kept.spread.spread_cN, curve.spread_cN, atol=1e-4)
        np.testing.assert_allclose(kept.spread.displacement_mm, curve.displacement_mm, atol=1e-6)
        assert kept.spread.presses == curve.presses
        assert kept.spread.achieved_mm_s == pytest.approx(curve.achieved_mm_s, abs=0.01)
        assert kept.spread.achieved_spread_mm_s == pytest.approx(curve.achieved_spread_mm_s, abs=0.01)


def test_points_keep_the_spread_that_their_presses_had() -> None:
    found = recorded()
    travel, actuation = found.processed.travel_mm, found.processed.actuation_mm
    assert actuation is not None
    assert found.model.travel_spread is not None
    assert found.model.travel_spread.spread_mm == pytest.approx(travel.spread, abs=1e-6)
    assert found.model.travel_spread.presses == travel.presses == 11
    assert found.model.actuation_spread is not None
    assert found.model.actuation_spread.presses == actuation.presses == 11


def test_each_spline_holds_to_the_averaged_curve_behind_it() -> None:
    found = recorded()
    for fit, measured in zip(found.fits, found.measured, strict=True):
        off_cN = fit.curve.force_cN(measured.displacement_mm) - measured.force_cN
        assert fit.rmse_cN == pytest.approx(float(np.sqrt(np.mean(off_cN**2))))
        assert fit.rmse_cN < 0.5
        assert fit.bump_kept_ratio is not None
        assert fit.bump_kept_ratio > 0.9
    assert tuple(fit.curve for fit in found.fits) == found.model.curves


def test_provenance_names_steps_presses_reasons_and_assumptions() -> None:
    provenance = recorded().model.provenance
    assert "11 of 12 presses averaged" in provenance.method
    assert f"left out: did not reach the bottom (take {SHORT_STROKE})" in provenance.method
    for step in (
        "clocks joined on",
        "filter of 0.33 ms undone",
        "2 slow probes",
        "BIC*-chosen control points",
    ):
        assert step in provenance.method
    assert any("moves 3 g" in assumption for assumption in provenance.assumptions)
    assert any("tip weighs 2 g" in assumption for assumption in provenance.assumptions)


def test_the_report_tells_every_press_with_its_reason() -> None:
    report = capture_report(recorded())
    reasons = {press["take"]: press["reason"] for press in report["presses"]}
    assert len(reasons) == 12
    assert {take for take, reason in reasons.items() if reason} == {SHORT_STROKE}
    curves = {(c["stroke"], c["velocity_mm_s"]): c for c in report["curves"]}
    assert curves["press", 150.0]["presses"] == 6
    assert curves["press", 0.5]["presses"] == 2
    assert curves["press", 0.5]["achieved_mm_s"] is None
    assert report["simulated"] is True
    assert report["clock"]["refused"] == 0


def test_presses_without_a_pace_are_one_curve_at_the_speed_they_had() -> None:
    recording = without(paced(capture(), Stage.PRESS, None), Stage.PROBE)
    fifth = [t.number for t in recording.takes if t.stage is Stage.PRESS][4]
    slow = replace(recording, takes=recording.takes[:fifth])
    model = model_of_recording(slow).model
    (press,) = model.of(Stroke.PRESS)
    assert press.velocity_mm_s == pytest.approx(52.9, abs=0.1)
    assert press.spread is not None
    assert press.spread.achieved_mm_s == pytest.approx(press.velocity_mm_s, abs=0.06)


def test_a_probe_of_unknown_speed_gives_the_zero_and_a_warning_but_no_curve() -> None:
    found = model_of_recording(paced(capture(), Stage.PROBE, None))
    assert found.model.velocities_mm_s("press") == (50.0, 150.0)
    assert any("speed of the slow probe is unknown" in warning for warning in found.warnings)
    assert found.processed.zero_mm == pytest.approx(recorded().processed.zero_mm)


def test_a_speed_that_presses_missed_is_reported() -> None:
    takes = tuple(
        replace(take, velocity_mm_s=100.0) if take.velocity_mm_s == 150.0 else take
        for take in capture().takes
    )
    found = model_of_recording(replace(capture(), takes=takes))
    assert "presses asked at 100 mm/s were made at 143 mm/s" in found.warnings


def test_vibrations_are_found_by_what_is_passed() -> None:
    buzz = Vibration(Stroke.PRESS, 150.0, 2.1, 0.016, (Mode(239.0, 4.0, 150.0),))
    asked: list[tuple[Recording, Processed]] = []

    def find(recording: Recording, processed: Processed) -> RecordedVibrations:
        asked.append((recording, processed))
        return RecordedVibrations((), (buzz,), ("one was faint",))

    found = model_of_recording(capture(), find_vibrations=find)
    assert found.model.vibrations == (buzz,)
    assert asked == [(capture(), found.processed)]
    assert "one was faint" in found.warnings


def test_vibrations_that_were_not_heard_are_reported() -> None:
    found = recorded()
    heard = {(one.stroke, one.velocity_mm_s) for one in found.vibration.strokes}
    assert heard == {(c.stroke, c.velocity_mm_s) for c in found.processed.curves}
    assert set(found.vibration.warnings) <= set(found.warnings)
    assert len(found.vibration.warnings) + len(found.model.vibrations) == len(heard)


def test_the_fit_is_that_of_the_settings() -> None:
    found = model_of_recording(capture(), fit_settings=FitSettings(control_points=20))
    assert {c.control_points_cN.size for c in found.model.curves} == {20}
    assert "20 control points" in found.model.provenance.method


def test_a_recording_without_presses_is_refused(tmp_path: Path) -> None:
    recording = without(capture(), Stage.PRESS)
    with pytest.raises(ModelError, match="no take with presses"):
        model_of_recording(recording)
    path = tmp_path / f"empty{RECORDING_SUFFIX}"
    save_recording(recording, path)
    with pytest.raises(InputError, match="no take with presses") as caught:
        process_recording(path)
    assert str(caught.value).startswith(f"{path}: recording: ")
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_sixty_presses_of_four_streams_are_a_model_in_five_seconds() -> None:
    recording = capture(((Stage.REST, None, 1), *((Stage.PRESS, v, 15) for v in (50.0, 100.0, 150.0, 200.0))))
    spent = []
    for _ in range(3):
        # processor time: other work on the machine does not count
        start_s = time.process_time()
        model_of_recording(recording)
        spent.append(time.process_time() - start_s)
    assert min(spent) < 5.0


def test_takes_that_are_left_out_are_grouped_by_reason_and_many_are_counted() -> None:
    judged = tuple(
        replace(one, reason=Reason.OFF_PACE if i < 8 else Reason.TWO if i == 8 else None)
        for i, one in enumerate(recorded().processed.judged)
    )
    said = explain_rejections(replace(recorded().processed, judged=judged))
    assert said.startswith("3 of 12 presses averaged")
    assert "far off the pace of the others (takes 4, 5, 6, 7, 8, 9 and 2 more)" in said
    assert "two presses where one was asked for (take 12)" in said


def test_nothing_is_said_of_what_was_not_done() -> None:
    plain = replace(recorded().processed, clock=ClockFit(0.0), probe=None)
    said = method_of(replace(capture(), bench=Bench()), plain)
    assert not any(word in said for word in ("clock", "filter", "play", "probe"))
    assumptions = assumptions_of(replace(capture(), bench=Bench()), Settings(cap_g=2.5))
    assert len(assumptions) == 2
    assert "2.5 g" in assumptions[0]


def test_the_source_names_takes_files_and_who_pressed() -> None:
    recording = replace(capture(), sources=(Source("a.csv", "0" * 64, "motive"),), person="participant B")
    assert source_of(recording) == "15 takes of mx-clear; participant B; a.csv (motive)"
