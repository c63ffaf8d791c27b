"""Buttons on motor drives that labs have: moteus, ODrive and SimpleFOC, in a loop on this computer."""

__version__ = "0.1.0"
