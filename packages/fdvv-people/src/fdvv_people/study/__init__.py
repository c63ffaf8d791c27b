"""Blind studies of how real a rendering feels."""
