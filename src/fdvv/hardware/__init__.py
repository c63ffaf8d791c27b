"""The rig as things to make and buy: parts, circuit, bill of materials, and which part is wrong."""

from fdvv.hardware._bill import PAPER_USD, Bill, BillLine, group_totals, load_bill, read_bill, to_csv
from fdvv.hardware._bill_page import bill_page, summary
from fdvv.hardware._circuit import Circuit, Component, Filter, Kind, Pin, Sheet
from fdvv.hardware._circuit_file import load_circuit, read_circuit
from fdvv.hardware._circuit_report import circuit_files, circuit_report, values_page, wiring_page
from fdvv.hardware._diagnosis import Bounds, Diagnosis, Finding, Verdict, diagnose
from fdvv.hardware._diagram import sheet_svgs
from fdvv.hardware._evidence import Evidence, GAUGES_mm, Latched, Lift, WEIGHT_g
from fdvv.hardware._filters import (
    FilterValues,
    Step,
    converter_steps,
    filter_values,
    paper_cutoff_Hz,
    rig_settings,
)
from fdvv.hardware._levels import Drives, Level, levels
from fdvv.hardware._netlist import to_document, to_kicad, wiring_rows
from fdvv.hardware._power import CoilDrive, Rail, coil_drive, power_budget
from fdvv.hardware._rules import Violation, check_circuit, require_sound, undrawn

__all__ = [
    "PAPER_USD",
    "Bill",
    "BillLine",
    "Bounds",
    "Circuit",
    "CoilDrive",
    "Component",
    "Diagnosis",
    "Drives",
    "Evidence",
    "Filter",
    "FilterValues",
    "Finding",
    "GAUGES_mm",
    "Kind",
    "Latched",
    "Level",
    "Lift",
    "Pin",
    "Rail",
    "Sheet",
    "Step",
    "Verdict",
    "Violation",
    "WEIGHT_g",
    "bill_page",
    "check_circuit",
    "circuit_files",
    "circuit_report",
    "coil_drive",
    "converter_steps",
    "diagnose",
    "filter_values",
    "group_totals",
    "levels",
    "load_bill",
    "load_circuit",
    "paper_cutoff_Hz",
    "power_budget",
    "read_bill",
    "read_circuit",
    "require_sound",
    "rig_settings",
    "sheet_svgs",
    "summary",
    "to_csv",
    "to_document",
    "to_kicad",
    "undrawn",
    "values_page",
    "wiring_page",
    "wiring_rows",
]
