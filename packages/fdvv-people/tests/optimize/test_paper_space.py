"""The paper's eight parameters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin, model_from_json, model_to_json
from fdvv_people.optimize.paper_space import PAPER_TRAVEL_mm, paper_design_like, paper_model, paper_space

SPACE = paper_space()
PLACES = st.lists(st.floats(0, 1), min_size=8, max_size=8)


def test_the_ranges_are_those_of_the_paper() -> None:
    low = {one.name: one.low for one in SPACE.parameters}
    high = {one.name: one.high for one in SPACE.parameters}
    assert (low["x1_mm"], low["x2_mm"], low["x3_mm"]) == (0.0, 1.0, 3.0)
    assert high["x1_mm"] < 1.0 <= high["x1_mm"] + 0.01
    assert high["x3_mm"] < 6.2
    assert low["y1_cN"] == pytest.approx(34.5, abs=0.05)
    assert high["y3_cN"] == pytest.approx(310.6, abs=0.05)
    assert (low["actuation_mm"], high["vibration_mm"]) == (0.5, 5.5)


@given(PLACES)
def test_the_force_goes_through_the_three_points_and_holds_outside_them(place: list[float]) -> None:
    (design,) = SPACE.of_unit([place])
    model = paper_model(design)
    x = [design[f"x{i}_mm"] for i in (1, 2, 3)]
    y = [design[f"y{i}_cN"] for i in (1, 2, 3)]
    np.testing.assert_allclose(model.force_cN(x, 50.0), y, rtol=1e-9)
    assert model.force_cN(0.0, 50.0) == pytest.approx(y[0])
    assert model.force_cN(PAPER_TRAVEL_mm, 50.0) == pytest.approx(y[2])


@given(PLACES)
def test_between_its_points_the_force_turns_nowhere(place: list[float]) -> None:
    (design,) = SPACE.of_unit([place])
    model = paper_model(design)
    for a, b in ((1, 2), (2, 3)):
        x = np.linspace(design[f"x{a}_mm"], design[f"x{b}_mm"], 200)
        rise = np.diff(model.force_cN(x, 50.0))
        way = design[f"y{b}_cN"] - design[f"y{a}_cN"]
        assert np.all(rise * np.sign(way) >= -1e-9 * 300)


@given(PLACES)
@settings(max_examples=20)
def test_a_design_is_a_whole_button_that_a_file_holds(place: list[float]) -> None:
    (design,) = SPACE.of_unit([place])
    model = paper_model(design, "mine")
    assert model_from_json(model_to_json(model)) == model
    assert model.actuation_mm == design["actuation_mm"]
    for stroke in Stroke:
        vibration = model.vibration(stroke, 50.0)
        assert vibration is not None
        assert vibration.onset_mm == design["vibration_mm"]
    x = np.linspace(0, PAPER_TRAVEL_mm, 50)
    np.testing.assert_array_equal(model.force_cN(x, 50.0), model.force_cN(x, 200.0, Stroke.RELEASE))


@pytest.mark.parametrize("name", builtin_names())
def test_every_built_in_button_has_a_design_near_it_that_the_space_holds(name: str) -> None:
    space, model = paper_space(), load_builtin(name)
    design = paper_design_like(model)
    assert space.checked(design) == design
    assert not space.broken(design)
    assert design["actuation_mm"] == pytest.approx(model.actuation_mm, abs=0.3)
    x = np.linspace(0.3, model.travel_mm - 0.3, 50)
    near = paper_model(design).force_cN(x, 50.0, Stroke.PRESS)
    wanted = model.force_cN(x, 50.0, Stroke.PRESS)
    middle = paper_model({one.name: (one.low + one.high) / 2 for one in space.parameters})
    far = middle.force_cN(x, 50.0, Stroke.PRESS)
    assert np.mean(np.abs(near - wanted)) < 0.5 * np.mean(np.abs(far - wanted))
