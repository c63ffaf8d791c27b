"""Look at a folder of exported parts without the CAD kernel: is it whole, and does it go together?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv_rig.check import Clearance, Meeting, assemble, clearances, meetings, states
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.manifest import REMEDY, MadePart, Manifest, fingerprint, read_manifest
from fdvv_rig.mesh import LARGEST_BYTES, Mesh, read_stl
from fdvv_rig.parts import PARTS

VOLUME_ratio = 0.01
"""How far facets may make a part's volume differ from its solid's."""

BED_mm = 1e-3
"""How far a part's lowest face may be from the bed."""

Tell = Callable[[str, int, int], None]


@dataclass(frozen=True)
class PartCheck:
    """What was found of one exported part; every entry of wrong is a sentence."""

    name: str
    volume_cm3: float
    box_mm: tuple[float, float, float]
    open_edges: int
    wrong: tuple[str, ...]


@dataclass(frozen=True)
class FolderCheck:
    """What was found of a folder of exported parts.

    clearances : the smallest gap of each pair that moves against each other.
    """

    dimensions: Dimensions
    parts: tuple[PartCheck, ...]
    meetings: tuple[Meeting, ...]
    clearances: tuple[Clearance, ...]

    @property
    def good(self) -> bool:
        """Return whether every part is whole and none meets another."""
        return not self.meetings and not any(part.wrong for part in self.parts)


def check_exported(folder: Path | str, tell: Tell = lambda _label, _done, _total: None) -> FolderCheck:
    """Check exported parts and how they go together, with the dimensions that their manifest tells.

    tell : is called with what is being done, and how much of it.
    Raises InputError where the folder cannot be read; BuildError without manifold3d.
    """
    manifest = read_manifest(folder)
    d = manifest.made_from()
    meshes, parts = {}, []
    for done, part in enumerate(PARTS):
        tell("reading parts", done, len(PARTS))
        meshes[part.name] = read_stl(Path(folder) / "parts" / f"{part.name}.stl")
        parts.append(_checked(Path(folder), manifest, part.name, meshes[part.name], d))
    if any(part.open_edges or part.volume_cm3 <= 0 for part in parts):
        return FolderCheck(d, tuple(parts), (), ())
    assembly, found = assemble(meshes, d), []
    todo = list(states(d))
    for done, state in enumerate(todo):
        tell("looking for parts that meet", done, len(todo))
        found += meetings(assembly, state)
    # the other cap: where it is highest and lowest
    with_cell = assemble(meshes, d, cell=True)
    found += [met for state in (todo[0], todo[-1]) for met in meetings(with_cell, state) if met not in found]
    gaps = clearances(assembly, lambda done, total: tell("measuring clearances", done, total))
    return FolderCheck(d, tuple(parts), tuple(found), tuple(gaps))


def _checked(folder: Path, manifest: Manifest, name: str, mesh: Mesh, d: Dimensions) -> PartCheck:
    if name not in manifest.parts:
        raise InputError(folder / "manifest.json", f"$.parts.{name}", "is missing", REMEDY)
    made = manifest.parts[name]
    low, high = mesh.box_mm
    size = (float(high[0] - low[0]), float(high[1] - low[1]), float(high[2] - low[2]))
    wrong = [*_changed(folder, made), *_shape(mesh, made)]
    if abs(low[2]) > BED_mm:
        wrong.append(f"its lowest face is {low[2]:.3f} mm from the bed")
    if max(size[:2]) > d.bed_width_mm or size[2] > d.bed_height_mm:
        wrong.append(f"{size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} mm is more than the printer takes")
    if manifest.digest != d.digest():
        wrong.append("its manifest's dimensions were changed after the export")
    return PartCheck(name, mesh.volume_cm3, size, mesh.open_edges(), tuple(wrong))


def _changed(folder: Path, made: MadePart) -> list[str]:
    return [
        f"{name} is not the file that was exported"
        for name, wanted in made.files.items()
        if fingerprint(read_limited(folder / name, LARGEST_BYTES, REMEDY)) != wanted
    ]


def _shape(mesh: Mesh, made: MadePart) -> list[str]:
    wrong = []
    if edges := mesh.open_edges():
        wrong.append(f"its surface is open at {edges} edges")
    if not abs(mesh.volume_cm3 - made.volume_cm3) <= VOLUME_ratio * made.volume_cm3:
        wrong.append(f"its surface holds {mesh.volume_cm3:.2f} cm³, its solid {made.volume_cm3:.2f}")
    return wrong
