"""The rig as things to make and buy: parts, circuit, bill of materials, and which part is wrong."""

from fdvv.hardware._bill import PAPER_USD, Bill, BillLine, group_totals, load_bill, read_bill, to_csv
from fdvv.hardware._bill_page import bill_page, summary
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
from fdvv.hardware._circuit import Circuit, Component, Filter, Kind, Pin, Sheet
from fdvv.hardware._circuit_file import load_circuit, read_circuit
from fdvv.hardware._circuit_report import circuit_files, circuit_report, values_page, wiring_page
from fdvv.hardware._diagnosis import Bounds, Diagnosis, Finding, Verdict, diagnose
from fdvv.hardware._diagram import sheet_svgs
from fdvv.hardware._dimension_file import assumed, dimensions_toml, load_dimensions
from fdvv.hardware._dimensions import Dimensions, meaning_of, source_of
from fdvv.hardware._envelope import Block, Envelope, Rod
from fdvv.hardware._evidence import Evidence, GAUGES_mm, Latched, Lift, WEIGHT_g
from fdvv.hardware._exported import FolderCheck, PartCheck, check_exported
from fdvv.hardware._filters import (
    FilterValues,
    Step,
    converter_steps,
    filter_values,
    paper_cutoff_Hz,
    rig_settings,
)
from fdvv.hardware._fits import check_fits, misses
from fdvv.hardware._layout import Layout
from fdvv.hardware._levels import Level, PowerState, levels
from fdvv.hardware._limiter import Limiter
from fdvv.hardware._manifest import MadePart, Manifest, read_manifest
from fdvv.hardware._mesh import Mesh, joined, read_stl, stl_bytes
from fdvv.hardware._netlist import to_document, to_kicad, wiring_rows
from fdvv.hardware._parts import Made, Part, part_named, printed_parts
from fdvv.hardware._placement import RIG, Moves, State, in_rig, moved, on_bed, on_jig
from fdvv.hardware._pose import Pose
from fdvv.hardware._power import CoilDrive, Rail, coil_drive, power_budget
from fdvv.hardware._rules import Violation, check_circuit, require_sound, undrawn
from fdvv.hardware._solids import body_of, body_of_bought, gap_mm, mesh_of, placed, shared_mm3
from fdvv.hardware._tolerance import Cause, Stack, core_stack, tilt_deg, turn_deg

__all__ = [
    "PAPER_USD",
    "RIG",
    "Assembly",
    "Bill",
    "BillLine",
    "Block",
    "Bounds",
    "Cause",
    "Circuit",
    "Clearance",
    "CoilDrive",
    "Component",
    "Diagnosis",
    "Dimensions",
    "Envelope",
    "Evidence",
    "Filter",
    "FilterValues",
    "Finding",
    "FolderCheck",
    "GAUGES_mm",
    "Kind",
    "Latched",
    "Layout",
    "Level",
    "Lift",
    "Limiter",
    "Made",
    "MadePart",
    "Manifest",
    "Meeting",
    "Mesh",
    "Moves",
    "Part",
    "PartCheck",
    "Pin",
    "Pose",
    "PowerState",
    "Rail",
    "Rod",
    "Sheet",
    "Stack",
    "State",
    "Step",
    "Verdict",
    "Violation",
    "WEIGHT_g",
    "assemble",
    "assumed",
    "bill_page",
    "body_of",
    "body_of_bought",
    "bought_parts",
    "check_circuit",
    "check_exported",
    "check_fits",
    "circuit_files",
    "circuit_report",
    "clearances",
    "coil_drive",
    "converter_steps",
    "core_stack",
    "diagnose",
    "dimensions_toml",
    "filter_values",
    "gap_mm",
    "group_totals",
    "in_rig",
    "joined",
    "levels",
    "load_bill",
    "load_circuit",
    "load_dimensions",
    "meaning_of",
    "meetings",
    "mesh_of",
    "misses",
    "moved",
    "on_bed",
    "on_jig",
    "paper_cutoff_Hz",
    "part_named",
    "placed",
    "power_budget",
    "printed_parts",
    "read_bill",
    "read_circuit",
    "read_manifest",
    "read_stl",
    "require_sound",
    "rig_settings",
    "shared_mm3",
    "sheet_svgs",
    "source_of",
    "states",
    "stl_bytes",
    "summary",
    "tilt_deg",
    "to_csv",
    "to_document",
    "to_kicad",
    "turn_deg",
    "undrawn",
    "values_page",
    "wiring_page",
    "wiring_rows",
]
