"""Identification of a rig: gain, delay, mass and friction from its presses, with standard errors."""
