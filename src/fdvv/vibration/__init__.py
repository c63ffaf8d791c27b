"""Vibration from recording to rendering: onsets, damped modes, exciter and inverse, templates, likeness."""

from fdvv.vibration._damped import DampedFit, DampedMode, cramer_rao, duration_s, fit_damped
from fdvv.vibration._energy import SnapEnergy, snap_energy
from fdvv.vibration._events import Burst, KeyEvents, key_events
from fdvv.vibration._modes import fit_modes
from fdvv.vibration._onset import Turn, find_turn, noise_rms
from fdvv.vibration._pool import Measured, MeasuredVibration, measure_vibration
from fdvv.vibration._ring import Ring, fit_ring
from fdvv.vibration._scaling import Scaling, fit_scaling
from fdvv.vibration._sinusoid import fit_decaying_sinusoid
from fdvv.vibration._snap import HeardPress, NotFound, Snap, find_snap

__all__ = [
    "Burst",
    "DampedFit",
    "DampedMode",
    "HeardPress",
    "KeyEvents",
    "Measured",
    "MeasuredVibration",
    "NotFound",
    "Ring",
    "Scaling",
    "Snap",
    "SnapEnergy",
    "Turn",
    "cramer_rao",
    "duration_s",
    "find_snap",
    "find_turn",
    "fit_damped",
    "fit_decaying_sinusoid",
    "fit_modes",
    "fit_ring",
    "fit_scaling",
    "key_events",
    "measure_vibration",
    "noise_rms",
    "snap_energy",
]
