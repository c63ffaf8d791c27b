"""The only place that joins rooms: open, fit, compare, compensate, probe, demonstrate."""

from fdvv.workflow._compare import Comparison, Difference, compare
from fdvv.workflow._fit import (
    FitSettings,
    FolderFit,
    FolderSummary,
    ModelFit,
    fit_file,
    fit_folder,
    fit_force_file,
    summarise,
)
from fdvv.workflow._open import expand_folder, open_model
from fdvv.workflow._parts import merge_parts, one_curve, open_part

__all__ = [
    "Comparison",
    "Difference",
    "FitSettings",
    "FolderFit",
    "FolderSummary",
    "ModelFit",
    "compare",
    "expand_folder",
    "fit_file",
    "fit_folder",
    "fit_force_file",
    "merge_parts",
    "one_curve",
    "open_model",
    "open_part",
    "summarise",
]
