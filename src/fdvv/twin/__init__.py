"""Physics of finger and rig: constants apart from state, a compiled press and a slow reference. Simulated."""

from fdvv.twin._draw import draw_finger, draw_rig
from fdvv.twin._finger import Finger, Habit, Impedance, Pulp
from fdvv.twin._gesture import Gesture, plan, vary
from fdvv.twin._image import TableImage, image_of
from fdvv.twin._noise import Noise, draw_noise, silence
from fdvv.twin._pace import mean_speed_mm_s, solve_pace, solve_program_pace
from fdvv.twin._plant import RigPlant
from fdvv.twin._reference import ReferenceTrace, reference_simulate
from fdvv.twin._rig import Controller, Rig
from fdvv.twin._rig_moves import Coil, Exciter, Mover, Servo, Stops
from fdvv.twin._rig_senses import ForceSensor, KeycapSensor, PositionSensor
from fdvv.twin._settings import settings_of
from fdvv.twin._simulate import simulate, simulate_program
from fdvv.twin._toml import finger_to_toml, load_finger, load_rig, rig_to_toml
from fdvv.twin._trace import Trace

__all__ = [
    "Coil",
    "Controller",
    "Exciter",
    "Finger",
    "ForceSensor",
    "Gesture",
    "Habit",
    "Impedance",
    "KeycapSensor",
    "Mover",
    "Noise",
    "PositionSensor",
    "Pulp",
    "ReferenceTrace",
    "Rig",
    "RigPlant",
    "Servo",
    "Stops",
    "TableImage",
    "Trace",
    "draw_finger",
    "draw_noise",
    "draw_rig",
    "finger_to_toml",
    "image_of",
    "load_finger",
    "load_rig",
    "mean_speed_mm_s",
    "plan",
    "reference_simulate",
    "rig_to_toml",
    "settings_of",
    "silence",
    "simulate",
    "simulate_program",
    "solve_pace",
    "solve_program_pace",
    "vary",
]
