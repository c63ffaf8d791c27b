"""Vibration from recording to rendering: onsets, damped modes, exciter and inverse, templates, likeness."""

from fdvv.vibration._exciter import (
    FULL_SCALE_V,
    LIMIT_V,
    KnownExciter,
    ToneBench,
    fit_exciter,
)
from fdvv.vibration._exciter_file import EXCITER_SUFFIX, load_exciter, save_exciter
from fdvv.vibration._inverse import (
    Drive,
    InverseSettings,
    acceleration_m_s2,
    drive_for,
)
from fdvv.vibration._likeness import correlation, delay_samples, spectral_similarity, spqi, st_sim
from fdvv.vibration._observer import SimulatedObserver
from fdvv.vibration._templates import Template, TemplateGrid, paper_templates, templates_around
from fdvv.vibration._tone import Tone, clear_frequencies_Hz, clock_ratio, measure_tone
from fdvv.vibration._tune import Answered, Job, Method, Preferred, Question, Standing
from fdvv.vibration._tune_compare import Comparing, ComparingState
from fdvv.vibration._tune_rate import Rating, RatingState
from fdvv.vibration._wave import (
    LISTEN_Hz,
    Sound,
    Wav,
    board_counts,
    board_wav,
    read_wav,
    to_wav,
    vibration_samples,
)

__all__ = [
    "EXCITER_SUFFIX",
    "FULL_SCALE_V",
    "LIMIT_V",
    "Answered",
    "Comparing",
    "ComparingState",
    "Drive",
    "InverseSettings",
    "Job",
    "KnownExciter",
    "LISTEN_Hz",
    "Method",
    "Preferred",
    "Question",
    "Rating",
    "RatingState",
    "SimulatedObserver",
    "Sound",
    "Standing",
    "Template",
    "TemplateGrid",
    "Tone",
    "ToneBench",
    "Wav",
    "acceleration_m_s2",
    "board_counts",
    "board_wav",
    "clear_frequencies_Hz",
    "clock_ratio",
    "correlation",
    "delay_samples",
    "drive_for",
    "fit_exciter",
    "load_exciter",
    "measure_tone",
    "paper_templates",
    "read_wav",
    "save_exciter",
    "spectral_similarity",
    "spqi",
    "st_sim",
    "templates_around",
    "to_wav",
    "vibration_samples",
]
