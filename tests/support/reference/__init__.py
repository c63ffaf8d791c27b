"""Slow readable solvers of the same physics, as oracles for the compiled ones."""
