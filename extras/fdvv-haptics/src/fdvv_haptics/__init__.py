"""Buttons and vibrations in the formats of haptic systems: MuJoCo, SmartKnob, AHAP, Meta's .haptic, HJIF."""

__version__ = "0.1.0"
