"""Unsealed scores, their statistics, and the report in the paper's form."""
