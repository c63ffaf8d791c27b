"""Simulated far ends of the drives: they read the vendors' bytes by hand and move a cap."""
