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
    "open_model",
    "summarise",
]
