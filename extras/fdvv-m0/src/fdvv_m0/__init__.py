"""The ItsyBitsy M0 and M4 that control the rig, emulated: processor, timers, converters, USB."""

__version__ = "0.1.0"
