"""A simulated capture bench and the person at it."""
