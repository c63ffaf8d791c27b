"""Statistical tests and models on plain arrays."""
