"""A press on a table of force, without a program."""

from __future__ import annotations

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.image import image_of
from fdvv.twin.noise import Noise
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import STEP_s
from fdvv.twin.simulate import simulate_program
from fdvv.twin.trace import Trace


def simulate(
    rig: Rig,
    finger: Finger,
    gesture: Gesture,
    surface: ForceSurface,
    travel_mm: float,
    noise: Noise,
    announced_mm_s: float,
    step_s: float = STEP_s,
    audit: bool = False,
) -> Trace:
    """Simulate one press on a command table (cN), rounded to what the firmware holds."""
    image = image_of(surface, travel_mm).image
    return simulate_program(rig, finger, gesture, image, noise, announced_mm_s, step_s, audit)
