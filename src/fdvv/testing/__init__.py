"""Helpers for tests, shipped: devices without physics, what every device must honour, random programs."""

from fdvv.testing._conformance import DeviceConformance, ProgramConformance, plain_surface
from fdvv.testing._random_presses import random_inputs, random_settings
from fdvv.testing._random_programs import random_image
from fdvv.testing._scripted import ScriptedDevice

__all__ = [
    "DeviceConformance",
    "ProgramConformance",
    "ScriptedDevice",
    "plain_surface",
    "random_image",
    "random_inputs",
    "random_settings",
]
