"""The button laboratory: capture, model, render, edit, optimise and compare the feel of push-buttons.

The names below are the public face, imported when first used. Every other module may be imported too, and may
change (docs/explanation/stability.md).
"""

from __future__ import annotations

import importlib
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fdvv._version import __version__
    from fdvv.bench.model import process_recording
    from fdvv.button.compare import compare
    from fdvv.button.fit import FitSettings, fit_file, fit_files
    from fdvv.button.open import open_button
    from fdvv.compensation.identification.identify import identify
    from fdvv.compensation.identification.rig_model import RigModel
    from fdvv.compensation.paper import PaperLaw
    from fdvv.compensation.rig_aware import RigAware
    from fdvv.device.contract import Device, ProgramDevice
    from fdvv.device.open import open_device
    from fdvv.device.twin import TwinDevice
    from fdvv.errors import DeviceError, FdvvError, FitError, InputError, ModelError
    from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
    from fdvv.model.file import load_builtin, load_model, save_model
    from fdvv.model.fit import fit_curve
    from fdvv.model.landmarks import Landmarks, landmarks
    from fdvv.model.model import FDVVModel, Provenance
    from fdvv.model.press import Press
    from fdvv.model.surface import ForceSurface
    from fdvv.model.vibration import Mode, Vibration
    from fdvv.program.check import check_program
    from fdvv.program.compile import compile_program
    from fdvv.program.file import load_program, save_program
    from fdvv.program.program import Program
    from fdvv.recording.file import load_recording, save_recording
    from fdvv.recording.types import Recording
    from fdvv.rendering.actuation_file import load_actuation, save_actuation
    from fdvv.rendering.compensate import compensate
    from fdvv.rendering.feasibility import feasibility
    from fdvv.rendering.probe import probe
    from fdvv.twin.files import load_finger, load_rig
    from fdvv.twin.finger import Finger
    from fdvv.twin.rig import Rig

_MODULES = {
    "fdvv._version": ("__version__",),
    "fdvv.bench.model": ("process_recording",),
    "fdvv.button.compare": ("compare",),
    "fdvv.button.fit": (
        "FitSettings",
        "fit_file",
        "fit_files",
    ),
    "fdvv.button.open": ("open_button",),
    "fdvv.compensation.identification.identify": ("identify",),
    "fdvv.compensation.identification.rig_model": ("RigModel",),
    "fdvv.compensation.paper": ("PaperLaw",),
    "fdvv.compensation.rig_aware": ("RigAware",),
    "fdvv.device.contract": (
        "Device",
        "ProgramDevice",
    ),
    "fdvv.device.open": ("open_device",),
    "fdvv.device.twin": ("TwinDevice",),
    "fdvv.errors": (
        "DeviceError",
        "FdvvError",
        "FitError",
        "InputError",
        "ModelError",
    ),
    "fdvv.model.curve": (
        "ForceCurve",
        "MeasuredCurve",
        "Stroke",
    ),
    "fdvv.model.file": (
        "load_builtin",
        "load_model",
        "save_model",
    ),
    "fdvv.model.fit": ("fit_curve",),
    "fdvv.model.landmarks": (
        "Landmarks",
        "landmarks",
    ),
    "fdvv.model.model": (
        "FDVVModel",
        "Provenance",
    ),
    "fdvv.model.press": ("Press",),
    "fdvv.model.surface": ("ForceSurface",),
    "fdvv.model.vibration": (
        "Mode",
        "Vibration",
    ),
    "fdvv.program.check": ("check_program",),
    "fdvv.program.compile": ("compile_program",),
    "fdvv.program.file": (
        "load_program",
        "save_program",
    ),
    "fdvv.program.program": ("Program",),
    "fdvv.recording.file": (
        "load_recording",
        "save_recording",
    ),
    "fdvv.recording.types": ("Recording",),
    "fdvv.rendering.actuation_file": (
        "load_actuation",
        "save_actuation",
    ),
    "fdvv.rendering.compensate": ("compensate",),
    "fdvv.rendering.feasibility": ("feasibility",),
    "fdvv.rendering.probe": ("probe",),
    "fdvv.twin.files": (
        "load_finger",
        "load_rig",
    ),
    "fdvv.twin.finger": ("Finger",),
    "fdvv.twin.rig": ("Rig",),
}
_HOME = {name: module for module, names in _MODULES.items() for name in names}
_MOVED = {
    "DesignSpace": "fdvv_people",
    "Engine": "fdvv_people",
    "Optimization": "fdvv_people",
    "Study": "fdvv_people",
    "StudyPlan": "fdvv_people",
    "analyse": "fdvv_people",
    "Library": "fdvv_studio",
}
"""Names of version 0.1 and the packages that have them now."""

__all__ = [
    "Device",
    "DeviceError",
    "FDVVModel",
    "FdvvError",
    "Finger",
    "FitError",
    "FitSettings",
    "ForceCurve",
    "ForceSurface",
    "InputError",
    "Landmarks",
    "MeasuredCurve",
    "Mode",
    "ModelError",
    "PaperLaw",
    "Press",
    "Program",
    "ProgramDevice",
    "Provenance",
    "Recording",
    "Rig",
    "RigAware",
    "RigModel",
    "Stroke",
    "TwinDevice",
    "Vibration",
    "__version__",
    "check_program",
    "compare",
    "compensate",
    "compile_program",
    "feasibility",
    "fit_curve",
    "fit_file",
    "fit_files",
    "identify",
    "landmarks",
    "load_actuation",
    "load_builtin",
    "load_finger",
    "load_model",
    "load_program",
    "load_recording",
    "load_rig",
    "open_button",
    "open_device",
    "probe",
    "process_recording",
    "save_actuation",
    "save_model",
    "save_program",
    "save_recording",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that `import fdvv` and the command line start fast."""
    if name in _MOVED:
        raise AttributeError(
            f"{name} is {_MOVED[name]}.{name} (pip install {_MOVED[name].replace('_', '-')})"
        )
    if name not in _HOME:
        raise AttributeError(f"module 'fdvv' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)


def _show_in_notebooks() -> None:
    """Have IPython draw models, landmarks, presses and recordings by `fdvv.report.notebook`."""
    shell = sys.modules["IPython"].get_ipython()
    if shell is None:
        return
    formatter = shell.display_formatter.formatters["text/html"]
    for module, name in (
        ("fdvv.model.model", "FDVVModel"),
        ("fdvv.model.landmarks", "Landmarks"),
        ("fdvv.model.press", "Press"),
        ("fdvv.recording.types", "Recording"),
    ):
        formatter.for_type_by_name(module, name, _to_html)


def _to_html(record: Any) -> str:
    drawn: str = importlib.import_module("fdvv.report.notebook").to_html(record)
    return drawn


if "IPython" in sys.modules:
    _show_in_notebooks()
