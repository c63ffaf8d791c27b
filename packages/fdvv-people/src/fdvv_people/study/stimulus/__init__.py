"""Render what a label hides, and keep the evidence of what was rendered."""
