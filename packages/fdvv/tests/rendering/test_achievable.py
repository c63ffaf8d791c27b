"""What the editor shows of a rig's limits while a curve is being drawn. Simulated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.compensation.identification.rig_file import load_learned_rig, save_rig
from fdvv.errors import DeviceError, InputError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.rendering.feasibility import feasibility
from fdvv.rendering.rig_catalog import AvailableRig, RigCatalog, achievable, ranges_at_limit


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("project")


@pytest.fixture(scope="module")
def light(project: Path) -> AvailableRig:
    return RigCatalog(project).rig("shipped:light")


def raised(model: FDVVModel, by_cN: float) -> FDVVModel:
    def lifted(c: ForceCurve) -> ForceCurve:
        return replace(c, control_points_cN=c.control_points_cN + by_cN, spread=None)

    return replace(model, curves=tuple(map(lifted, model.curves)))


def test_a_shipped_rig_is_met_once_and_kept_in_the_project(project: Path, light: AvailableRig) -> None:
    kept = project / "rigs" / "light.simulated.rig.json"
    assert load_learned_rig(kept).rig == light.known
    written = kept.stat().st_mtime_ns
    again = RigCatalog(project)
    assert again.rig("shipped:light").known == light.known
    assert kept.stat().st_mtime_ns == written
    assert [(e.rig_id, e.known) for e in again.entries()] == [
        ("shipped:recommended", False),
        ("shipped:light", True),
        ("shipped:paper", False),
        ("shipped:voltage", False),
    ]
    assert light.entry.simulated


def test_a_rig_is_found_by_its_old_name_in_projects_of_earlier_versions(
    tmp_path: Path, light: AvailableRig
) -> None:
    # "voltage" was called "default"; what it once taught is in a file of that name
    old = tmp_path / "rigs" / "default.simulated.rig.json"
    save_rig(light.known, old)
    catalog = RigCatalog(tmp_path)
    assert {e.rig_id: e.known for e in catalog.entries()}["shipped:voltage"]
    found = catalog.rig("shipped:default")
    assert (found.known, found.entry.rig_id) == (light.known, "shipped:voltage")
    catalog.lend("shipped:default", tmp_path / "run")
    lent = RigCatalog(tmp_path / "run").rig("shipped:default")
    assert lent.known == light.known


def test_a_file_of_a_person_is_on_the_shelf_and_not_called_simulated(
    tmp_path: Path, light: AvailableRig
) -> None:
    save_rig(light.known, tmp_path / "rigs" / "bench.rig.json")
    shelf = RigCatalog(tmp_path)
    assert [e.rig_id for e in shelf.entries()][-1] == "own:bench"
    found = shelf.rig("own:bench")
    assert found.known == light.known
    assert not found.entry.simulated


@pytest.mark.parametrize("rig_id", ["own:../rigs/light", "shipped:heavy", "", "own:light.simulated"])
def test_an_unknown_rig_is_refused_with_those_there_are(project: Path, rig_id: str) -> None:
    with pytest.raises(
        InputError, match="choose one of shipped:recommended, shipped:light, shipped:paper, shipped:voltage"
    ):
        RigCatalog(project).rig(rig_id)


@pytest.mark.parametrize("speed_mm_s", [0.5, 50.0, 200.0])
def test_the_curves_are_those_of_the_feasibility_report(light: AvailableRig, speed_mm_s: float) -> None:
    model = load_builtin("mx-clear")
    curves = achievable(model, light, [speed_mm_s])
    full = feasibility(model, light.known, light.settings, [speed_mm_s], info=light.info).curves
    assert [c.stroke for c in curves] == list(Stroke)
    for curve, of in zip(curves, full, strict=True):
        reached = curve.reached
        # in fewer steps of time, a tenth of a centinewton is nothing on a screen
        np.testing.assert_allclose(reached.achievable_cN, of.reached.achievable_cN, atol=0.1)
        np.testing.assert_allclose(
            reached.intended_cN, model.force_cN(reached.displacement_mm, speed_mm_s, curve.stroke), atol=0.05
        )
        assert curve.verdict == of.verdict
        assert curve.expected.mean_cN == pytest.approx(of.expected.mean_cN, abs=0.05)


def test_a_force_beyond_the_limit_is_marked_where_it_is_cut_and_said(light: AvailableRig) -> None:
    strong = raised(load_builtin("mx-clear"), 600.0)
    first = achievable(strong, light, [50.0])[0]
    verdict, press = first.verdict, first.reached
    cut = [r for r in ranges_at_limit(press) if r.limit == "force"]
    assert cut
    assert verdict.following == "cannot"
    assert verdict.reasons
    inside = np.zeros(press.displacement_mm.size, dtype=bool)
    for part in cut:
        inside |= (press.displacement_mm >= part.start_mm) & (press.displacement_mm <= part.end_mm)
    missing = press.intended_cN - press.achievable_cN
    assert missing[inside].min() > 0
    assert ranges_at_limit(achievable(load_builtin("mx-clear"), light, [50.0])[0].reached) == []


def test_a_curve_of_unknown_velocity_is_judged_at_50_mm_s_and_speeds_are_listed_once(
    light: AvailableRig,
) -> None:
    curves = achievable(load_builtin("mx-red"), light, [None, 50.0])
    assert [(c.stroke, c.velocity_mm_s) for c in curves] == [(Stroke.PRESS, 50.0), (Stroke.RELEASE, 50.0)]


def test_an_identification_ends_with_its_next_press_when_the_catalog_is_closed(tmp_path: Path) -> None:
    catalog = RigCatalog(tmp_path)
    catalog.close()
    with pytest.raises(DeviceError, match="the studio was closed meanwhile"):
        catalog.rig("shipped:light")
    assert not list(tmp_path.iterdir())
