"""The pointing task of CHI 2020 on an LED strip: driver of its board, rounds, trials of an optimisation."""

__version__ = "0.1.0"
