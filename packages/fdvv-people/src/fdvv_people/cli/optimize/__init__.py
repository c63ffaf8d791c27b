"""``fdvv optimize``: runs, experiments and populations."""
