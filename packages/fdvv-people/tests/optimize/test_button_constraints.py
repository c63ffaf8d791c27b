"""What makes a design a button: the closed forms against the curve itself, and real buttons."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv.units import FloatArray
from fdvv_people.optimize.button_constraints import (
    DEEPEST_SNAP_ratio,
    HEAVIEST_cN,
    button_constraints,
    closing_cN,
    snap_ratio,
)
from fdvv_people.optimize.paper_space import paper_design_like, paper_model, paper_space
from fdvv_people.optimize.space import Design

DESIGNS = paper_space().of_unit(np.random.default_rng(0).random((60, 8)))


def curve_cN(design: Design, depths_mm: FloatArray) -> FloatArray:
    return (
        paper_model(design).of(Stroke.PRESS)[0].force_cN(np.clip(depths_mm, design["x1_mm"], design["x3_mm"]))
    )


def test_the_snap_is_the_largest_fall_of_the_curve_itself() -> None:
    for design in DESIGNS:
        force_cN = curve_cN(design, np.linspace(0.0, 6.2, 2000))
        falls = 1 - force_cN / np.maximum.accumulate(force_cN)
        assert snap_ratio(design) == pytest.approx(falls.max(), abs=1e-3)


def test_the_closing_force_is_the_largest_of_the_curve_up_to_its_contact() -> None:
    for design in DESIGNS:
        force_cN = curve_cN(design, np.linspace(0.0, design["actuation_mm"], 2000))
        assert closing_cN(design) == pytest.approx(force_cN.max(), abs=0.1)


@pytest.mark.parametrize("name", builtin_names())
def test_every_shipped_button_is_a_button(name: str) -> None:
    design = paper_design_like(load_builtin(name))
    assert paper_space(button_constraints()).broken(design) == ()


def test_a_slack_is_zero_at_its_limit() -> None:
    design = {**DESIGNS[0], "y1_cN": HEAVIEST_cN, "y2_cN": HEAVIEST_cN, "actuation_mm": 1.5}
    force, snap = button_constraints()
    assert force.slack({**design, "y3_cN": 40.0}) == pytest.approx(0.0)
    assert force.slack({**design, "y2_cN": HEAVIEST_cN + 30}) < 0
    fallen = HEAVIEST_cN * (1 - DEEPEST_SNAP_ratio)
    assert snap.slack({**design, "y3_cN": fallen}) == pytest.approx(0.0, abs=1e-9)
    assert snap.slack({**design, "y3_cN": fallen - 1}) < 0 < snap.slack({**design, "y3_cN": fallen + 1})
