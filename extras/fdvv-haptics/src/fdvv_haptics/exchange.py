"""The formats of this package, as ``fdvv export`` and ``fdvv import`` find them by their entry points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from fdvv.errors import InputError, ModelError
from fdvv.formats.exchange.exchange_format import ButtonFormat, VibrationFormat, VibrationRead
from fdvv_haptics.ahap import ahap, read_ahap
from fdvv_haptics.hjif import hjif, read_hjif
from fdvv_haptics.meta_haptic import meta_haptic, read_meta_haptic
from fdvv_haptics.mjcf import mjcf
from fdvv_haptics.pulse import Pulse, mode_of
from fdvv_haptics.smartknob import smartknob

NO_PHASE = "it tells no phase, which was taken for 0; of what beats one mode is kept"


def _as_one_mode(
    read: Callable[[Path | bytes, float | None], Pulse],
) -> Callable[[Path | bytes, float | None], VibrationRead]:
    def reader(source: Path | bytes, scale_m_s2: float | None) -> VibrationRead:
        pulse = read(source, scale_m_s2)
        try:
            mode = mode_of(pulse)
        except ModelError as error:
            name = "the file" if isinstance(source, bytes) else source
            raise InputError(name, "whole file", str(error), "give one that is not") from error
        return VibrationRead((mode,), float(pulse.t_s[-1]), (NO_PHASE,))

    return reader


MJCF = ButtonFormat(
    "mjcf",
    ".xml",
    "MuJoCo: a slide joint with springs, friction and damping",
    "button",
    write=lambda model, s: mjcf(
        model, cap_mass_g=s.cap_mass_g, follow=s.follow, velocity_mm_s=s.velocity_mm_s
    ),
    needs_press=True,
)
SMARTKNOB = ButtonFormat(
    "smartknob",
    ".json",
    "SmartKnobConfig: the snap as two detents",
    "button",
    write=lambda model, s: smartknob(model, s.velocity_mm_s, s.degrees_per_mm),
    needs_press=True,
)
AHAP = VibrationFormat(
    "ahap",
    ".ahap",
    "Apple Core Haptics: intensity and sharpness over time",
    "vibration",
    b'"Pattern"',
    write=lambda vibration, name, _date: ahap(vibration, name),
    read=_as_one_mode(read_ahap),
)
META_HAPTIC = VibrationFormat(
    "haptic",
    ".haptic",
    "Meta Haptics: amplitude and frequency over time",
    "vibration",
    b'"signals"',
    write=lambda vibration, name, _date: meta_haptic(vibration, name),
    read=_as_one_mode(read_meta_haptic),
)
HJIF = VibrationFormat(
    "hjif",
    ".hjif",
    "MPEG haptics, ISO/IEC 23090-31: every mode as a sine",
    "vibration",
    b'"perceptions"',
    write=lambda vibration, name, date: hjif(vibration, date, name),
    read=lambda source, scale_m_s2: VibrationRead(*read_hjif(source, scale_m_s2)),
)
