"""Vibration from recording to rendering: onsets, damped modes, exciter and inverse, templates, likeness."""

from fdvv.vibration._damped import DampedFit, DampedMode, cramer_rao, duration_s, fit_damped
from fdvv.vibration._energy import SnapEnergy, snap_energy
from fdvv.vibration._events import Burst, KeyEvents, key_events
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
from fdvv.vibration._modes import fit_modes
from fdvv.vibration._observer import SimulatedObserver
from fdvv.vibration._onset import Turn, find_turn, noise_rms
from fdvv.vibration._paces import PacePresses, measure_paces
from fdvv.vibration._pool import Measured, MeasuredVibration, measure_vibration
from fdvv.vibration._ring import Ring, fit_ring
from fdvv.vibration._scaling import Scaling, fit_scaling
from fdvv.vibration._shared import SharedMode, shared_mode, shared_rings, with_shared
from fdvv.vibration._sinusoid import fit_decaying_sinusoid
from fdvv.vibration._snap import HeardPress, NotFound, Snap, find_snap
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
    "Burst",
    "Comparing",
    "ComparingState",
    "DampedFit",
    "DampedMode",
    "Drive",
    "HeardPress",
    "InverseSettings",
    "Job",
    "KeyEvents",
    "KnownExciter",
    "LISTEN_Hz",
    "Measured",
    "MeasuredVibration",
    "Method",
    "NotFound",
    "PacePresses",
    "Preferred",
    "Question",
    "Rating",
    "RatingState",
    "Ring",
    "Scaling",
    "SharedMode",
    "SimulatedObserver",
    "Snap",
    "SnapEnergy",
    "Sound",
    "Standing",
    "Template",
    "TemplateGrid",
    "Tone",
    "ToneBench",
    "Turn",
    "Wav",
    "acceleration_m_s2",
    "board_counts",
    "board_wav",
    "clear_frequencies_Hz",
    "clock_ratio",
    "correlation",
    "cramer_rao",
    "delay_samples",
    "drive_for",
    "duration_s",
    "find_snap",
    "find_turn",
    "fit_damped",
    "fit_decaying_sinusoid",
    "fit_exciter",
    "fit_modes",
    "fit_ring",
    "fit_scaling",
    "key_events",
    "load_exciter",
    "measure_paces",
    "measure_tone",
    "measure_vibration",
    "noise_rms",
    "paper_templates",
    "read_wav",
    "save_exciter",
    "shared_mode",
    "shared_rings",
    "snap_energy",
    "spectral_similarity",
    "spqi",
    "st_sim",
    "templates_around",
    "to_wav",
    "vibration_samples",
    "with_shared",
]
