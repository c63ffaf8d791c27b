"""The first lines of the help of commands that are found by their entry points."""

HELP = {
    "library": "List the built-in buttons; build and search libraries of measured ones.",
    "optimize": "Find the button that makes a person perform best.",
    "press": "Press a real button; simulated.",
    "serve": "Let another program optimise, and drive a rig, over a WebSocket of this machine.",
    "studio": "See, edit, press and tune buttons in the browser.",
    "study": "Compare buttons blind, with people, and analyse what they said.",
    "sweep": "Try every combination of rigs, fingers, buttons and methods; simulated.",
}
