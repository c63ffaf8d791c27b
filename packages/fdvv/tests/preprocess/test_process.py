"""From a simulated session, with everything that goes wrong in one, to curves that are known to be right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.preprocess.process import Processed, Settings, process
from fdvv.preprocess.reject import Reason
from fdvv.recording.types import Quantity, Stage
from fdvv.testing.captured import PERFECT_RIG, PERFECT_SENSOR, CapturedSession, captured_session, top_mm
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.finger import Finger, PressVariability


@pytest.fixture(scope="module")
def session() -> CapturedSession:
    return captured_session("mx-clear", 11)


@pytest.fixture(scope="module")
def processed(session: CapturedSession) -> Processed:
    return process(session.recording)


def error_cN(session: CapturedSession, processed: Processed, stroke: Stroke, pace: float) -> float:
    curve = next(c for c in processed.curves if c.stroke is stroke and c.velocity_mm_s == pace)
    inside = curve.displacement_mm > 0.15
    return float(np.sqrt(np.nanmean((curve.force_cN - session.true_cN(curve))[inside] ** 2)))


def test_clocks_are_joined_to_less_than_a_third_of_a_millisecond(
    session: CapturedSession, processed: Processed
) -> None:
    board_s = np.array([take.truth.begin_s for take in session.takes])
    camera_s = session.takes[0].truth.setup.camera_s(board_s)

    assert np.abs(processed.clock.board_s(camera_s) - board_s).max() < 3e-4
    assert processed.clock.doubt_s < 3e-4
    assert processed.clock.edges > 400


def test_travel_and_actuation_are_right(session: CapturedSession, processed: Processed) -> None:
    assert processed.travel_mm.value == pytest.approx(session.travel_mm, abs=0.05)
    assert processed.actuation_mm is not None
    assert processed.actuation_mm.value == pytest.approx(session.true_actuation_mm(), abs=0.05)
    assert processed.reset_mm is not None
    assert processed.reset_mm.value < processed.actuation_mm.value + 0.1


@pytest.mark.parametrize("pace", [50.0, 100.0, 150.0, 200.0])
def test_the_peak_is_right_at_every_pace(session: CapturedSession, processed: Processed, pace: float) -> None:
    curve = next(c for c in processed.curves if c.stroke is Stroke.PRESS and c.velocity_mm_s == pace)
    inside = curve.displacement_mm > 0.15
    x, true_cN = curve.displacement_mm[inside], session.true_cN(curve)[inside]
    wanted, found = find_bump(x, true_cN), find_bump(x, curve.force_cN[inside])

    assert wanted is not None
    assert found is not None
    assert found.peak_cN == pytest.approx(wanted.peak_cN, abs=1.0)
    assert top_mm(x, curve.force_cN[inside]) == pytest.approx(top_mm(x, true_cN), abs=0.05)


@pytest.mark.parametrize("stroke", list(Stroke))
def test_whole_curves_are_near_the_truth(
    session: CapturedSession, processed: Processed, stroke: Stroke
) -> None:
    errors = [error_cN(session, processed, stroke, pace) for pace in (50.0, 100.0, 150.0, 200.0)]

    assert errors[0] < 1.0
    assert max(errors) < 2.5


def test_presses_that_stop_short_are_found_and_no_others(
    session: CapturedSession, processed: Processed
) -> None:
    short = {t.take.number for t in session.of("incomplete")}
    good = {t.take.number for t in session.of("good")}
    found = {one.press.take for one in processed.judged if one.reason is Reason.INCOMPLETE}

    assert short
    assert short <= found
    assert not found & good


def test_good_presses_are_used(session: CapturedSession, processed: Processed) -> None:
    good = {t.take.number for t in session.of("good")}
    used = {one.press.take for one in processed.judged if one.reason is None}

    assert len(good & used) >= 0.97 * len(good)


def test_the_spread_covers_how_presses_differ(processed: Processed) -> None:
    curve = next(c for c in processed.curves if c.stroke is Stroke.PRESS and c.velocity_mm_s == 100.0)

    assert curve.spread_cN.shape == curve.force_cN.shape
    assert 0.3 < np.median(curve.spread_cN) < 3.0


def test_perfect_sensors_give_the_input_back() -> None:
    session = captured_session(
        "mx-clear",
        5,
        PERFECT_RIG,
        PERFECT_SENSOR,
        participant=PARTICIPANTS["steady"],
        paces_mm_s=(50.0, 100.0),
    )

    processed = process(session.recording)

    assert max(error_cN(session, processed, stroke, 50.0) for stroke in Stroke) < 0.5
    assert max(error_cN(session, processed, stroke, 100.0) for stroke in Stroke) < 0.6
    assert processed.travel_mm.value == pytest.approx(session.travel_mm, abs=0.02)


@pytest.mark.slow
def test_without_a_probe_the_slowest_pace_leads() -> None:
    session = captured_session("mx-clear", 7, probe=False)

    processed = process(session.recording)

    assert processed.probe is None
    assert error_cN(session, processed, Stroke.PRESS, 50.0) < 2.0
    assert len(processed.curves) == 8


def test_a_button_without_a_bump_gets_none() -> None:
    session = captured_session("mx-red", 3, paces_mm_s=(100.0,))

    curve = process(session.recording).curves[0]

    inside = curve.displacement_mm > 0.3
    assert find_bump(curve.displacement_mm[inside], curve.force_cN[inside]) is None


def test_a_finger_that_comes_from_above_has_no_rest_to_take_off() -> None:
    finger = Finger(habit=PressVariability(lift_m=0.002))
    session = captured_session("mx-clear", 3, finger=finger, paces_mm_s=(50.0,))

    assert process(session.recording).zero_mm < 0.01


@pytest.mark.slow
def test_the_wrong_mass_of_the_cap_hardly_matters(session: CapturedSession, processed: Processed) -> None:
    heavier = process(session.recording, Settings(cap_g=4.2))

    for before, after in zip(processed.curves, heavier.curves, strict=True):
        inside = (before.displacement_mm > 0.3) & (before.displacement_mm < 3.4)
        x = before.displacement_mm[inside]
        change = np.interp(x, after.displacement_mm, after.force_cN) - before.force_cN[inside]
        assert np.sqrt(np.mean(change**2)) < 1.0


@pytest.mark.parametrize(
    ("keep", "reason"),
    [
        ({Quantity.MARKER, Quantity.LIGHT}, "no take with presses and a force stream"),
        ({Quantity.FORCE, Quantity.LIGHT}, "no stream that shows displacement"),
        ({Quantity.FORCE, Quantity.MARKER}, "no stream shows the light"),
    ],
)
def test_what_is_missing_is_reported(session: CapturedSession, keep: set[Quantity], reason: str) -> None:
    presses = [t for t in session.recording.takes if t.stage is Stage.PRESS and t.number < 12]
    takes = [
        replace(t, number=i, streams=tuple(s for s in t.streams if s.quantity in keep))
        for i, t in enumerate(presses, 1)
    ]

    with pytest.raises(ModelError, match=reason):
        process(replace(session.recording, takes=tuple(takes)))


def test_too_few_presses_are_reported(session: CapturedSession) -> None:
    few = replace(session.recording, takes=session.recording.takes[:4])

    with pytest.raises(ModelError, match="fewer than 3 presses of any pace"):
        process(few)
