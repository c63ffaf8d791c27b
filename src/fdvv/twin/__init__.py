"""Physics of finger and rig: constants apart from state, a compiled press and a slow reference. Simulated."""

from fdvv.twin._draw import draw_finger, draw_rig
from fdvv.twin._finger import Finger, Habit, Impedance, Pulp
from fdvv.twin._gesture import Gesture, plan, vary
from fdvv.twin._noise import Noise, draw_noise, silence
from fdvv.twin._pace import mean_speed_mm_s, solve_pace
from fdvv.twin._reference import ReferenceTrace, reference_simulate
from fdvv.twin._rig import Coil, Controller, ForceSensor, Mover, PositionSensor, Rig, Stops
from fdvv.twin._simulate import Trace, simulate
from fdvv.twin._toml import finger_to_toml, load_finger, load_rig, rig_to_toml

__all__ = [
    "Coil",
    "Controller",
    "Finger",
    "ForceSensor",
    "Gesture",
    "Habit",
    "Impedance",
    "Mover",
    "Noise",
    "PositionSensor",
    "Pulp",
    "ReferenceTrace",
    "Rig",
    "Stops",
    "Trace",
    "draw_finger",
    "draw_noise",
    "draw_rig",
    "finger_to_toml",
    "load_finger",
    "load_rig",
    "mean_speed_mm_s",
    "plan",
    "reference_simulate",
    "rig_to_toml",
    "silence",
    "simulate",
    "solve_pace",
    "vary",
]
