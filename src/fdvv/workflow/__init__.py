"""The only place that joins rooms: open, fit, compare, compensate, probe, demonstrate."""

from fdvv.workflow._actuation_file import load_actuation, open_receipt, save_actuation
from fdvv.workflow._check import check_file
from fdvv.workflow._compare import Comparison, Difference, compare
from fdvv.workflow._compensate import CompensationResult, compensate, uncompensated
from fdvv.workflow._demo import DemoResult, Rendering, SwitchFit, demo
from fdvv.workflow._demo_report import demo_report
from fdvv.workflow._devices import open_device
from fdvv.workflow._feasibility import (
    CurveFeasibility,
    FeasibilityReport,
    feasibility,
    feasible_curves,
)
from fdvv.workflow._fit import FitSettings, ModelFit, fit_file, fit_force_file
from fdvv.workflow._folder import FolderFit, FolderSummary, fit_files, fit_folder, measured_files, summarise
from fdvv.workflow._open import FolderButton, button_files, open_files, open_model, open_models
from fdvv.workflow._open_program import make_program, open_program
from fdvv.workflow._parts import merge_parts, one_curve, open_part
from fdvv.workflow._press import ButtonPress, Presses, press_button
from fdvv.workflow._probe import ProbeResult, fd_only, probe
from fdvv.workflow._programs import program_image
from fdvv.workflow._receipt import Receipt
from fdvv.workflow._session import Session
from fdvv.workflow._session_events import Ask, Guide, PressDone, Standing
from fdvv.workflow._tuning import settings_with

__all__ = [
    "Ask",
    "ButtonPress",
    "Comparison",
    "CompensationResult",
    "CurveFeasibility",
    "DemoResult",
    "Difference",
    "FeasibilityReport",
    "FitSettings",
    "FolderButton",
    "FolderFit",
    "FolderSummary",
    "Guide",
    "ModelFit",
    "PressDone",
    "Presses",
    "ProbeResult",
    "Receipt",
    "Rendering",
    "Session",
    "Standing",
    "SwitchFit",
    "button_files",
    "check_file",
    "compare",
    "compensate",
    "demo",
    "demo_report",
    "fd_only",
    "feasibility",
    "feasible_curves",
    "fit_file",
    "fit_files",
    "fit_folder",
    "fit_force_file",
    "load_actuation",
    "make_program",
    "measured_files",
    "merge_parts",
    "one_curve",
    "open_device",
    "open_files",
    "open_model",
    "open_models",
    "open_part",
    "open_program",
    "open_receipt",
    "press_button",
    "probe",
    "program_image",
    "save_actuation",
    "settings_with",
    "summarise",
    "uncompensated",
]
