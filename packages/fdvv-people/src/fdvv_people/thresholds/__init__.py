"""Just noticeable differences of force, snap and vibration, measured trial by trial. Pure functions."""
