"""With the CAD kernel: exports are the same bytes again, and other dimensions still go together."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings

from fdvv_rig.check import assemble, meetings
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.manifest import read_manifest
from fdvv_rig.parts import PARTS
from fdvv_rig.placement import RIG, State
from tests.hardware.legal import legal_dimensions

pytest.importorskip("build123d", reason="the CAD kernel is not installed (fdvv-rig[cad])")
pytest.importorskip("manifold3d", reason="manifold3d is not installed")

HARDWARE = Path(__file__).resolve().parents[2] / "hardware"
KERNEL_WARNINGS = pytest.mark.filterwarnings("ignore")
"""The kernel's own libraries deprecate things of each other."""


@pytest.mark.slow
@KERNEL_WARNINGS
def test_exports_made_again_are_the_same_bytes(tmp_path: Path) -> None:
    from fdvv_rig.cad.export import export_parts

    export_parts(tmp_path, Dimensions())
    for made in read_manifest(HARDWARE).parts.values():
        for name in made.files:
            assert (tmp_path / name).read_bytes() == (HARDWARE / name).read_bytes(), name
    assert (tmp_path / "manifest.json").read_bytes() == (HARDWARE / "manifest.json").read_bytes()


@pytest.mark.slow
@KERNEL_WARNINGS
@settings(
    max_examples=3,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    phases=[Phase.generate],  # to shrink is to make every part again, many times
)
@given(legal_dimensions)
def test_parts_of_random_legal_dimensions_are_whole_and_go_together(d: Dimensions) -> None:
    from fdvv_rig.cad.build import build
    from fdvv_rig.cad.files import mesh_of_solid

    meshes = {}
    for name in RIG:
        solid = build(name, d)
        assert len(solid.solids()) == 1, name
        meshes[name] = mesh_of_solid(solid)
        assert meshes[name].open_edges() == 0, name
        assert meshes[name].box_mm[0][2] == pytest.approx(0.0, abs=1e-3), name
    rig = assemble(meshes, d)
    for share in (0.0, 1.0):
        stop_mm = max(share * d.travel_mm, 0.05)
        assert meetings(rig, State(stop_mm - 0.03, stop_mm)) == []


@KERNEL_WARNINGS
@pytest.mark.slow
def test_every_part_has_a_builder() -> None:
    from fdvv_rig.cad.build import BUILDERS

    assert set(BUILDERS) == {part.name for part in PARTS}
