"""The ItsyBitsy M0 that controls the rig, emulated: processor, timers, converter, USB."""

__version__ = "0.1.0"
