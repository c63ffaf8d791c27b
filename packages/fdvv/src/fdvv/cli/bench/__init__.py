"""``fdvv capture``, ``join`` and ``process``: from a button on a bench to its model."""
