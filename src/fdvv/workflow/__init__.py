"""The only place that joins rooms: open, fit, compare, compensate, probe, demonstrate."""

from __future__ import annotations

import ast
import importlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fdvv.workflow._achievable import AchievableCurve, LimitedRange, achievable
    from fdvv.workflow._actuation_file import load_actuation, open_receipt, save_actuation
    from fdvv.workflow._capture import CaptureResult, capture_session
    from fdvv.workflow._capture_cue import cue_events, cue_length_s
    from fdvv.workflow._capture_events import CaptureGuide, PaceStanding, TakeAsk, TakeDone
    from fdvv.workflow._capture_heard import HeardStroke
    from fdvv.workflow._capture_html import capture_html
    from fdvv.workflow._capture_look import Verdict, quick_look
    from fdvv.workflow._capture_model import (
        FindVibrations,
        RecordedModel,
        model_of_recording,
        process_recording,
    )
    from fdvv.workflow._capture_plan import CapturePlan, Step
    from fdvv.workflow._capture_report import capture_report
    from fdvv.workflow._capture_vibration import RecordedVibrations, recorded_vibrations
    from fdvv.workflow._check import check_file
    from fdvv.workflow._compare import Comparison, Difference, compare
    from fdvv.workflow._compensate import CompensationResult, compensate, uncompensated
    from fdvv.workflow._demo import DemoResult, Rendering, SwitchFit, demo
    from fdvv.workflow._demo_report import demo_report
    from fdvv.workflow._devices import open_device
    from fdvv.workflow._draft import DraftKept, DraftStale, DraftState
    from fdvv.workflow._draft_history import (
        DraftChange,
        DraftHistory,
        DraftPin,
        DraftStep,
        EditMade,
        PinMade,
        RedoMade,
        UndoMade,
        UnpinMade,
    )
    from fdvv.workflow._draft_patch import (
        CurveChange,
        Patch,
        VibrationChange,
        apply_patch,
        inverse_patch,
        model_of,
        patch_between,
        record_of,
    )
    from fdvv.workflow._draft_template import ModelTemplate, new_model
    from fdvv.workflow._drafts import DraftFile, Drafts
    from fdvv.workflow._exciter import identify_exciter, prepare_exciter, tone_image, with_lead
    from fdvv.workflow._feasibility import (
        CurveFeasibility,
        FeasibilityReport,
        feasibility,
        feasible_curves,
    )
    from fdvv.workflow._felt import (
        FeltPress,
        FORCE_JND_ratio,
        felt_press,
        intended_press,
        noticeable_cN,
    )
    from fdvv.workflow._fit import FitSettings, ModelFit, fit_file, fit_force_file
    from fdvv.workflow._folder import (
        FolderFit,
        FolderSummary,
        fit_files,
        fit_folder,
        measured_files,
        summarise,
    )
    from fdvv.workflow._join_logs import join_logs
    from fdvv.workflow._live_event import LiveEvent, LiveEventKind
    from fdvv.workflow._live_press import LivePress
    from fdvv.workflow._live_run import LiveFrame, LiveRun
    from fdvv.workflow._measured_bands import MeasuredBand, MeasuredButton, measured_button
    from fdvv.workflow._open import FolderButton, button_files, open_files, open_model, open_models
    from fdvv.workflow._open_program import make_program, open_program
    from fdvv.workflow._parts import merge_parts, one_curve, open_part
    from fdvv.workflow._press import ButtonPress, Presses, press_button
    from fdvv.workflow._press_choice import (
        PressChoice,
        button_choices,
        drawn_trace,
        program_choices,
    )
    from fdvv.workflow._press_subject import (
        PRESS_RIGS,
        PressMark,
        PressMode,
        PressSubject,
        model_subject,
        program_subject,
        rig_memory,
    )
    from fdvv.workflow._press_trace import PressTrace, drawn_traces, read_press_trace
    from fdvv.workflow._probe import ProbeResult, fd_only, probe
    from fdvv.workflow._program_shelf import KeptProgram, ProgramEntry, ProgramShelf, read_program
    from fdvv.workflow._program_standing import (
        PlacedFinding,
        ProgramStanding,
        Size,
        SurfaceSize,
        program_standing,
    )
    from fdvv.workflow._programs import program_image
    from fdvv.workflow._real_pace import RealPace
    from fdvv.workflow._receipt import Receipt
    from fdvv.workflow._rig_shelf import RigEntry, RigOnShelf, RigShelf
    from fdvv.workflow._session import Session
    from fdvv.workflow._session_events import Ask, Guide, PressDone, Standing
    from fdvv.workflow._shelf import Shelf
    from fdvv.workflow._shelf_curves import sample_strokes
    from fdvv.workflow._shelf_index import ShelfIndex, ShelfStand, builtin_rows
    from fdvv.workflow._shelf_read import row_of_model
    from fdvv.workflow._shelf_row import NUMBERS as SHELF_NUMBERS
    from fdvv.workflow._shelf_row import ButtonType, Origin, ShelfRow
    from fdvv.workflow._shelf_search import ShelfFound, ShelfQuery, ShelfSearch
    from fdvv.workflow._spread_report import spread_reports
    from fdvv.workflow._tick_bins import TickBinner, TickBins, TickPiece
    from fdvv.workflow._tune_candidates import Candidates, acceleration_per_volt, candidates_for, tuned_model
    from fdvv.workflow._tune_observer import simulated_observer
    from fdvv.workflow._tune_result import TunedVibration, TuneResult, TuneSetup, TuneTold
    from fdvv.workflow._tune_vibration import tune_vibration
    from fdvv.workflow._tuning import settings_with
    from fdvv.workflow._vibration_slots import (
        RenderedVibration,
        Way,
        converter,
        render_vibration,
        slot_volts,
        vibration_wav,
    )

__all__ = [
    "PRESS_RIGS",
    "SHELF_NUMBERS",
    "AchievableCurve",
    "Ask",
    "ButtonPress",
    "ButtonType",
    "Candidates",
    "CaptureGuide",
    "CapturePlan",
    "CaptureResult",
    "Comparison",
    "CompensationResult",
    "CurveChange",
    "CurveFeasibility",
    "DemoResult",
    "Difference",
    "DraftChange",
    "DraftFile",
    "DraftHistory",
    "DraftKept",
    "DraftPin",
    "DraftStale",
    "DraftState",
    "DraftStep",
    "Drafts",
    "EditMade",
    "FORCE_JND_ratio",
    "FeasibilityReport",
    "FeltPress",
    "FindVibrations",
    "FitSettings",
    "FolderButton",
    "FolderFit",
    "FolderSummary",
    "Guide",
    "HeardStroke",
    "KeptProgram",
    "LimitedRange",
    "LiveEvent",
    "LiveEventKind",
    "LiveFrame",
    "LivePress",
    "LiveRun",
    "MeasuredBand",
    "MeasuredButton",
    "ModelFit",
    "ModelTemplate",
    "Origin",
    "PaceStanding",
    "Patch",
    "PinMade",
    "PlacedFinding",
    "PressChoice",
    "PressDone",
    "PressMark",
    "PressMode",
    "PressSubject",
    "PressTrace",
    "Presses",
    "ProbeResult",
    "ProgramEntry",
    "ProgramShelf",
    "ProgramStanding",
    "RealPace",
    "Receipt",
    "RecordedModel",
    "RecordedVibrations",
    "RedoMade",
    "RenderedVibration",
    "Rendering",
    "RigEntry",
    "RigOnShelf",
    "RigShelf",
    "Session",
    "Shelf",
    "ShelfFound",
    "ShelfIndex",
    "ShelfQuery",
    "ShelfRow",
    "ShelfSearch",
    "ShelfStand",
    "Size",
    "Standing",
    "Step",
    "SurfaceSize",
    "SwitchFit",
    "TakeAsk",
    "TakeDone",
    "TickBinner",
    "TickBins",
    "TickPiece",
    "TuneResult",
    "TuneSetup",
    "TuneTold",
    "TunedVibration",
    "UndoMade",
    "UnpinMade",
    "Verdict",
    "VibrationChange",
    "Way",
    "acceleration_per_volt",
    "achievable",
    "apply_patch",
    "builtin_rows",
    "button_choices",
    "button_files",
    "candidates_for",
    "capture_html",
    "capture_report",
    "capture_session",
    "check_file",
    "compare",
    "compensate",
    "converter",
    "cue_events",
    "cue_length_s",
    "demo",
    "demo_report",
    "drawn_trace",
    "drawn_traces",
    "fd_only",
    "feasibility",
    "feasible_curves",
    "felt_press",
    "fit_file",
    "fit_files",
    "fit_folder",
    "fit_force_file",
    "identify_exciter",
    "intended_press",
    "inverse_patch",
    "join_logs",
    "load_actuation",
    "make_program",
    "measured_button",
    "measured_files",
    "merge_parts",
    "model_of",
    "model_of_recording",
    "model_subject",
    "new_model",
    "noticeable_cN",
    "one_curve",
    "open_device",
    "open_files",
    "open_model",
    "open_models",
    "open_part",
    "open_program",
    "open_receipt",
    "patch_between",
    "prepare_exciter",
    "press_button",
    "probe",
    "process_recording",
    "program_choices",
    "program_image",
    "program_standing",
    "program_subject",
    "quick_look",
    "read_press_trace",
    "read_program",
    "record_of",
    "recorded_vibrations",
    "render_vibration",
    "rig_memory",
    "row_of_model",
    "sample_strokes",
    "save_actuation",
    "settings_with",
    "simulated_observer",
    "slot_volts",
    "spread_reports",
    "summarise",
    "tone_image",
    "tune_vibration",
    "tuned_model",
    "uncompensated",
    "vibration_wav",
    "with_lead",
]


@cache
def _homes() -> dict[str, tuple[str, str]]:
    """Find module and name there of every name: they stand above, once, where type checkers read them too."""
    nodes = ast.walk(ast.parse(Path(__file__).read_bytes()))
    found = [node for node in nodes if isinstance(node, ast.ImportFrom)]
    return {a.asname or a.name: (node.module, a.name) for node in found if node.module for a in node.names}


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for: rooms that a command does not use cost it nothing."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, there = _homes()[name]
    found = globals()[name] = getattr(importlib.import_module(module), there)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
