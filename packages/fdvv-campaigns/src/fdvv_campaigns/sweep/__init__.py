"""Parameter sweeps over rigs, fingers, buttons and methods."""
