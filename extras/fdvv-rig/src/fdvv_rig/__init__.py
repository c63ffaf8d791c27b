"""The rig as things to make, buy, wire and test: parts, circuit, bill of materials, self-test."""

__version__ = "0.1.0"

HELP = {"hardware": "Build a rig: what to print and to buy, how to wire it, and which part is wrong."}
"""The first line of the command's help, which ``fdvv --help`` prints without importing the command."""
