"""Buttons, vibrations and recordings in the files and records that other programs use."""

from fdvv.exchange._ahap import ahap, read_ahap
from fdvv.exchange._curves import bluepylons_csv, curves_csv, haata_csv, switch_tester_json
from fdvv.exchange._frames import (
    presses_from_pandas,
    presses_to_pandas,
    recording_to_pandas,
    recording_to_xarray,
)
from fdvv.exchange._hjif import hjif, read_hjif
from fdvv.exchange._meta_haptic import meta_haptic, read_meta_haptic
from fdvv.exchange._mjcf import Follow, SpringButton, mjcf, spring_button
from fdvv.exchange._model_frame import model_to_xarray
from fdvv.exchange._mujoco import MujocoButton, mujoco_button
from fdvv.exchange._pulse import Pulse, frequency_Hz, mode_of, pulse_of, sharpness
from fdvv.exchange._recording_csv import recording_csv
from fdvv.exchange._smartknob import KnobDetents, knob_detents, smartknob
from fdvv.exchange._types import Exported

__all__ = [
    "Exported",
    "Follow",
    "KnobDetents",
    "MujocoButton",
    "Pulse",
    "SpringButton",
    "ahap",
    "bluepylons_csv",
    "curves_csv",
    "frequency_Hz",
    "haata_csv",
    "hjif",
    "knob_detents",
    "meta_haptic",
    "mjcf",
    "mode_of",
    "model_to_xarray",
    "mujoco_button",
    "presses_from_pandas",
    "presses_to_pandas",
    "pulse_of",
    "read_ahap",
    "read_hjif",
    "read_meta_haptic",
    "recording_csv",
    "recording_to_pandas",
    "recording_to_xarray",
    "sharpness",
    "smartknob",
    "spring_button",
    "switch_tester_json",
]
