"""Write every part's STL, STEP and drawing, and the manifest of them all."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

from fdvv.io.files import write_atomic
from fdvv_rig.cad.build import build
from fdvv_rig.cad.files import mesh_of_solid, step_bytes
from fdvv_rig.cad.sheet import sheet
from fdvv_rig.cad.view import views
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.fits import check_fits
from fdvv_rig.manifest import NAME, MadePart, Manifest, fingerprint, manifest_bytes
from fdvv_rig.mesh import stl_bytes
from fdvv_rig.parts import PARTS, Part

FIGURES = 6


def export_parts(
    folder: Path,
    d: Dimensions,
    tell: Callable[[str, int, int], None] = lambda _name, _done, _total: None,
) -> Manifest:
    """Make every part anew and write parts/*.stl, parts/*.step, drawings/*.svg and manifest.json to a folder.

    tell : is called with the part's name and how many of how many are done.
    Equal dimensions give equal bytes. The manifest is written last. Raises BuildError without the CAD
    kernel; InputError where parts do not fit.
    """
    check_fits(d)
    made = {}
    for done, part in enumerate(PARTS):
        tell(part.name, done, len(PARTS))
        made[part.name] = _export(folder, part, d)
    manifest = Manifest(digest=d.digest(), dimensions=dataclasses.asdict(d), parts=made)
    write_atomic(folder / NAME, manifest_bytes(manifest))
    return manifest


def _export(folder: Path, part: Part, d: Dimensions) -> MadePart:
    solid = build(part.name, d)
    files = {
        f"parts/{part.name}.stl": stl_bytes(mesh_of_solid(solid)),
        f"parts/{part.name}.step": step_bytes(solid, part.name),
        f"drawings/{part.name}.svg": sheet(part, views(solid), d).encode(),
    }
    for name, data in files.items():
        write_atomic(folder / name, data)
    size = solid.bounding_box().size
    return MadePart(
        volume_cm3=_figures(solid.volume / 1e3),
        area_cm2=_figures(solid.area / 1e2),
        box_mm=(_figures(size.X), _figures(size.Y), _figures(size.Z)),
        files={name: fingerprint(data) for name, data in files.items()},
    )


def _figures(value: float) -> float:
    return float(f"{value:.{FIGURES}g}")
