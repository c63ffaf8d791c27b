"""Learning laws that find the command tables which make a rig feel like a model."""

from fdvv.compensate._balance import Sensor
from fdvv.compensate._bins import bin_force, bump_kept_ratio, grid_mm, smooth
from fdvv.compensate._curve_state import Best, Learned, State
from fdvv.compensate._drift import drifted
from fdvv.compensate._error import error_cN
from fdvv.compensate._explain import explain
from fdvv.compensate._feasible_error import ExpectedError, acceleration_spread_m_s2, expected_error
from fdvv.compensate._feasible_force import Reach, needed_cN, reach, rendered_cN
from fdvv.compensate._feasible_limits import RigLimits
from fdvv.compensate._feasible_motion import Motion, minimum_jerk
from fdvv.compensate._feasible_verdict import Following, FollowVerdict, follow_verdict
from fdvv.compensate._feed_forward import tuning_of
from fdvv.compensate._foresee import FingerJoint
from fdvv.compensate._gain import GainSchedule
from fdvv.compensate._identification_surface import identification_surface
from fdvv.compensate._identify import identify
from fdvv.compensate._judge import Acceptance, Verdict, judge
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._method import Count, CurveOutcome, Job, Method, Outcome, Trial
from fdvv.compensate._observe import Delays, observe
from fdvv.compensate._paper import RIG_DELAYS, PaperLaw
from fdvv.compensate._per_curve import JobState, PerCurve
from fdvv.compensate._prior import Plausible, Prior
from fdvv.compensate._rig_aware import RigAware, RigState
from fdvv.compensate._rig_file import (
    load_memory,
    load_rig,
    memory_from_json,
    rig_from_json,
    rig_to_json,
    save_rig,
)
from fdvv.compensate._rig_learning import Learning
from fdvv.compensate._rig_memory import RigMemory
from fdvv.compensate._stability import (
    Slope,
    Stability,
    grain_limit_N_m,
    passive_limit_N_m,
    stability,
    steepest,
    step_limit_cN,
)
from fdvv.compensate._stability_loop import (
    NominalFinger,
    SampledLoop,
    spectral_radius,
    stiffness_limit_N_m,
    tick_matrix,
)
from fdvv.compensate._strokes import (
    FROM_mm,
    Span,
    STOP_GUARD_mm,
    mean_speed_mm_s,
    split_strokes,
    why_incomplete,
)
from fdvv.compensate._tables import dense_velocities
from fdvv.compensate._thermal import ThermalDose, held_until_s, rise_K, thermal_dose
from fdvv.compensate._tuned import HOLDS_cN, tuned_paper_law
from fdvv.compensate._tuning import UNTUNED, Tuning

__all__ = [
    "RIG_DELAYS",
    "UNTUNED",
    "Acceptance",
    "Best",
    "Count",
    "CurveOutcome",
    "Delays",
    "ExpectedError",
    "FROM_mm",
    "FingerJoint",
    "FollowVerdict",
    "Following",
    "GainSchedule",
    "HOLDS_cN",
    "Job",
    "JobState",
    "KnownRig",
    "Learned",
    "Learning",
    "Method",
    "Motion",
    "NominalFinger",
    "Outcome",
    "PaperLaw",
    "PerCurve",
    "Plausible",
    "Prior",
    "Reach",
    "RigAware",
    "RigLimits",
    "RigMemory",
    "RigState",
    "STOP_GUARD_mm",
    "SampledLoop",
    "Sensor",
    "Slope",
    "Span",
    "Stability",
    "State",
    "ThermalDose",
    "Trial",
    "Tuning",
    "Verdict",
    "acceleration_spread_m_s2",
    "bin_force",
    "bump_kept_ratio",
    "dense_velocities",
    "drifted",
    "error_cN",
    "expected_error",
    "explain",
    "follow_verdict",
    "grain_limit_N_m",
    "grid_mm",
    "held_until_s",
    "identification_surface",
    "identify",
    "judge",
    "load_memory",
    "load_rig",
    "mean_speed_mm_s",
    "memory_from_json",
    "minimum_jerk",
    "needed_cN",
    "observe",
    "passive_limit_N_m",
    "reach",
    "rendered_cN",
    "rig_from_json",
    "rig_to_json",
    "rise_K",
    "save_rig",
    "smooth",
    "spectral_radius",
    "split_strokes",
    "stability",
    "steepest",
    "step_limit_cN",
    "stiffness_limit_N_m",
    "thermal_dose",
    "tick_matrix",
    "tuned_paper_law",
    "tuning_of",
    "why_incomplete",
]
