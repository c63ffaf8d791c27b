"""Simulated participants who play a whole timing study. Simulated."""
