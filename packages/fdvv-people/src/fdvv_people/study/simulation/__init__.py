"""Simulated participants: what they feel, how they answer, and the power of a plan."""
