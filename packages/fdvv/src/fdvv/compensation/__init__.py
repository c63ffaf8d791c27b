"""Learning laws that find the command tables which make a rig feel like a model."""
