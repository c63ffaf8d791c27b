"""Figure of one press as a vibration sensor heard it: signal, envelope, events, fitted ring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from fdvv.errors import ModelError
from fdvv.plot import _style as style
from fdvv.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ENVELOPE_s = 0.002


@style.in_house_style
def plot_heard(
    t_s: FloatArray,
    signal: FloatArray,
    events_s: Mapping[str, float],
    ring: tuple[float, Sequence[tuple[float, float, float, float]]] | None = None,
    unit: str = "V",
    title: str = "",
    ax: Axes | None = None,
    simulated: bool = False,
) -> Axes:
    """Draw a signal with its envelope, its events and the modes that were fitted to it.

    t_s, signal : (n,) one press.
    events_s : name and time of each, as "snap", "bottom"; drawn as vertical lines.
    ring : onset (s) and, per mode, frequency (Hz), decay (1/s), amplitude in the unit and phase (rad); drawn
        from the onset on, all modes together, until the slowest has fallen to a tenth.
    unit : of the signal.

    The envelope is the rms over 2 ms. Gives the axes. Raises ModelError for columns of different length.
    """
    if t_s.shape != signal.shape or t_s.size < 2:
        raise ModelError(f"a signal needs a time for each sample, got {signal.shape} at {t_s.shape}")
    ax = style.axes_or_new(ax, 8.0, 3.6)
    ax.plot(1e3 * t_s, signal, color=style.QUIET, linewidth=0.8, label="signal")
    ax.plot(1e3 * t_s, _envelope(t_s, signal), color=style.PALETTE[4], label="envelope")
    if ring is not None:
        at, shown = _ringing(t_s, *ring)
        ax.plot(1e3 * at, shown, color=style.PALETTE[1], label="fitted modes")
    for (name, at_s), colour in zip(events_s.items(), style.PALETTE[2:] * len(events_s), strict=False):
        ax.axvline(
            1e3 * at_s, color=colour, linestyle="--", linewidth=1.2, label=f"{name} {1e3 * at_s:.1f} ms"
        )
    ax.set(xlabel="time (ms)", ylabel=f"signal ({unit})")
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    style.set_titles(ax, style.name_text(title), simulated)
    return ax


def _envelope(t_s: FloatArray, signal: FloatArray) -> FloatArray:
    width = max(1, round(ENVELOPE_s * (t_s.size - 1) / float(t_s[-1] - t_s[0])))
    mean = np.convolve(signal**2, np.ones(width) / width, mode="same")
    return np.sqrt(mean)


def _ringing(
    t_s: FloatArray, onset_s: float, modes: Sequence[tuple[float, float, float, float]]
) -> tuple[FloatArray, FloatArray]:
    """Give fine times after the onset and the sum of the modes there."""
    longest_s = np.log(10) / min(decay for _, decay, _, _ in modes)
    after = np.linspace(0.0, min(longest_s, float(t_s[-1]) - onset_s), 400)
    total = sum(
        amplitude * np.exp(-decay * after) * np.sin(2 * np.pi * f * after + phase)
        for f, decay, amplitude, phase in modes
    )
    return onset_s + after, np.asarray(total)
