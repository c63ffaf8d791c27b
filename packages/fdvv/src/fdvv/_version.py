"""The version of fdvv, the only place where it is written; CITATION.cff follows it, a test sees to that."""

__version__ = "0.1.0"
