"""Engines that suggest designs: random, Sobol, Gaussian processes, preferences."""
