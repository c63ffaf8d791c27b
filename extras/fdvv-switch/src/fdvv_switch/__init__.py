"""Springs, leaves on cams and rubber domes that follow a model's curves, with tolerances and drawings."""

__version__ = "0.1.0"

HELP = {"mechanism": "Design a real switch that gives a model's curves."}
"""The first line of the command's help, which ``fdvv --help`` prints without importing the command."""
