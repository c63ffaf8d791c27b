"""BoTorch engines for fdvv optimize; torch is imported only when one suggests a design."""

__version__ = "0.1.0"
