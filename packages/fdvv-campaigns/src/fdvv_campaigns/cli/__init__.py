"""Commands of ``fdvv``, found by their entry points."""

HELP = {
    "serve": "Let another program optimise, and drive a rig, over a WebSocket of this machine.",
    "sweep": "Try every combination of rigs, fingers, buttons and methods; simulated.",
}
"""The first lines of their help, which ``fdvv --help`` prints without importing the commands."""
