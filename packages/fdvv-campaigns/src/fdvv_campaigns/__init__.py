"""Sweeps over rigs, fingers and buttons, and the server that other programs drive."""

__version__ = "0.1.0"
