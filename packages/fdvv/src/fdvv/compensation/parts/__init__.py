"""Which part of a rig is at fault, from what its presses show."""
