"""Figures and HTML reports; figures need the extra ``plot``."""
