"""From raw streams to averaged force curves: pure steps, each with declared units."""

from fdvv.preprocess._average import AveragedCurve, pool
from fdvv.preprocess._clock import ClockFit, align_clocks
from fdvv.preprocess._edges import Edges
from fdvv.preprocess._evidence import EdgeBounds, edge_bounds
from fdvv.preprocess._force import undo_filter, undo_play
from fdvv.preprocess._fuse import Fusion, Seen, fuse, table_curve, unknown_curve
from fdvv.preprocess._paper import AS_PRINTED, Gaussian, PaperRecipe, SigmaUnit, paper_average
from fdvv.preprocess._press import RawPress, Spans, StrokeTrack
from fdvv.preprocess._probe import Probe, probe_of
from fdvv.preprocess._process import Feature, Processed, process
from fdvv.preprocess._reject import Judged, Limits, Reason, judge
from fdvv.preprocess._settings import Settings
from fdvv.preprocess._strokes import spans_of
from fdvv.preprocess._takes import Presses, idle_cN, presses_of

__all__ = [
    "AS_PRINTED",
    "AveragedCurve",
    "ClockFit",
    "EdgeBounds",
    "Edges",
    "Feature",
    "Fusion",
    "Gaussian",
    "Judged",
    "Limits",
    "PaperRecipe",
    "Presses",
    "Probe",
    "Processed",
    "RawPress",
    "Reason",
    "Seen",
    "Settings",
    "SigmaUnit",
    "Spans",
    "StrokeTrack",
    "align_clocks",
    "edge_bounds",
    "fuse",
    "idle_cN",
    "judge",
    "paper_average",
    "pool",
    "presses_of",
    "probe_of",
    "process",
    "spans_of",
    "table_curve",
    "undo_filter",
    "undo_play",
    "unknown_curve",
]
