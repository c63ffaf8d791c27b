"""Write a button, a vibration of it or a recording in another program's format, and report what is lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from fdvv import extras
from fdvv.button.open import open_button
from fdvv.button.round_trip import curve_losses
from fdvv.button.wav_vibration import wav_vibration
from fdvv.errors import FdvvError, InputError
from fdvv.formats.exchange.curves import bluepylons_csv, curves_csv, haata_csv, switch_tester_json
from fdvv.formats.exchange.exchange_format import ExportFormat, ExportSettings, VibrationFormat
from fdvv.formats.exchange.exported import Exported
from fdvv.formats.exchange.frames import recording_csv
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Vibration
from fdvv.program.render_vibration import vibration_wav
from fdvv.recording.file import RECORDING_SUFFIX, load_recording
from fdvv.vibration.inverse import correlation, spectral_similarity, spqi, st_sim
from fdvv.vibration.wave import LISTEN_Hz, vibration_samples

EXPORT_FORMATS = (
    ExportFormat("csv", ".csv", "all curves in one table, mm and cN", "button"),
    ExportFormat("bluepylons-csv", ".csv", "one press and release: x_um, force_gf, actuated", "button"),
    ExportFormat("haata", ".csv", "numbered presses and releases side by side, mm and gf", "button"),
    ExportFormat("tester-json", ".json", "switch force tester: one press and release, mm and gf", "button"),
    ExportFormat("mjcf", ".xml", "MuJoCo: a slide joint with springs, friction and damping", "button"),
    ExportFormat("smartknob", ".json", "SmartKnobConfig: the snap as two detents", "button"),
    ExportFormat("wav", ".wav", "the vibration as a sound, 48 kHz, 16 bit", "vibration"),
    ExportFormat(
        "ahap", ".ahap", "Apple Core Haptics: intensity and sharpness over time", "vibration", b'"Pattern"'
    ),
    ExportFormat(
        "haptic", ".haptic", "Meta Haptics: amplitude and frequency over time", "vibration", b'"signals"'
    ),
    ExportFormat(
        "hjif", ".hjif", "MPEG haptics, ISO/IEC 23090-31: every mode as a sine", "vibration", b'"perceptions"'
    ),
    ExportFormat("recording-csv", ".csv", "a recording: a row for each sample", "recording"),
)
"""Formats that a button can be exported to: those of this package and the known ones of extras."""

_BUTTONS: dict[str, Callable[[FDVVModel, ExportSettings], Exported]] = {
    "csv": lambda model, s: curves_csv(model, s.step_mm),
    "bluepylons-csv": lambda model, s: bluepylons_csv(model, s.velocity_mm_s, s.step_mm),
    "haata": lambda model, s: haata_csv(model, s.step_mm),
    "tester-json": lambda model, s: switch_tester_json(model, s.velocity_mm_s, s.step_mm),
}


def export_formats() -> tuple[ExportFormat, ...]:
    """Return all formats: the known ones, installed or not, then those of other packages."""
    known = {form.name for form in EXPORT_FORMATS}
    others = [name for name in extras.names("exchange_formats") if name not in known]
    return (*EXPORT_FORMATS, *(extras.load("exchange_formats", name) for name in others))


def export_format(name: str | None, output: Path | str, of: str = "button") -> ExportFormat:
    """Find a format by its name, or else by the file's suffix. Raises InputError."""
    known = {f.name: f for f in export_formats()}
    if name is not None:
        if name not in known:
            raise InputError(name, "format", "no such format", f"choose one of {', '.join(known)}")
        return known[name]
    suffix = Path(output).suffix.lower()
    found = [
        f for f in export_formats() if f.suffix == suffix and (of == "recording") == (f.of == "recording")
    ]
    # the plain table is what a .csv is, the others are layouts of particular benches
    if suffix == ".csv" and found:
        return found[0]
    if len(found) != 1:
        several = " or ".join(f.name for f in found)
        reason = f"'{suffix}' may be {several}" if found else f"the ending '{suffix}' tells no format"
        raise InputError(output, "format", reason, "say which with --to; fdvv export --list shows all")
    return found[0]


def is_recording(spec: str) -> bool:
    return spec.endswith(RECORDING_SUFFIX) and Path(spec).is_file()


def export_button(
    spec: str, to: str | None, output: Path | str, settings: ExportSettings | None = None
) -> Exported:
    """Make the file of another program for what spec names: a button, or a recording.

    spec : as open_button takes it, or a recording's file. to : the format, or None to take it from output's
        suffix. Nothing is written. Raises InputError, and BuildError if the format's extra is not installed.
    """
    chosen = settings or ExportSettings()
    if is_recording(spec):
        form = export_format(to, output, "recording")
        if form.of != "recording":
            reason = f"is a recording, {form.name} is of a {form.of}"
            raise InputError(spec, "whole file", reason, "process it first")
        return recording_csv(load_recording(spec))
    form = export_format(to, output)
    if form.of == "recording":
        raise InputError(spec, "argument", f"{form.name} is of a recording", "name a *.recording.jsonl")
    extra = None if form.name in (*_BUTTONS, "wav") else extras.load("exchange_formats", form.name)
    model = open_button(spec)
    if form.of == "button":
        if extra and extra.needs_press and not model.of(Stroke.PRESS):
            raise InputError(spec, "curves", "it has no press curve", "give it one with fdvv assign")
        if extra:
            written: Exported = extra.write(model, chosen)
            return written
        made = _BUTTONS[form.name](model, chosen)
        losses = curve_losses(model, made, form.suffix, chosen.velocity_mm_s)
        return replace(made, figures={**made.figures, **losses})
    vibration = vibration_of(spec, model, chosen.stroke, chosen.velocity_mm_s or 0.0)
    return export_vibration(vibration, form.name, model.name)


def vibration_of(spec: str, model: FDVVModel, stroke: Stroke | str, velocity_mm_s: float) -> Vibration:
    """Return a model's vibration of a stroke, the nearest to a velocity. InputError if there is none."""
    found = model.vibration(stroke, velocity_mm_s)
    if found is None:
        remedy = "choose the other --stroke" if model.vibrations else "import or tune one first"
        raise InputError(spec, "vibrations", f"it has none of the {stroke}", remedy)
    return found


def export_vibration(vibration: Vibration, form: str, name: str, date: str | None = None) -> Exported:
    """Write a vibration as a sound or a haptic file; figures compare it with what is read back.

    date : of an HJIF file, ISO 8601; today by default. The figures compare acceleration at 48 kHz:
        ``correlation`` at its best delay, ``spectral_similarity``, ``st_sim`` and ``spqi`` are 1 for the
        same.
    """
    if form == "wav":
        made = vibration_wav(vibration)
        kept, lost = ("the acceleration at 48 kHz",), ("strength below a 32767th of the peak",)
        written = Exported("wav", made.data, kept, lost, {"full_scale_m_s2": made.full_scale})
    else:
        extra: VibrationFormat = extras.load("exchange_formats", form)
        written = extra.write(vibration, name, date or datetime.now(UTC).date().isoformat())
    return replace(written, figures={**written.figures, **_likeness(vibration, written)})


def _likeness(vibration: Vibration, written: Exported) -> dict[str, float | None]:
    """Compare a vibration with what is read back of it; None where the import refuses it."""
    try:
        a = vibration_samples(read_back(vibration, written))
    except FdvvError:
        return dict.fromkeys(("correlation", "spectral_similarity", "st_sim", "spqi"))
    b = vibration_samples(vibration)
    return {
        "correlation": correlation(a, b),
        "spectral_similarity": spectral_similarity(a, b, LISTEN_Hz),
        "st_sim": st_sim(a, b, LISTEN_Hz),
        "spqi": spqi(a, b, LISTEN_Hz),
    }


def read_back(vibration: Vibration, written: Exported) -> Vibration:
    """Read an exported sound or haptic file as a vibration at the position and stroke of the original."""
    if written.format == "wav":
        read = wav_vibration(written.data, written.figures["full_scale_m_s2"])
    else:
        extra: VibrationFormat = extras.load("exchange_formats", written.format)
        read = extra.read(written.data, None)
    return replace(vibration, modes=read.modes, duration_s=read.duration_s, spread=None)
