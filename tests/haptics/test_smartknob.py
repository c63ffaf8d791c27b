"""Detents of a SmartKnob snap and return where the button does, by the knob's own law."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv_haptics.smartknob import KnobDetents, knob_detents, smartknob


def _snapped(detents: KnobDetents, way: list[float]) -> list[float]:
    """Turn a knob as its firmware does; return where the position changes (independent of ours).

    way : places from released (0) to pressed (1) and back; the firmware's angle rises to lower positions.
    """
    width, position = detents.position_width_radians, detents.position
    sign = 1 if position == 0 else -1
    centre, changes = 0.0, []
    for place in way:
        off = -sign * place * width - centre
        bias = width * detents.snap_point_bias
        down = width * detents.snap_point + (bias if position <= 0 else -bias)
        up = -width * detents.snap_point + (-bias if position >= 0 else bias)
        if off > down and position > detents.min_position:
            centre, position = centre + width, position - 1
            changes.append(place)
        elif off < up and position < detents.max_position:
            centre, position = centre - width, position + 1
            changes.append(place)
    return changes


WAY = [i / 2000 for i in range(2001)]


@pytest.mark.parametrize("name", ["mx-blue", "mx-brown", "mx-clear", "rubber-dome"])
def test_the_firmwares_law_snaps_at_the_peak_and_returns_at_the_releases(name: str) -> None:
    model = load_builtin(name)
    detents = knob_detents(model)
    press, release = (model.nearest(stroke) for stroke in Stroke)
    assert press is not None
    assert release is not None
    x = np.arange(0, model.travel_mm, 0.005)
    peak, back = find_bump(x, press.force_cN(x)), find_bump(x, release.force_cN(x))
    assert peak is not None
    assert back is not None
    out, home = _snapped(detents, WAY + WAY[::-1])
    assert out * model.travel_mm == pytest.approx(peak.peak_mm, abs=0.01)
    assert home * model.travel_mm == pytest.approx(min(back.peak_mm, peak.peak_mm), abs=0.01)


@settings(max_examples=25, deadline=None)
@given(peak=st.floats(0.3, 3.7), back=st.floats(0.3, 3.7), fall=st.floats(6, 60))
def test_every_field_stays_within_what_the_firmware_takes(peak: float, back: float, fall: float) -> None:
    def hill(stroke: Stroke, at: float) -> ForceCurve:
        knots = np.array([0, 0, at, at + 0.2, 4, 4])
        return ForceCurve(stroke, None, 1, knots, np.array([0, 80, 80 - fall, 90]))

    model = FDVVModel("drawn", 4.0, (hill(Stroke.PRESS, peak), hill(Stroke.RELEASE, back)))
    detents = knob_detents(model)
    assert detents.snap_point >= 0.5
    assert detents.snap_point_bias >= 0
    assert 0 < detents.detent_strength_unit <= 1
    out, home = _snapped(detents, WAY + WAY[::-1])
    assert home <= out


@pytest.mark.parametrize("name", ["mx-red", "mx-black"])
def test_a_button_without_a_snap_has_one_position_and_a_spring(name: str) -> None:
    made = smartknob(load_builtin(name))
    fields = json.loads(made.text)
    assert (fields["min_position"], fields["max_position"]) == (0, 0)
    assert fields["detent_strength_unit"] == 0
    assert made.figures["snap_mm"] is None
    assert (made.figures["explained_ratio"] or 0) > 0.9


def test_the_file_has_the_fields_of_the_knobs_definition() -> None:
    made = smartknob(load_builtin("mx-blue"), degrees_per_mm=15)
    fields = json.loads(made.text)
    assert list(fields) == [
        "position",
        "min_position",
        "max_position",
        "position_width_radians",
        "detent_strength_unit",
        "endstop_strength_unit",
        "snap_point",
        "text",
        "snap_point_bias",
    ]
    assert fields["position_width_radians"] == pytest.approx(math.radians(15) * 3.865)
    assert "vibrations" not in made.lost
    assert "vibrations" in smartknob(load_builtin("mx-clear")).lost


def test_the_knob_pulls_back_before_the_snap_and_on_after_it() -> None:
    detents = knob_detents(load_builtin("mx-blue"))
    places = detents.snaps_at_ratio
    assert places is not None
    before, after = (float(detents.pull(np.array(places[0]), pressed)) for pressed in (False, True))
    assert before > 0 > after
    assert float(detents.pull(np.array(0.0), False)) == 0


def test_the_text_is_cut_to_fifty_bytes_between_letters() -> None:
    made = json.loads(smartknob(load_builtin("mx-red").renamed("ö" * 40)).text)
    assert made["text"] == "ö" * 25


def test_a_scale_of_nothing_is_refused() -> None:
    with pytest.raises(ModelError, match="degrees_per_mm must be positive"):
        smartknob(load_builtin("mx-red"), degrees_per_mm=0)
    whole = load_builtin("mx-red")
    with pytest.raises(ModelError, match="no press curve"):
        knob_detents(FDVVModel("back", 4.0, whole.of("release")))
