"""An emulated ItsyBitsy M0: the very program that is flashed, on modelled time."""

from fdvv.device._m0._emulator import M0Emulator
from fdvv.device._m0._records import KeyChange, PwmChange, TickCost, TickInputs, TickOutputs, WireMessage

__all__ = ["KeyChange", "M0Emulator", "PwmChange", "TickCost", "TickInputs", "TickOutputs", "WireMessage"]
