"""The button laboratory: capture, model, render and compare the feel of push-buttons.

Importing the package is cheap; the rooms (``fdvv.model``, ``fdvv.capture``, ``fdvv.twin`` ...) are
imported where they are used.
"""

__version__ = "0.1.0"
