"""Anything that accepts a table of force and yields presses."""

from fdvv.device._contract import Device, DeviceInfo

__all__ = ["Device", "DeviceInfo"]
