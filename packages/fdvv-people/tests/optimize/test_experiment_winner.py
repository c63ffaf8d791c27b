"""The winner on the simulated rig: rendered, measured afresh, captured back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import DeviceError
from fdvv.model.curve import Stroke
from fdvv.model.press import Press
from fdvv.recording.types import Quantity
from fdvv_people.optimize.experiment.winner import (
    Winner,
    method_curves,
    open_winner_devices,
    recording_of,
    render_winner,
    winners_of,
)
from tests.support.experiments import invented

DESIGN = {
    **{"x1_mm": 0.4, "x2_mm": 2.0, "x3_mm": 4.5, "y1_cN": 60.0, "y2_cN": 110.0, "y3_cN": 80.0},
    **{"actuation_mm": 1.0, "vibration_mm": 1.2},
}


def press(**more: object) -> Press:
    t = np.arange(6.0)
    columns = {"sensed_mm": 0.1 * t, "sensed_cN": 5.0 * t, "tick": t % 2 == 0} | more
    return Press(t, 0.2 * t, 9.0 * t, 100.0, simulated=True, **columns)


def test_a_recording_holds_what_the_sensors_saw_at_their_ticks() -> None:
    recording = recording_of([press(), press()], "winner")
    assert recording.simulated
    assert [take.velocity_mm_s for take in recording.takes] == [100.0, 100.0]
    (force,) = recording.takes[1].of(Quantity.FORCE)
    assert (force.t_s.tolist(), force.values.tolist()) == ([0, 2, 4], [0, 10, 20])
    whole = recording_of([press(tick=None)], "winner").takes[0].of(Quantity.DISPLACEMENT)[0]
    assert whole.values == pytest.approx(0.1 * np.arange(6))


def test_a_device_without_a_force_sensor_cannot_be_captured() -> None:
    with pytest.raises(DeviceError, match="neither displacement nor force"):
        recording_of([press(sensed_cN=None)], "winner")


def test_designs_are_ranked_by_how_they_did_against_the_same_persons_switches() -> None:
    result = invented(-16.0)
    ranked = winners_of(result)
    assert len(ranked) == 16
    ratios = [one.reduction_ratio for one in ranked]
    assert ratios == sorted(ratios, reverse=True)
    best = ranked[0]
    theirs = [o for o in result.observations if (o.person, o.level) == (best.person, best.level)]
    optimal = np.mean([o.asynchrony_ms for o in theirs if o.button == "optimal"])
    switches = np.mean([o.asynchrony_ms for o in theirs if o.button.startswith("mx-")])
    assert best.reduction_ratio == pytest.approx(1 - optimal / switches)


def test_a_design_is_rendered_measured_and_captured_back_near_itself() -> None:
    winner = Winner(0, "easy", DESIGN, 0.2)
    found = render_winner(winner, *open_winner_devices(winner.rendered, 1))
    document = found.to_dict()
    assert document["simulated"] is True
    for errors in (document["probed_mean_error_cN"], document["captured_difference_cN"]):
        assert set(errors) == {"press", "release"}
        # of a button of 60 to 110 cN, on a rig that is not perfect
        assert all(0.2 < error < 6.0 for error in errors.values())
    captured = found.captured.model
    assert captured.provenance.simulated
    assert captured.travel_mm == pytest.approx(6.0, abs=0.1)
    assert captured.force_cN(2.0, 100.0, Stroke.PRESS) == pytest.approx(110.0, abs=6.0)
    curves = method_curves(replace(found, refused=("person 2, hard: no",)))
    assert [len(curve.bands) for curve in curves] == [2, 2]
