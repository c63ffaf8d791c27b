"""Helpers for tests, shipped: devices without physics, and what every device must honour."""

from fdvv.testing._conformance import DeviceConformance, ProgramConformance, plain_surface
from fdvv.testing._scripted import ScriptedDevice

__all__ = ["DeviceConformance", "ProgramConformance", "ScriptedDevice", "plain_surface"]
