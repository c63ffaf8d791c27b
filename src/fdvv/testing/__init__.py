"""Helpers for tests, shipped: devices without physics, and what every device must honour."""

from fdvv.testing._conformance import DeviceConformance, plain_surface
from fdvv.testing._scripted import ScriptedDevice

__all__ = ["DeviceConformance", "ScriptedDevice", "plain_surface"]
