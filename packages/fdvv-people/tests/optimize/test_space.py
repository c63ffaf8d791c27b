"""Spaces of designs."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.space import Constraint, DesignSpace, Parameter

SPACE = DesignSpace(
    "two points",
    (Parameter("x1_mm", 0.0, 1.0), Parameter("y1_cN", 20.0, 180.0)),
    (Constraint("heavy", "y1 stays below 100 cN", lambda d: 100.0 - d["y1_cN"]),),
)


@given(st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=1, max_size=5))
def test_unit_cube_and_designs_are_the_same_places(rows: list[tuple[float, float]]) -> None:
    designs = SPACE.of_unit(np.array(rows))
    np.testing.assert_allclose(SPACE.to_unit(designs), rows, atol=1e-12)
    assert all(SPACE.checked(design) == design for design in designs)


def test_what_lies_outside_the_cube_is_brought_to_the_nearest_bound() -> None:
    assert SPACE.of_unit([-1.0, 2.0]) == [{"x1_mm": 0.0, "y1_cN": 180.0}]


@pytest.mark.parametrize(
    ("design", "place"),
    [
        ({"x1_mm": 0.5}, "y1_cN"),
        ({"x1_mm": 0.5, "y1_cN": 19.0}, "y1_cN"),
        ({"x1_mm": float("nan"), "y1_cN": 20.0}, "x1_mm"),
        ({"x1_mm": 0.5, "y1_cN": 20.0, "z": 1.0}, "z"),
    ],
)
def test_a_design_that_does_not_belong_is_refused_by_its_parameter(
    design: dict[str, float], place: str
) -> None:
    with pytest.raises(InputError) as caught:
        SPACE.checked(design)
    assert caught.value.place == place


def test_constraints_are_known_before_a_trial() -> None:
    assert [one.name for one in SPACE.broken({"x1_mm": 0.5, "y1_cN": 120.0})] == ["heavy"]
    assert SPACE.broken({"x1_mm": 0.5, "y1_cN": 100.0}) == ()


def test_a_space_has_parameters_of_different_names() -> None:
    one = Parameter("a_mm", 0, 1)
    for parameters in ((), (one, one)):
        with pytest.raises(ModelError):
            DesignSpace("none", parameters)
