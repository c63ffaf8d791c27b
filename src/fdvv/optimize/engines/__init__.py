"""Engines that suggest designs: random, Sobol, Gaussian processes, Optuna, preferences."""
