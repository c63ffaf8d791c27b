"""What figures depend on beside the code: the arithmetic of the machine, and the libraries."""

from __future__ import annotations

import math
from importlib.metadata import version

LIBRARIES = ("numpy", "scipy", "scikit-learn", "matplotlib", "click", "msgspec", "pynacl")


def libraries() -> str:
    """Return the libraries on which figures and texts depend, with their versions."""
    return ", ".join(f"{name} {version(name)}" for name in LIBRARIES)


def arithmetic() -> str:
    """Return a digest of sums that processors, libraries of mathematics and Pythons round differently."""
    import numpy as np
    from scipy import linalg, special
    from tools.snapshot.values import digest

    random = np.random.default_rng(1)
    x, square = random.uniform(0.1, 3.0, 999), random.normal(size=(60, 60))
    positive = square @ square.T + np.eye(60)
    functions = (np.exp, np.log, np.sin, np.cos, np.tanh, np.cbrt, np.log1p, np.arctan, special.erf)
    results = [function(x) for function in functions]
    results += [x**1.7, np.cumsum(x), np.fft.rfft(x).real, positive, np.array([x.sum(), x @ x])]
    results += [linalg.cholesky(positive), linalg.eigvalsh(positive), linalg.solve(positive, square)]
    plain = [math.exp(v) + math.sin(v) + math.pow(v, 0.3) + math.log(v) for v in x.tolist()]
    return digest(b"".join(np.asarray(values).tobytes() for values in [*results, plain, sum(x.tolist())]))
