"""Anything that accepts a table of force and yields presses."""

from fdvv.device._contract import Device, DeviceInfo
from fdvv.device._twin import TwinDevice

__all__ = ["Device", "DeviceInfo", "TwinDevice"]
