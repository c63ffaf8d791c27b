"""Readers of measured force-displacement files, chosen by content."""
