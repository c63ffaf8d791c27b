"""A run of designs for a rig: it carries the rig with it, and suggests nothing that it cannot render."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, model_space_setup

CLEAR = load_builtin("mx-clear")


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
