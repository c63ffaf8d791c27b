"""What a button should feel like: curves, vibration, models, landmarks, fits and files."""

from fdvv.model._builtin import builtin_names, load_builtin
from fdvv.model._bump import Bump, find_bump, running_mean
from fdvv.model._chart import ChartLine, chart_svg
from fdvv.model._curve import ForceCurve, MeasuredCurve, Stroke, reading_order
from fdvv.model._edit import Conflict, assign, copy_curve, merge, remove_curve
from fdvv.model._extent import find_bottom_out_mm, find_contact_mm, first_loaded
from fdvv.model._file import (
    SUFFIX,
    load_model,
    model_from_json,
    model_to_json,
    save_model,
)
from fdvv.model._fit import (
    BUMP_KEPT_ratio,
    CurveFit,
    FitMethod,
    active_part,
    bic_star,
    fit_curve,
    scan_sizes,
    smooth,
)
from fdvv.model._html import block as html_block
from fdvv.model._html import bundle as html_bundle
from fdvv.model._html import table as html_table
from fdvv.model._landmark_errors import LandmarkError, landmark_errors
from fdvv.model._landmarks import Landmarks, landmarks
from fdvv.model._model import FDVVModel, Provenance
from fdvv.model._press import Press
from fdvv.model._records import VERSION, schema
from fdvv.model._spread import CurveSpread, ModeSpread, PointSpread, VibrationSpread
from fdvv.model._surface import ForceSurface
from fdvv.model._velocity import Interpolation
from fdvv.model._vibration import Mode, Vibration

__all__ = [
    "SUFFIX",
    "VERSION",
    "BUMP_KEPT_ratio",
    "Bump",
    "ChartLine",
    "Conflict",
    "CurveFit",
    "CurveSpread",
    "FDVVModel",
    "FitMethod",
    "ForceCurve",
    "ForceSurface",
    "Interpolation",
    "LandmarkError",
    "Landmarks",
    "MeasuredCurve",
    "Mode",
    "ModeSpread",
    "PointSpread",
    "Press",
    "Provenance",
    "Stroke",
    "Vibration",
    "VibrationSpread",
    "active_part",
    "assign",
    "bic_star",
    "builtin_names",
    "chart_svg",
    "copy_curve",
    "find_bottom_out_mm",
    "find_bump",
    "find_contact_mm",
    "first_loaded",
    "fit_curve",
    "html_block",
    "html_bundle",
    "html_table",
    "landmark_errors",
    "landmarks",
    "load_builtin",
    "load_model",
    "merge",
    "model_from_json",
    "model_to_json",
    "reading_order",
    "remove_curve",
    "running_mean",
    "save_model",
    "scan_sizes",
    "schema",
    "smooth",
]
