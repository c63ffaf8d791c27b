"""Buttons, vibrations and recordings in the files and records that other programs use."""
