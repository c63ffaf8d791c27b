"""Simulated users who press the twin."""
