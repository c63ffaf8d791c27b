"""The firmware's tick, called from Python: the same C that runs on the board."""
