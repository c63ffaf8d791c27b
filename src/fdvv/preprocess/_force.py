"""What the force sensor felt, from what its filter let through."""

from __future__ import annotations

import math

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray


def undo_filter(values: FloatArray, step_s: float, filter_s: float) -> FloatArray:
    """Undo an RC filter before a converter, (n,) even samples.

    Between samples the input is taken as a line, for which the filter is exact:
    ``y[k] = e y[k-1] + p u[k] + q u[k-1]``, ``e = exp(-step/filter)``, ``p = 1 - (1-e) filter/step``,
    ``q = (1-e) filter/step - e``. That is solved for u. Noise grows by about 1.6 at 1 ms and 0.333 ms.

    Raises ModelError for a filter slower than 0.9 steps, where the recursion would ring or diverge.
    """
    from scipy.signal import lfilter, lfiltic

    if filter_s == 0 or values.size == 0:
        return values
    if not 0 < filter_s <= 0.9 * step_s:
        raise ModelError(
            f"a filter of {1e3 * filter_s:g} ms cannot be undone at steps of {1e3 * step_s:g} ms; "
            "sample faster, or state 0 to leave it in"
        )
    fade = math.exp(-step_s / filter_s)
    slow = (1 - fade) * filter_s / step_s
    here, before = 1 - slow, slow - fade
    # a record begins settled: input and output were the first value for long
    start = lfiltic([1.0, -fade], [here, before], y=[values[0]], x=[values[0]])
    undone, _ = lfilter([1.0, -fade], [here, before], values, zi=start)
    return np.asarray(undone)


def even(t_s: FloatArray, values: FloatArray, step_s: float) -> tuple[FloatArray, FloatArray]:
    """Put samples that may lack some on even times; what is missing is drawn as a line."""
    count = round((float(t_s[-1]) - float(t_s[0])) / step_s) + 1
    times = t_s[0] + step_s * np.arange(count)
    return times, np.interp(times, t_s, values)


def undo_play(force_cN: FloatArray, play_cN: float) -> FloatArray:
    """Undo a sensor's play: it reads half of it too little while the force rises, too much while it falls.

    force_cN : (n,) even samples. Which way it goes is told from four samples around, and where it goes
    nowhere, nothing is added.
    """
    if play_cN == 0 or force_cN.size < 5:
        return force_cN
    ahead = np.concatenate([force_cN[2:], np.repeat(force_cN[-1], 2)])
    behind = np.concatenate([np.repeat(force_cN[0], 2), force_cN[:-2]])
    return np.asarray(force_cN + 0.5 * play_cN * np.clip((ahead - behind) / (2 * play_cN), -1.0, 1.0))
