"""Commands of ``fdvv``, found by their entry points."""

HELP = {
    "library": "List the built-in buttons; build and search libraries of measured ones.",
    "press": "Press a real button; simulated.",
    "studio": "See, edit, press and tune buttons in the browser.",
}
"""The first lines of their help, which ``fdvv --help`` prints without importing the commands."""
