"""Designs that a rig cannot render are known before a trial, and a run suggests none of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.rendering.feasibility import feasibility
from fdvv.rendering.rig_catalog import AvailableRig, RigCatalog
from fdvv_people.optimize.model_space import model_of, model_space
from fdvv_people.optimize.rig_constraints import rig_constraints
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, model_space_setup
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
    ratios = [c.reached.shortfall_cN / np.abs(c.reached.intended_cN).mean() for c in report.curves]
    force, stability = held(rig).constraints
    kept = min(c.reached.kept_ratio or 1.0 for c in report.curves)
    assert force.slack(design) == pytest.approx(min(0.25 - max(ratios), kept - 0.5))
    assert stability.slack(design) == pytest.approx(min(c.stable.margin for c in report.curves) - 0.5)


def test_slack_falls_all_the_way_as_the_force_grows(rig: AvailableRig) -> None:
    force = held(rig).constraints[0]
    slack = np.array([force.slack({"force_ratio": r, "snap_mm": 0.5}) for r in np.linspace(4.0, 16.0, 13)])
    assert slack[0] > 0 > slack[-1]
    assert np.diff(slack).max() < 1e-5


def test_a_run_carries_its_button_and_its_rig_with_it(tmp_path: Path) -> None:
    project = tmp_path / "project"
    RigCatalog(project).rig("shipped:voltage")
    space = model_space_setup(
        CLEAR, ["force_ratio", "snap_mm"], {"force_ratio": (0.5, 16.0)}, "shipped:voltage"
    )
    setup = OptimizeSetup(engine="sobol", space=space, budget=3)
    Optimization.create(tmp_path / "run", setup, project).close()
    assert [path.name for path in (tmp_path / "run" / "rigs").iterdir()] == ["voltage.simulated.rig.json"]
    with Optimization.open(tmp_path / "run") as session:
        for trial in session.ask(3):
            assert not session.space.broken(trial.design)
            assert session.model(trial.design).actuation_mm == CLEAR.actuation_mm
        with pytest.raises(InputError, match="does not hold"):
            session.edit(0, {"force_ratio": 16.0, "snap_mm": 0.5})
