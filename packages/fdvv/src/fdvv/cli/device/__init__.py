"""``fdvv device``: list, check, press and measure devices."""
