"""Helpers for tests, shipped: devices without physics, and what every device must honour."""

from fdvv.testing._scripted import ScriptedDevice

__all__ = ["ScriptedDevice"]
