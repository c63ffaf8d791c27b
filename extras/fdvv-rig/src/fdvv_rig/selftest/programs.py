"""The program that a rig runs while its exciter is tested: tones, and no force."""

from __future__ import annotations

from dataclasses import replace

from fdvv.model.vibration import Mode
from fdvv.program.compile import compile_program
from fdvv.program.program import Program, Signal, State
from fdvv.program.surface import Limits, Surface
from fdvv.protocol.tables import Settings

TONES_Hz = (310.0, 430.0, 550.0, 670.0)
"""About the exciter's resonance, wherever it is; none folds onto another at 1 kHz."""
TONE_s = 2.5
COUNTS = 2047.0


def tone_image(settings: Settings, travel_mm: float) -> bytes:
    """Return a program without force, with the tones as waveforms."""
    flat = Surface("flat", (0.0, travel_mm), ((0.0, 0.0),))
    tones = tuple(Signal(f"{f:g} Hz", TONE_s, (Mode(f, COUNTS, 0.0),)) for f in TONES_Hz)
    state = State("lie", "flat", "flat")
    return _compiled(Program("tones", travel_mm, "lie", (state,), (flat,), tones), settings)


def _compiled(program: Program, settings: Settings) -> bytes:
    limits = replace(Limits(), settings=settings, weight_cN=0.0, counts_per_m_s2=1.0)
    return compile_program(program, limits).image
