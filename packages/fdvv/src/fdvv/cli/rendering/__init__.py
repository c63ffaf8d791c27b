"""``fdvv compensate``, ``probe``, ``feasible`` and ``tune``: a model rendered on a rig."""
