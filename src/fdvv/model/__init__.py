"""What a button should feel like: curves, vibration, models, landmarks, fits and files."""

from fdvv.model._builtin import builtin_names, load_builtin
from fdvv.model._curve import ForceCurve, MeasuredCurve, Stroke
from fdvv.model._extent import find_bottom_out_mm, find_contact_mm
from fdvv.model._file import (
    SUFFIX,
    VERSION,
    load_model,
    model_from_json,
    model_to_json,
    save_model,
    schema,
)
from fdvv.model._model import FDVVModel, Provenance
from fdvv.model._press import Press
from fdvv.model._surface import ForceSurface
from fdvv.model._velocity import Interpolation
from fdvv.model._vibration import Mode, Vibration

__all__ = [
    "SUFFIX",
    "VERSION",
    "FDVVModel",
    "ForceCurve",
    "ForceSurface",
    "Interpolation",
    "MeasuredCurve",
    "Mode",
    "Press",
    "Provenance",
    "Stroke",
    "Vibration",
    "builtin_names",
    "find_bottom_out_mm",
    "find_contact_mm",
    "load_builtin",
    "load_model",
    "model_from_json",
    "model_to_json",
    "save_model",
    "schema",
]
