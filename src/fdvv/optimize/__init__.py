"""Find the button that makes a person perform best: spaces, engines, tasks and simulated users.

Plain records in and out; who presses what is joined in fdvv.workflow.
"""

from fdvv.optimize._accuracy import Accuracy
from fdvv.optimize._belief import believed_best
from fdvv.optimize._calibrate import (
    BAATH,
    TimingFit,
    fit_timing,
    person_spreads_ms,
    pooled_log_likelihood,
    spread_error_ratio,
    timing_log_likelihood,
)
from fdvv.optimize._change_cost import ChangeCost
from fdvv.optimize._draw_users import SPREADS, UserSettings, draw_user, draw_users
from fdvv.optimize._engine import Engine, Objective, PairEngine, Problem
from fdvv.optimize._engines import ENGINES, PAIR_ENGINES, engine_of, pair_engine_of
from fdvv.optimize._ledger import Known, Ledger, steps_before
from fdvv.optimize._model_space import (
    model_of,
    model_parameters,
    model_space,
    monotone_constraint,
    neutral_design,
)
from fdvv.optimize._paper_means import PAPER_BUTTONS, PAPER_MEANS_ms, PAPER_SPREADS_ms, folded_normal_mean
from fdvv.optimize._paper_space import PAPER_TRAVEL_mm, paper_model, paper_space
from fdvv.optimize._pareto import ParetoFront, pareto_front
from fdvv.optimize._percept import Cue, Percept, TactileEvent, percept_of, salience
from fdvv.optimize._pointing import LEVELS_px_s, LOST_ms, TemporalPointing
from fdvv.optimize._space import Constraint, Design, DesignSpace, Parameter
from fdvv.optimize._tapping import RapidTapping
from fdvv.optimize._taps import Taps, read_taps
from fdvv.optimize._task import Task, TaskPress, mean_score
from fdvv.optimize._timing import aim_s, spread_factor, timing_spread_s, tiredness
from fdvv.optimize._torch import torch_there
from fdvv.optimize._trial import Answer, Comparison, Score, Trial, TrialState
from fdvv.optimize._user import SimulatedUser

__all__ = [
    "BAATH",
    "ENGINES",
    "PAIR_ENGINES",
    "PAPER_BUTTONS",
    "SPREADS",
    "Accuracy",
    "Answer",
    "ChangeCost",
    "Comparison",
    "Constraint",
    "Cue",
    "Design",
    "DesignSpace",
    "Engine",
    "Known",
    "LEVELS_px_s",
    "LOST_ms",
    "Ledger",
    "Objective",
    "PAPER_MEANS_ms",
    "PAPER_SPREADS_ms",
    "PAPER_TRAVEL_mm",
    "PairEngine",
    "Parameter",
    "ParetoFront",
    "Percept",
    "Problem",
    "RapidTapping",
    "Score",
    "SimulatedUser",
    "TactileEvent",
    "Taps",
    "Task",
    "TaskPress",
    "TemporalPointing",
    "TimingFit",
    "Trial",
    "TrialState",
    "UserSettings",
    "aim_s",
    "believed_best",
    "draw_user",
    "draw_users",
    "engine_of",
    "fit_timing",
    "folded_normal_mean",
    "mean_score",
    "model_of",
    "model_parameters",
    "model_space",
    "monotone_constraint",
    "neutral_design",
    "pair_engine_of",
    "paper_model",
    "paper_space",
    "pareto_front",
    "percept_of",
    "person_spreads_ms",
    "pooled_log_likelihood",
    "read_taps",
    "salience",
    "spread_error_ratio",
    "spread_factor",
    "steps_before",
    "timing_log_likelihood",
    "timing_spread_s",
    "tiredness",
    "torch_there",
]
