"""Press sessions: compensate, probe, feasibility, tuning, and the files they keep."""
