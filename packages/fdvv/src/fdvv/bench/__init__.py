"""Guided capture of a button: what a person is asked to do, takes, checks, model, report."""
