"""Optimisation sessions on file: begin, resume, report."""
