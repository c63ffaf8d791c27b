"""How a rendering came out: curves of a probe, what a finger would notice, vibration, and a verdict."""
