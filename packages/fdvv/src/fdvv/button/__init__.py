"""A button from anything: open, fit, compare, import and export."""
