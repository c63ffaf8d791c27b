"""Physics of finger, rig and real button: constants apart from state; compiled presses. Simulated."""

from fdvv.twin._batch import RigPress, simulate_rig_batch
from fdvv.twin._button import BuiltCam, ButtonPhysics, Curve, Dome, Housing, Leaf, Slider
from fdvv.twin._button_file import button_names, button_to_toml, load_button
from fdvv.twin._button_model import button_of_model
from fdvv.twin._button_noise import ButtonNoise, draw_button_noise, no_button_noise
from fdvv.twin._cam import Cam, identify
from fdvv.twin._capture_bench import CaptureBench, SimulatedTake, TakeTruth, bench_facts
from fdvv.twin._capture_press import LEAD_s
from fdvv.twin._capture_rig import CaptureRig
from fdvv.twin._capture_streams import BOARD, Setup
from fdvv.twin._draw import draw_finger, draw_rig
from fdvv.twin._draw_button import draw_button
from fdvv.twin._finger import Finger, Habit, Impedance, Pulp
from fdvv.twin._gesture import Gesture, depth_m, plan, vary
from fdvv.twin._image import TableImage, image_of
from fdvv.twin._led import LedRig, LedTicks, LIFTED_m, NEAR_1_s
from fdvv.twin._noise import Noise, draw_noise, draw_ticks, silence
from fdvv.twin._pace import mean_speed_mm_s, solve_pace, solve_program_pace
from fdvv.twin._pace_button import solve_button_pace
from fdvv.twin._participant import PARTICIPANTS, WILD, Intent, Participant
from fdvv.twin._plant import RigPlant
from fdvv.twin._probe_button import ProbedCurve, probe_button
from fdvv.twin._reference import ReferenceTrace, reference_simulate
from fdvv.twin._reference_button import ButtonReference, reference_button
from fdvv.twin._rig import Controller, Rig
from fdvv.twin._rig_moves import Coil, Exciter, Mover, Servo, Stops
from fdvv.twin._rig_senses import ForceSensor, KeycapSensor, PositionSensor
from fdvv.twin._settings import settings_of
from fdvv.twin._simulate import simulate, simulate_program
from fdvv.twin._simulate_button import ButtonTrace, PressPlan, simulate_batch, simulate_button
from fdvv.twin._stage import stage_finger
from fdvv.twin._threads import in_threads
from fdvv.twin._toml import finger_to_toml, load_finger, load_rig, rig_to_toml
from fdvv.twin._trace import Trace

__all__ = [
    "BOARD",
    "PARTICIPANTS",
    "WILD",
    "BuiltCam",
    "ButtonNoise",
    "ButtonPhysics",
    "ButtonReference",
    "ButtonTrace",
    "Cam",
    "CaptureBench",
    "CaptureRig",
    "Coil",
    "Controller",
    "Curve",
    "Dome",
    "Exciter",
    "Finger",
    "ForceSensor",
    "Gesture",
    "Habit",
    "Housing",
    "Impedance",
    "Intent",
    "KeycapSensor",
    "LEAD_s",
    "LIFTED_m",
    "Leaf",
    "LedRig",
    "LedTicks",
    "Mover",
    "NEAR_1_s",
    "Noise",
    "Participant",
    "PositionSensor",
    "PressPlan",
    "ProbedCurve",
    "Pulp",
    "ReferenceTrace",
    "Rig",
    "RigPlant",
    "RigPress",
    "Servo",
    "Setup",
    "SimulatedTake",
    "Slider",
    "Stops",
    "TableImage",
    "TakeTruth",
    "Trace",
    "bench_facts",
    "button_names",
    "button_of_model",
    "button_to_toml",
    "depth_m",
    "draw_button",
    "draw_button_noise",
    "draw_finger",
    "draw_noise",
    "draw_rig",
    "draw_ticks",
    "finger_to_toml",
    "identify",
    "image_of",
    "in_threads",
    "load_button",
    "load_finger",
    "load_rig",
    "mean_speed_mm_s",
    "no_button_noise",
    "plan",
    "probe_button",
    "reference_button",
    "reference_simulate",
    "rig_to_toml",
    "settings_of",
    "silence",
    "simulate",
    "simulate_batch",
    "simulate_button",
    "simulate_program",
    "simulate_rig_batch",
    "solve_button_pace",
    "solve_pace",
    "solve_program_pace",
    "stage_finger",
    "vary",
]
