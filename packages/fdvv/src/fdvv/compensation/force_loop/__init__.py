"""The force loop at the finger: its constants, its stability over fingers, and the choice of its gains."""
