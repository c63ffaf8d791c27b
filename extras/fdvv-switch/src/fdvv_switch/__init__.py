"""Springs, leaves on cams and rubber domes that follow a model's curves, with tolerances and drawings."""

__version__ = "0.1.0"
