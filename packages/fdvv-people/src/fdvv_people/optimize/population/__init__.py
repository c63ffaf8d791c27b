"""One optimisation for many simulated people, in resumable chunks."""
