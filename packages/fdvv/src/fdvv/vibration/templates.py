"""Templates to tune a vibration with: decaying sines around what was measured, as the paper plays them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv.vibration.exciter import FULL_SCALE_V, LIMIT_V

PAPER_Hz, PAPER_s = 239.0, 0.016
PAPER_ENDS_V = (0.0, 0.3, 0.6)
SILENT_ratio = 0.01
"""An exponential never ends at 0: a template that should ends at this part of its start, 40 dB down."""


@dataclass(frozen=True)
class Template:
    """A decaying sine on the exciter.

    Attributes
    ----------
    frequency_Hz, duration_s : of the sine; silence after it.
    start_V, end_V : amplitude at its ends; the decay between is exponential. An end of 0 is start / 100.
    """

    frequency_Hz: float
    duration_s: float
    start_V: float
    end_V: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.frequency_Hz) and self.frequency_Hz > 0 and 0 < self.duration_s < 5):
            raise ModelError(f"a template needs a positive frequency and 0 to 5 s, got {self}")
        if not 0 <= self.end_V <= self.start_V <= FULL_SCALE_V or not self.start_V > 0:
            raise ModelError(f"a template's volts fall from at most {FULL_SCALE_V} to at least 0, got {self}")

    @property
    def decay_1_s(self) -> float:
        return float(np.log(self.start_V / max(self.end_V, SILENT_ratio * self.start_V)) / self.duration_s)

    def volts(self, t_s: FloatArray) -> FloatArray:
        """Evaluate the drive at times after its start, in the shape of t_s."""
        envelope = self.start_V * np.exp(-self.decay_1_s * np.maximum(t_s, 0))
        sine = np.sin(2 * np.pi * self.frequency_Hz * t_s)
        return np.where((t_s >= 0) & (t_s <= self.duration_s), envelope * sine, 0.0)

    def vibration(self, like: Vibration, m_s2_V: float) -> Vibration:
        """Return what a model keeps of it: at the stroke, velocity and onset of another, m_s2_V per volt."""
        mode = Mode(self.frequency_Hz, m_s2_V * self.start_V, self.decay_1_s)
        # how the measured one differs between presses is not known of what was made up
        return replace(like, duration_s=self.duration_s, modes=(mode,), spread=None)


def paper_templates(
    frequency_Hz: float = PAPER_Hz, duration_s: float = PAPER_s, start_V: float = LIMIT_V
) -> tuple[Template, ...]:
    """Return the paper's three: from ±2.43 V to 0, 0.3 and 0.6 V (figure of vibration templates)."""
    return tuple(Template(frequency_Hz, duration_s, start_V, end_V) for end_V in PAPER_ENDS_V)


@dataclass(frozen=True)
class TemplateGrid:
    """How templates spread around a measured vibration.

    Attributes
    ----------
    frequency_ratios : of the measured frequency. gain_ratios : of its strength, 1 and above: accentuated.
    end_ratios : amplitude at the end over that at the start; the paper's three.
    limit_V : what a template may begin with; stronger ones are weakened to it and counted once.
    """

    frequency_ratios: Sequence[float] = (1.0,)
    gain_ratios: Sequence[float] = (1.0, 2.0)
    end_ratios: Sequence[float] = tuple(end_V / LIMIT_V for end_V in PAPER_ENDS_V)
    limit_V: float = LIMIT_V

    def __post_init__(self) -> None:
        for name in ("frequency_ratios", "gain_ratios"):
            if not getattr(self, name) or not all(np.isfinite(r) and r > 0 for r in getattr(self, name)):
                raise ModelError(f"{name} must be positive numbers, got {getattr(self, name)}")
        if not self.end_ratios or not all(0 <= ratio <= 1 for ratio in self.end_ratios):
            raise ModelError(f"end_ratios must be 0 to 1, got {self.end_ratios}")


def templates_around(
    vibration: Vibration, m_s2_V: float, grid: TemplateGrid | None = None
) -> tuple[Template, ...]:
    """Return templates that share duration and strongest frequency with a vibration, no two alike.

    m_s2_V : acceleration of the cap per volt at that frequency. The first has the vibration's own strength.
    """
    spread = grid or TemplateGrid()
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    templates: list[Template] = []
    for frequency in spread.frequency_ratios:
        for gain in spread.gain_ratios:
            start_V = min(gain * abs(strongest.amplitude_m_s2) / m_s2_V, spread.limit_V)
            for end in spread.end_ratios:
                made = Template(
                    frequency * strongest.frequency_Hz, vibration.duration_s, start_V, end * start_V
                )
                if made not in templates:
                    templates.append(made)
    return tuple(templates)
