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
    from fdvv.workflow._device_key import DeviceKey
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
    from fdvv.workflow._exchange_in import Imported, ImportSettings, import_file
    from fdvv.workflow._exchange_out import (
        EXPORT_FORMATS,
        ExportFormat,
        ExportSettings,
        export_button,
        export_format,
        export_vibration,
        is_recording,
        read_back,
    )
    from fdvv.workflow._exciter import identify_exciter, prepare_exciter, tone_image, with_lead
    from fdvv.workflow._executor import Executor, chunks_of, open_executor
    from fdvv.workflow._experiment import ExperimentResult, Stage, run_experiment
    from fdvv.workflow._experiment_html import experiment_html, experiment_report, write_experiment
    from fdvv.workflow._experiment_people import Block, a_week_later, blocks_of, random_design
    from fdvv.workflow._experiment_setup import (
        ExperimentSetup,
        WeekGap,
        begin_experiment,
        read_experiment_setup,
    )
    from fdvv.workflow._experiment_train import Observation, Train, Training, Validate
    from fdvv.workflow._experiment_verdict import ButtonMean, ExperimentVerdict, judge_experiment
    from fdvv.workflow._experiment_winner import (
        RenderedWinner,
        Winner,
        open_winner_devices,
        recording_of,
        render_best,
        render_winner,
        winners_of,
    )
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
    from fdvv.workflow._hardware_faults import RIG_FAULTS, RigFault
    from fdvv.workflow._hardware_hands import SOUND, AskedHands, Hands, SimulatedHands
    from fdvv.workflow._hardware_measure import measure_rig
    from fdvv.workflow._hardware_open import open_rig
    from fdvv.workflow._hardware_receipt import (
        SelftestReceipt,
        calibrated,
        changed,
        read_selftest,
        write_selftest,
    )
    from fdvv.workflow._join_logs import join_logs
    from fdvv.workflow._key_hand import KeyHand
    from fdvv.workflow._library import By as LikeBy
    from fdvv.workflow._library import Library, LibraryHit, write_hits
    from fdvv.workflow._library_build import LibraryBuilt, LibraryManifest, build_library
    from fdvv.workflow._library_columns import COLUMNS as LIBRARY_COLUMNS
    from fdvv.workflow._library_query import library_query
    from fdvv.workflow._live_event import LiveEvent, LiveEventKind
    from fdvv.workflow._live_press import LivePress
    from fdvv.workflow._live_run import LiveFrame, LiveRun
    from fdvv.workflow._measured_bands import MeasuredBand, MeasuredButton, measured_button
    from fdvv.workflow._mechanism import DesignedKind, MechanismResult, design_mechanism
    from fdvv.workflow._mechanism_files import write_mechanism
    from fdvv.workflow._mechanism_report import designed_strokes, drawn_parts, mechanism_report
    from fdvv.workflow._mechanism_twin import (
        PressedDesign,
        mechanism_button,
        press_design,
    )
    from fdvv.workflow._open import FolderButton, button_files, open_files, open_model, open_models
    from fdvv.workflow._open_program import make_program, open_program
    from fdvv.workflow._operator_view import OperatorView, PersonView, operator_view
    from fdvv.workflow._optimize_begin import RunAsked, begin_run
    from fdvv.workflow._optimize_player import (
        POINTING,
        SimulatedPlayer,
        about_player,
        play_seed,
        player_of,
        task_named,
    )
    from fdvv.workflow._optimize_report import best_of, optimize_html, optimize_report, trial_report
    from fdvv.workflow._optimize_rig import rig_constraints
    from fdvv.workflow._optimize_session import OptimizeSession, replay_differences
    from fdvv.workflow._optimize_setup import (
        ObjectiveSetup,
        OptimizeSetup,
        SpaceSetup,
        model_space_setup,
        read_setup,
    )
    from fdvv.workflow._others import OthersEntry, OthersShelf, experiment_prior, read_grid
    from fdvv.workflow._paper_like import paper_design_like
    from fdvv.workflow._paper_means import PaperFit, PaperModel, PaperPresses, PaperStudy, fit_paper
    from fdvv.workflow._participant import Participant
    from fdvv.workflow._participant_log import read_session
    from fdvv.workflow._parts import merge_parts, one_curve, open_part
    from fdvv.workflow._play import play, score_design
    from fdvv.workflow._play_bench import PLAY_RIGS, PlayBench, finger_of, refusal_of
    from fdvv.workflow._played_rounds import ClockSource, PlayedRound, PlayedRounds, RoundTiming
    from fdvv.workflow._population import run_population
    from fdvv.workflow._population_plan import PopulationPlan
    from fdvv.workflow._population_result import PopulationResult, read_population
    from fdvv.workflow._population_work import optimise
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
    from fdvv.workflow._press_table import PressTable, adapted_ms, expected_ms, press_table
    from fdvv.workflow._press_times import PressTimes
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
    from fdvv.workflow._rig_shelf import SHIPPED_RIGS, RigEntry, RigOnShelf, RigShelf
    from fdvv.workflow._session import Session
    from fdvv.workflow._session_events import Ask, Guide, PressDone, Standing
    from fdvv.workflow._shelf import Shelf
    from fdvv.workflow._shelf_curves import SampledStroke, sample_strokes
    from fdvv.workflow._shelf_index import ShelfIndex, ShelfStand, builtin_rows
    from fdvv.workflow._shelf_read import row_of_model
    from fdvv.workflow._shelf_row import NUMBERS as SHELF_NUMBERS
    from fdvv.workflow._shelf_row import ButtonType, Origin, ShelfRow
    from fdvv.workflow._shelf_search import ShelfFound, ShelfQuery, ShelfSearch
    from fdvv.workflow._spread_report import spread_reports
    from fdvv.workflow._strip import (
        light_strip,
        play_on_strip,
        played_presser,
        press_of,
        rendering,
        strip_round,
        try_on_strip,
    )
    from fdvv.workflow._strip_check import StripCheck, check_strip
    from fdvv.workflow._strip_run import run_on_any_strip, run_on_strip
    from fdvv.workflow._study import Study
    from fdvv.workflow._study_analyse import analyse
    from fdvv.workflow._study_chain import ChainRead, read_chained
    from fdvv.workflow._study_code_book import CodeBook, CodedColumn, code_book, read_code_book
    from fdvv.workflow._study_columns import ColumnMap
    from fdvv.workflow._study_csv import read_answers
    from fdvv.workflow._study_dict import analysis_dict
    from fdvv.workflow._study_effects import power_design, reference_of
    from fdvv.workflow._study_export import answers_csv, write_answers
    from fdvv.workflow._study_export_people import people_csv, write_analysis
    from fdvv.workflow._study_files import Frozen
    from fdvv.workflow._study_log import ChainedLog
    from fdvv.workflow._study_look import StudyLook, look_at_study
    from fdvv.workflow._study_pause import EVERYBODY
    from fdvv.workflow._study_people import Person, Schedule, SealedTrial
    from fdvv.workflow._study_person_frame import PersonClick, PersonFrame
    from fdvv.workflow._study_power import StudyPower, open_plan, study_power
    from fdvv.workflow._study_preview import (
        preview_dict,
        preview_html,
        preview_sections,
        preview_summary,
        preview_title,
    )
    from fdvv.workflow._study_program import TrialProgram, trial_program
    from fdvv.workflow._study_records import StudyAnalysis
    from fdvv.workflow._study_renderable import device_problems, twin_problems
    from fdvv.workflow._study_report import study_html, study_summary, write_study_report
    from fdvv.workflow._study_seal import (
        Cost,
        Keeper,
        Seal,
        lock_with_code,
        new_code,
        new_keeper,
        unlock_with_code,
    )
    from fdvv.workflow._study_simulated import SimulatedSession, SimulatedStudy, simulate_study
    from fdvv.workflow._study_simulated_person import SimulatedParticipant, UnpressedStage
    from fdvv.workflow._study_stage import EvenSwitch, StudyStage, stimulus_model
    from fdvv.workflow._study_stage_device import DeviceStage
    from fdvv.workflow._study_stage_evidence import StageEvidence
    from fdvv.workflow._study_stage_finger import SimulatedFingerStage
    from fdvv.workflow._study_stage_open import ScreenStage, open_screen_stage
    from fdvv.workflow._study_stage_person import PersonStage
    from fdvv.workflow._sweep import SweepPreview, SweepResult, preview_sweep, run_sweep
    from fdvv.workflow._sweep_columns import sweep_schema
    from fdvv.workflow._sweep_measure import MEASURES as SWEEP_MEASURES
    from fdvv.workflow._sweep_plan import SweepPlan, read_sweep_plan
    from fdvv.workflow._sweep_summary import sweep_summary
    from fdvv.workflow._tap_forces import force_spread_ratio, tap_peaks
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
    "EVERYBODY",
    "EXPORT_FORMATS",
    "LIBRARY_COLUMNS",
    "PLAY_RIGS",
    "POINTING",
    "PRESS_RIGS",
    "RIG_FAULTS",
    "SHELF_NUMBERS",
    "SHIPPED_RIGS",
    "SOUND",
    "SWEEP_MEASURES",
    "AchievableCurve",
    "Ask",
    "AskedHands",
    "Block",
    "ButtonMean",
    "ButtonPress",
    "ButtonType",
    "Candidates",
    "CaptureGuide",
    "CapturePlan",
    "CaptureResult",
    "ChainRead",
    "ChainedLog",
    "ClockSource",
    "CodeBook",
    "CodedColumn",
    "ColumnMap",
    "Comparison",
    "CompensationResult",
    "Cost",
    "CurveChange",
    "CurveFeasibility",
    "DemoResult",
    "DesignedKind",
    "DeviceKey",
    "DeviceStage",
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
    "EvenSwitch",
    "Executor",
    "ExperimentResult",
    "ExperimentSetup",
    "ExperimentVerdict",
    "ExportFormat",
    "ExportSettings",
    "FORCE_JND_ratio",
    "FeasibilityReport",
    "FeltPress",
    "FindVibrations",
    "FitSettings",
    "FolderButton",
    "FolderFit",
    "FolderSummary",
    "Frozen",
    "Guide",
    "Hands",
    "HeardStroke",
    "ImportSettings",
    "Imported",
    "Keeper",
    "KeptProgram",
    "KeyHand",
    "Library",
    "LibraryBuilt",
    "LibraryHit",
    "LibraryManifest",
    "LikeBy",
    "LimitedRange",
    "LiveEvent",
    "LiveEventKind",
    "LiveFrame",
    "LivePress",
    "LiveRun",
    "MeasuredBand",
    "MeasuredButton",
    "MechanismResult",
    "ModelFit",
    "ModelTemplate",
    "ObjectiveSetup",
    "Observation",
    "OperatorView",
    "OptimizeSession",
    "OptimizeSetup",
    "Origin",
    "OthersEntry",
    "OthersShelf",
    "PaceStanding",
    "PaperFit",
    "PaperModel",
    "PaperPresses",
    "PaperStudy",
    "Participant",
    "Patch",
    "Person",
    "PersonClick",
    "PersonFrame",
    "PersonStage",
    "PersonView",
    "PinMade",
    "PlacedFinding",
    "PlayBench",
    "PlayedRound",
    "PlayedRounds",
    "PopulationPlan",
    "PopulationResult",
    "PressChoice",
    "PressDone",
    "PressMark",
    "PressMode",
    "PressSubject",
    "PressTable",
    "PressTimes",
    "PressTrace",
    "PressedDesign",
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
    "RenderedWinner",
    "Rendering",
    "RigEntry",
    "RigFault",
    "RigOnShelf",
    "RigShelf",
    "RoundTiming",
    "RunAsked",
    "SampledStroke",
    "Schedule",
    "ScreenStage",
    "Seal",
    "SealedTrial",
    "SelftestReceipt",
    "Session",
    "Shelf",
    "ShelfFound",
    "ShelfIndex",
    "ShelfQuery",
    "ShelfRow",
    "ShelfSearch",
    "ShelfStand",
    "SimulatedFingerStage",
    "SimulatedHands",
    "SimulatedParticipant",
    "SimulatedPlayer",
    "SimulatedSession",
    "SimulatedStudy",
    "Size",
    "SpaceSetup",
    "Stage",
    "StageEvidence",
    "Standing",
    "Step",
    "StripCheck",
    "Study",
    "StudyAnalysis",
    "StudyLook",
    "StudyPower",
    "StudyStage",
    "SurfaceSize",
    "SweepPlan",
    "SweepPreview",
    "SweepResult",
    "SwitchFit",
    "TakeAsk",
    "TakeDone",
    "TickBinner",
    "TickBins",
    "TickPiece",
    "Train",
    "Training",
    "TrialProgram",
    "TuneResult",
    "TuneSetup",
    "TuneTold",
    "TunedVibration",
    "UndoMade",
    "UnpinMade",
    "UnpressedStage",
    "Validate",
    "Verdict",
    "VibrationChange",
    "Way",
    "WeekGap",
    "Winner",
    "a_week_later",
    "about_player",
    "acceleration_per_volt",
    "achievable",
    "adapted_ms",
    "analyse",
    "analysis_dict",
    "answers_csv",
    "apply_patch",
    "begin_experiment",
    "begin_run",
    "best_of",
    "blocks_of",
    "build_library",
    "builtin_rows",
    "button_choices",
    "button_files",
    "calibrated",
    "candidates_for",
    "capture_html",
    "capture_report",
    "capture_session",
    "changed",
    "check_file",
    "check_strip",
    "chunks_of",
    "code_book",
    "compare",
    "compensate",
    "converter",
    "cue_events",
    "cue_length_s",
    "demo",
    "demo_report",
    "design_mechanism",
    "designed_strokes",
    "device_problems",
    "drawn_parts",
    "drawn_trace",
    "drawn_traces",
    "expected_ms",
    "experiment_html",
    "experiment_prior",
    "experiment_report",
    "export_button",
    "export_format",
    "export_vibration",
    "fd_only",
    "feasibility",
    "feasible_curves",
    "felt_press",
    "finger_of",
    "fit_file",
    "fit_files",
    "fit_folder",
    "fit_force_file",
    "fit_paper",
    "force_spread_ratio",
    "identify_exciter",
    "import_file",
    "intended_press",
    "inverse_patch",
    "is_recording",
    "join_logs",
    "judge_experiment",
    "library_query",
    "light_strip",
    "load_actuation",
    "lock_with_code",
    "look_at_study",
    "make_program",
    "measure_rig",
    "measured_button",
    "measured_files",
    "mechanism_button",
    "mechanism_report",
    "merge_parts",
    "model_of",
    "model_of_recording",
    "model_space_setup",
    "model_subject",
    "new_code",
    "new_keeper",
    "new_model",
    "noticeable_cN",
    "one_curve",
    "open_device",
    "open_executor",
    "open_files",
    "open_model",
    "open_models",
    "open_part",
    "open_plan",
    "open_program",
    "open_receipt",
    "open_rig",
    "open_screen_stage",
    "open_winner_devices",
    "operator_view",
    "optimise",
    "optimize_html",
    "optimize_report",
    "paper_design_like",
    "patch_between",
    "people_csv",
    "play",
    "play_on_strip",
    "play_seed",
    "played_presser",
    "player_of",
    "power_design",
    "prepare_exciter",
    "press_button",
    "press_design",
    "press_of",
    "press_table",
    "preview_dict",
    "preview_html",
    "preview_sections",
    "preview_summary",
    "preview_sweep",
    "preview_title",
    "probe",
    "process_recording",
    "program_choices",
    "program_image",
    "program_standing",
    "program_subject",
    "quick_look",
    "random_design",
    "read_answers",
    "read_back",
    "read_chained",
    "read_code_book",
    "read_experiment_setup",
    "read_grid",
    "read_population",
    "read_press_trace",
    "read_program",
    "read_selftest",
    "read_session",
    "read_setup",
    "read_sweep_plan",
    "record_of",
    "recorded_vibrations",
    "recording_of",
    "reference_of",
    "refusal_of",
    "render_best",
    "render_vibration",
    "render_winner",
    "rendering",
    "replay_differences",
    "rig_constraints",
    "rig_memory",
    "row_of_model",
    "run_experiment",
    "run_on_any_strip",
    "run_on_strip",
    "run_population",
    "run_sweep",
    "sample_strokes",
    "save_actuation",
    "score_design",
    "settings_with",
    "simulate_study",
    "simulated_observer",
    "slot_volts",
    "spread_reports",
    "stimulus_model",
    "strip_round",
    "study_html",
    "study_power",
    "study_summary",
    "summarise",
    "sweep_schema",
    "sweep_summary",
    "tap_peaks",
    "task_named",
    "tone_image",
    "trial_program",
    "trial_report",
    "try_on_strip",
    "tune_vibration",
    "tuned_model",
    "twin_problems",
    "uncompensated",
    "unlock_with_code",
    "vibration_wav",
    "winners_of",
    "with_lead",
    "write_analysis",
    "write_answers",
    "write_experiment",
    "write_hits",
    "write_mechanism",
    "write_selftest",
    "write_study_report",
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
