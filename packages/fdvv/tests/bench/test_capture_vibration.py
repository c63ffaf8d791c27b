"""Vibrations of recordings: what is found is true, what is not is said once, and nothing is made up."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from fdvv.bench.model import model_of_recording
from fdvv.bench.vibration import RecordedVibrations, StrokeVibration, find_vibrations, missing_words
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Vibration
from fdvv.preprocess.process import Processed, process
from fdvv.recording.types import Quantity, Recording
from fdvv.testing.captured import CapturedSession, captured_session
from fdvv.vibration.snap import NotFound

FREQUENCY_Hz, LASTS_s = 237.8, math.log(10) / (2 * math.pi * 23.9)
"""Of the plate's first mode as it rings."""


@functools.cache
def session(
    name: str = "mx-brown", presses: int = 5, paces: tuple[float, ...] = (50.0, 100.0, 200.0), seed: int = 300
) -> tuple[CapturedSession, Processed, RecordedVibrations]:
    made = captured_session(name, seed, presses=presses, paces_mm_s=paces)
    processed = process(made.recording)
    return made, processed, find_vibrations(made.recording, processed)


def without(recording: Recording, quantity: Quantity, pace_mm_s: float | None = None) -> Recording:
    """Leave out what shows a quantity, at one pace or at all."""
    takes = tuple(
        replace(take, streams=tuple(s for s in take.streams if s.quantity is not quantity))
        if pace_mm_s in (None, take.velocity_mm_s)
        else take
        for take in recording.takes
    )
    return replace(recording, takes=takes)


def pressed(recorded: RecordedVibrations) -> list[Vibration]:
    return [v for v in recorded.vibrations if v.stroke is Stroke.PRESS]


def check_truth(made: CapturedSession, recorded: RecordedVibrations, vibration: Vibration) -> None:
    strokes = next(
        h
        for h in recorded.strokes
        if h.stroke is vibration.stroke and h.velocity_mm_s == vibration.velocity_mm_s
    )
    traces = [t.truth.trace for t in made.of("good", vibration.velocity_mm_s)]
    true_mm = np.median(
        [np.interp(t.closing_s, t.t_s, t.displacement_mm) for t in traces if t and t.closing_s is not None]
    )
    late_s = (vibration.onset_mm - true_mm) / strokes.report()["snap_velocity_mm_s"]
    assert late_s == pytest.approx(0.0, abs=1e-3)
    assert vibration.modes[0].frequency_Hz == pytest.approx(FREQUENCY_Hz, rel=0.05)
    assert vibration.duration_s == pytest.approx(LASTS_s, rel=0.10)


def test_onset_frequency_and_duration_are_true_at_every_speed_where_they_are_reported() -> None:
    made, _, recorded = session()
    assert [v.velocity_mm_s for v in pressed(recorded)] == [50.0, 100.0, 200.0]
    for vibration in pressed(recorded):
        check_truth(made, recorded, vibration)


def test_every_figure_has_a_spread_over_presses_and_presses_are_counted() -> None:
    _, _, recorded = session()
    for vibration in pressed(recorded):
        spread = vibration.spread
        assert spread is not None
        assert 3 <= spread.presses <= 5
        assert spread.onset_mm is not None
        assert 0 < spread.onset_mm < 0.2
        assert spread.duration_s is not None
        assert 0 < spread.duration_s < vibration.duration_s
        first = spread.modes[0]
        assert first.frequency_Hz is not None
        assert 0 < first.frequency_Hz < 0.2 * FREQUENCY_Hz
        assert first.amplitude_m_s2 is not None
        assert first.amplitude_m_s2 > 0
        assert len(spread.modes) == len(vibration.modes)


def test_every_mode_lies_in_the_band_and_falls_within_a_snap() -> None:
    _, _, recorded = session()
    for vibration in recorded.vibrations:
        assert vibration.duration_s <= 0.025
        for mode in vibration.modes:
            assert 40 < mode.frequency_Hz < 4000
            assert mode.decay_1_s > 0


def test_the_model_says_that_the_housing_was_heard_and_what_its_paces_share() -> None:
    made, _, recorded = session()
    model = model_of_recording(made.recording).model
    assert model.vibrations == recorded.vibrations
    assert any("sat on the housing" in line for line in model.provenance.assumptions)
    assert any("rings alike at every pace" in line for line in model.provenance.assumptions)


def test_a_law_over_speed_has_its_exponent_and_fills_a_missing_pace_only_if_asked() -> None:
    made, processed, recorded = session()
    (law,) = [s for s in recorded.scalings if s.stroke is Stroke.PRESS]
    assert law.report()["exponent_error"] is not None
    assert law.scaling.exponent > 0
    recording = without(made.recording, Quantity.ACCELERATION, 100.0)
    left = find_vibrations(recording, processed)
    assert [v.velocity_mm_s for v in pressed(left)] == [50.0, 200.0]
    assert any("--extrapolate-vibration" in line for line in left.warnings)
    assert not any("scaled" in line for line in left.assumptions)
    asked = find_vibrations(recording, processed, extrapolate=True)
    assert [v.velocity_mm_s for v in pressed(asked)] == [50.0, 100.0, 200.0]
    slow, scaled, fast = (v.modes[0].amplitude_m_s2 for v in pressed(asked))
    assert min(slow, fast) < scaled < max(slow, fast)
    assert pressed(asked)[1].spread is None
    assert any("press at 100 mm/s was not found but scaled" in line for line in asked.assumptions)


def test_a_linear_button_has_no_vibration_and_the_reason_is_said_once() -> None:
    _, processed, recorded = session("mx-red", 4)
    paces = ", ".join(f"{c.velocity_mm_s:g}" for c in processed.curves if c.stroke is Stroke.PRESS)
    assert recorded.vibrations == ()
    (warning,) = recorded.warnings
    assert warning.startswith(f"no vibration on the press and release at {paces} mm/s: force does not fall")


def test_the_microphone_alone_tells_none_and_why() -> None:
    made, processed, _ = session()
    recorded = find_vibrations(without(made.recording, Quantity.ACCELERATION), processed)
    assert recorded.vibrations == ()
    assert {(h.stroke, h.velocity_mm_s) for h in recorded.strokes} == {
        (c.stroke, c.velocity_mm_s) for c in processed.curves
    }
    assert all(h.reason for h in recorded.strokes)
    assert 1 <= len(recorded.warnings) <= len(recorded.strokes)


def test_without_anything_that_listened_that_is_said_once() -> None:
    made, processed, _ = session()
    deaf = without(without(made.recording, Quantity.ACCELERATION), Quantity.SOUND)
    recorded = find_vibrations(deaf, processed)
    assert (recorded.vibrations, recorded.strokes) == ((), ())
    assert recorded.warnings == ("no vibration: nothing listened, neither microphone nor accelerometer",)


def test_reasons_are_said_with_their_strokes_and_paces() -> None:
    def strokes(stroke: Stroke, pace_mm_s: float | None) -> StrokeVibration:
        return StrokeVibration(stroke, pace_mm_s, 100.0, NotFound("of its own"))

    press, release = Stroke.PRESS, Stroke.RELEASE
    pairs = [(strokes(press, 50.0), "one"), (strokes(release, 50.0), "one"), (strokes(release, None), "one")]
    assert missing_words([*pairs, (strokes(press, 150.0), "two")]) == [
        "no vibration on the press at 50 mm/s and release at 50, unknown mm/s: one",
        "no vibration on the press at 150 mm/s: two",
    ]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["mx-brown", "mx-clear"])
def test_a_whole_session_is_true_at_every_pace(name: str) -> None:
    made, _, recorded = session(name, 15, (50.0, 100.0, 150.0, 200.0), 301)
    assert len(pressed(recorded)) >= 3
    for vibration in pressed(recorded):
        check_truth(made, recorded, vibration)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["mx-red", "mx-black"])
def test_nothing_is_invented_on_linear_buttons(name: str) -> None:
    _, _, recorded = session(name, 15, (50.0, 100.0, 150.0, 200.0), 301)
    assert recorded.vibrations == ()
    assert len(recorded.warnings) == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hp-pr1101u", "macbook-pro-2011"])
def test_what_a_dome_is_heard_with_is_known_and_in_the_band(name: str) -> None:
    _, _, recorded = session(name, 15, (50.0, 100.0, 150.0, 200.0), 301)
    assert all(h.reason or h.report()["modes"] for h in recorded.strokes)
    for vibration in recorded.vibrations:
        assert vibration.duration_s <= 0.025
        assert all(40 < mode.frequency_Hz < 4000 for mode in vibration.modes)
