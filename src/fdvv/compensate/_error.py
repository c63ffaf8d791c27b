"""How far a felt curve is from its target."""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray


def error_cN(target_cN: FloatArray, measured_cN: FloatArray, alpha: float = 0.7) -> float:
    """Weigh mean and largest deviation: alpha * mean|d| + (1 - alpha) * max|d| (the paper's eq. 3).

    target_cN, measured_cN : (n,) on one grid; bins that are NaN were not visited and do not count.
    Raises ModelError where no bin counts.
    """
    deviation = np.abs(target_cN - measured_cN)
    deviation = deviation[np.isfinite(deviation)]
    if not deviation.size:
        raise ModelError("no bin holds both a target and a measured force")
    return float(alpha * deviation.mean() + (1 - alpha) * deviation.max())
