"""Commands of ``fdvv``, found by their entry points."""

HELP = {
    "optimize": "Find the button that makes a person perform best.",
    "study": "Compare buttons blind, with people, and analyse what they said.",
}
"""The first lines of their help, which ``fdvv --help`` prints without importing the commands."""
