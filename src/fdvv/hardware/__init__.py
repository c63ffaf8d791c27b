"""The rig as things to make and buy: parts, circuit, bill of materials, and which part is wrong."""

from fdvv.hardware._bought import bought_parts
from fdvv.hardware._check import (
    Assembly,
    Clearance,
    Meeting,
    assemble,
    clearances,
    meetings,
    states,
)
from fdvv.hardware._dimension_file import assumed, dimensions_toml, load_dimensions
from fdvv.hardware._dimensions import Dimensions, meaning_of, source_of
from fdvv.hardware._envelope import Block, Envelope, Rod
from fdvv.hardware._exported import FolderCheck, PartCheck, check_exported
from fdvv.hardware._fits import check_fits, misses
from fdvv.hardware._layout import Layout
from fdvv.hardware._limiter import Limiter
from fdvv.hardware._manifest import MadePart, Manifest, read_manifest
from fdvv.hardware._mesh import Mesh, joined, read_stl, stl_bytes
from fdvv.hardware._parts import Made, Part, part_named, printed_parts
from fdvv.hardware._placement import RIG, Moves, State, in_rig, moved, on_bed, on_jig
from fdvv.hardware._pose import Pose
from fdvv.hardware._solids import body_of, body_of_bought, gap_mm, mesh_of, placed, shared_mm3
from fdvv.hardware._tolerance import Cause, Stack, core_stack, tilt_deg, turn_deg

__all__ = [
    "RIG",
    "Assembly",
    "Block",
    "Cause",
    "Clearance",
    "Dimensions",
    "Envelope",
    "FolderCheck",
    "Layout",
    "Limiter",
    "Made",
    "MadePart",
    "Manifest",
    "Meeting",
    "Mesh",
    "Moves",
    "Part",
    "PartCheck",
    "Pose",
    "Rod",
    "Stack",
    "State",
    "assemble",
    "assumed",
    "body_of",
    "body_of_bought",
    "bought_parts",
    "check_exported",
    "check_fits",
    "clearances",
    "core_stack",
    "dimensions_toml",
    "gap_mm",
    "in_rig",
    "joined",
    "load_dimensions",
    "meaning_of",
    "meetings",
    "mesh_of",
    "misses",
    "moved",
    "on_bed",
    "on_jig",
    "part_named",
    "placed",
    "printed_parts",
    "read_manifest",
    "read_stl",
    "shared_mm3",
    "source_of",
    "states",
    "stl_bytes",
    "tilt_deg",
    "turn_deg",
]
