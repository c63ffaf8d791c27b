"""Take what other programs wrote into a model: measured curves, or a vibration into a button."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from fdvv import extras
from fdvv.button.export_file import export_formats
from fdvv.button.fit import FitSettings, fit_file, one_line
from fdvv.button.open import open_button
from fdvv.button.wav_vibration import wav_vibration
from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exchange_format import VibrationFormat, VibrationRead
from fdvv.io.documents import own_kind
from fdvv.io.files import open_plain
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.vibration import Vibration

HEAD_bytes = 4096  # assumed to reach beyond a file's metadata; where it does not, the suffix decides
REMEDY = "give measured curves, *.ahap, *.haptic, *.hjif or *.wav"


@dataclass(frozen=True)
class ImportSettings:
    """Settings of an import.

    Attributes
    ----------
    name : of the model; by default the file's, or that of the button it goes into.
    into : the button that a vibration is given to: a model, or what open_button takes.
    stroke, velocity_mm_s : whose vibration it becomes; None is every speed.
    onset_mm : where it starts; by default at the button's peak, or where its contact closes.
    full_scale_m_s2 : what 1 in the file stands for; by default what the file says.
    fit : how curves are fitted.
    """

    name: str | None = None
    into: FDVVModel | str | None = None
    stroke: Stroke = Stroke.PRESS
    velocity_mm_s: float | None = None
    onset_mm: float | None = None
    full_scale_m_s2: float | None = None
    fit: FitSettings = field(default_factory=FitSettings)


@dataclass(frozen=True, eq=False)
class Imported:
    """A model, the format it came in, and notes: what was repaired or assumed, one sentence each."""

    model: FDVVModel
    format: str
    notes: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the report of ``fdvv import --json``."""
        return {
            "name": self.model.name,
            "format": self.format,
            "travel_mm": self.model.travel_mm,
            "curves": [
                {"stroke": str(c.stroke), "velocity_mm_s": c.velocity_mm_s} for c in self.model.curves
            ],
            "vibrations": [
                {
                    "stroke": str(v.stroke),
                    "velocity_mm_s": v.velocity_mm_s,
                    "onset_mm": v.onset_mm,
                    "duration_s": v.duration_s,
                    "modes": [vars(mode) for mode in v.modes],
                }
                for v in self.model.vibrations
            ],
            "notes": list(self.notes),
        }


def import_file(path: Path | str, settings: ImportSettings | None = None) -> Imported:
    """Read a file of another program, known by its content, into a model.

    Curves go the way of ``fdvv fit``; a vibration needs the button it is to be given to. Raises InputError,
    and BuildError if the format's extra is not installed.
    """
    path, chosen = Path(path), settings or ImportSettings()
    kind = own_kind(path)
    if kind:
        raise InputError(path, "whole file", f"holds {kind}, it needs no import", "use it as it is")
    form = _format(path)
    if form is None:
        return _curves(path, chosen)
    return _given(path, chosen, form, _read(path, form, chosen.full_scale_m_s2))


def _format(path: Path) -> str | None:
    """Detect a vibration's format by its first bytes; None for what may be curves."""
    try:
        with open_plain(path) as stream:
            head = stream.read(HEAD_bytes)
    except OSError as error:
        raise InputError(path, "whole file", error.strerror or str(error), "check the path") from error
    if head.startswith(b"RIFF"):
        return "wav"
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    if text.startswith(b"<"):
        reason = "is XML; MuJoCo models and pages cannot be read back"
        raise InputError(path, "whole file", reason, REMEDY)
    if not text.startswith(b"{"):
        return None
    if b'"detent_strength_unit"' in head:
        reason = "is a SmartKnobConfig, which holds no force curve"
        raise InputError(path, "whole file", reason, REMEDY)
    # the longest mark is the surest
    forms = sorted((f for f in export_formats() if f.mark), key=lambda f: len(f.mark), reverse=True)
    marked = next((f.name for f in forms if f.mark in head), None)
    return marked or {f.suffix: f.name for f in forms}.get(path.suffix.lower())


def _curves(path: Path, settings: ImportSettings) -> Imported:
    options = {
        "--into": settings.into,
        "--velocity": settings.velocity_mm_s,
        "--onset-mm": settings.onset_mm,
        "--full-scale-m-s2": settings.full_scale_m_s2,
    }
    for option, value in options.items():
        if value is not None:
            raise InputError(path, "whole file", "holds curves, no vibration", f"leave {option} out")
    found = fit_file(path, settings.fit)
    model = found.model if settings.name is None else found.model.renamed(_name(settings.name))
    source = model.provenance.source
    return Imported(model, source.rpartition("(")[2].rstrip(")"), found.warnings)


def _name(text: str) -> str:
    name = one_line(text)
    if not name:
        raise InputError("--name", "text", "is empty", "give the button a name")
    return name


def _read(path: Path, form: str, scale_m_s2: float | None) -> VibrationRead:
    if form == "wav":
        return wav_vibration(path, scale_m_s2)
    extra: VibrationFormat = extras.load("exchange_formats", form)
    return extra.read(path, scale_m_s2)


def _given(path: Path, settings: ImportSettings, form: str, read: VibrationRead) -> Imported:
    """Put a vibration into a button, in place of the one it has there."""
    if settings.into is None:
        raise InputError(path, "whole file", "holds a vibration, no button", "name the button with --into")
    model = settings.into if isinstance(settings.into, FDVVModel) else open_button(settings.into)
    onset, assumed = settings.onset_mm, read.assumptions
    if onset is None:
        onset, where = _onset(model, settings)
        assumed = (*assumed, f"no file tells where it starts: put at {where}, {onset:.3f} mm")
    try:
        vibration = Vibration(settings.stroke, settings.velocity_mm_s, onset, read.duration_s, read.modes)
        others = tuple(v for v in model.vibrations if not _same_place(v, vibration))
        made = replace(
            model,
            name=model.name if settings.name is None else _name(settings.name),
            vibrations=(*others, vibration),
            provenance=_noted(model.provenance, path, form, assumed),
        )
    except ModelError as error:
        raise InputError(path, "vibration", str(error), "check stroke, velocity and onset") from error
    notes = (*read.notes, *assumed)
    if len(others) < len(model.vibrations):
        notes = (*notes, f"{len(model.vibrations) - len(others)} vibrations of the button were replaced")
    return Imported(made, form, notes)


def _same_place(a: Vibration, b: Vibration) -> bool:
    """Return whether both are of one stroke and speed; None is every speed."""
    speeds = {a.velocity_mm_s, b.velocity_mm_s}
    return a.stroke is b.stroke and (len(speeds) == 1 or None in speeds)


def _onset(model: FDVVModel, settings: ImportSettings) -> tuple[float, str]:
    """Choose the onset of a snap: the peak, else the contact point, else half of the travel."""
    from fdvv.model.bump import find_bump

    curve = model.nearest(settings.stroke, settings.velocity_mm_s)
    if curve is not None:
        x = np.linspace(curve.start_mm, model.travel_mm, 800)
        bump = find_bump(x, curve.force_cN(x))
        if bump:
            return bump.peak_mm, f"the peak of the {settings.stroke}"
    point = model.actuation_mm if settings.stroke is Stroke.PRESS else model.reset_mm
    return (model.travel_mm / 2, "half the travel") if point is None else (point, "the contact's point")


def _noted(provenance: Provenance, path: Path, form: str, assumed: tuple[str, ...]) -> Provenance:
    method = f"{provenance.method}; vibration from {one_line(path.name)} ({form})".removeprefix("; ")
    return replace(provenance, method=method, assumptions=(*provenance.assumptions, *assumed))
