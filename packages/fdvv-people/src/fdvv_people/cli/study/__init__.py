"""``fdvv study``: plan, run, analyse and simulate blind studies."""
