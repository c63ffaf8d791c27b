"""The guided self-test of a rig: measurements, faults, diagnosis."""
