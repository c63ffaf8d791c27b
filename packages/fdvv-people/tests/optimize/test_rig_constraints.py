"""Designs that a rig cannot render are known before a trial."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.rendering.feasibility import feasibility
from fdvv.rendering.rig_catalog import AvailableRig, RigCatalog
from fdvv_people.optimize.model_space import model_of, model_space
from fdvv_people.optimize.rig_constraints import rig_constraints
from fdvv_people.optimize.space import DesignSpace

CLEAR = load_builtin("mx-clear")
HARD = model_space(CLEAR, ["force_ratio", "snap_mm"], {"force_ratio": (0.5, 16.0)})


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> AvailableRig:
    return RigCatalog(tmp_path_factory.mktemp("project")).rig("shipped:voltage")


def held(rig: AvailableRig) -> DesignSpace:
    limits = rig_constraints(rig, lambda design: model_of(CLEAR, design))
    return DesignSpace("held", HARD.parameters, limits)


def test_a_rig_bears_the_button_and_not_one_with_far_too_much_force(rig: AvailableRig) -> None:
    space = held(rig)
    assert space.broken({"force_ratio": 1.0, "snap_mm": 0.5}) == ()
    broken = space.broken({"force_ratio": 16.0, "snap_mm": 0.5})
    assert "shipped:voltage" in broken[0].text


def test_slacks_are_those_of_a_report(rig: AvailableRig) -> None:
    design = {"force_ratio": 1.5, "snap_mm": 0.3}
    report = feasibility(model_of(CLEAR, design), rig.known, rig.settings, [100.0], info=rig.info)
    ratios = [c.reached.missed_cN / np.abs(c.reached.intended_cN).mean() for c in report.curves]
    force, stability = held(rig).constraints
    kept = min(c.reached.kept_ratio or 1.0 for c in report.curves)
    assert force.slack(design) == pytest.approx(min(0.25 - max(ratios), kept - 0.5))
    assert stability.slack(design) == pytest.approx(min(c.stable.margin for c in report.curves) - 0.5)


def test_slack_falls_all_the_way_as_the_force_grows(rig: AvailableRig) -> None:
    force = held(rig).constraints[0]
    slack = np.array([force.slack({"force_ratio": r, "snap_mm": 0.5}) for r in np.linspace(4.0, 16.0, 13)])
    assert slack[0] > 0 > slack[-1]
    assert np.diff(slack).max() < 1e-5
