"""Physics of finger, rig and real button in compiled code. Simulated."""
