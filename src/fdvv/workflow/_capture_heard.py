"""Strokes and what was heard of them, and how that is said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fdvv.model import Stroke
from fdvv.vibration import MeasuredVibration, NotFound, Ring, SharedMode, SnapEnergy

ON_HOUSING = (
    "the accelerometer sat on the housing: amplitudes of vibration are the housing's acceleration, taken for "
    "the cap's"
)


@dataclass(frozen=True, eq=False)
class HeardStroke:
    """One stroke at one pace, and what was heard of its snap; NotFound says why nothing was.

    Attributes
    ----------
    velocity_mm_s, achieved_mm_s : the pace that was asked for, None if none was; and that of the presses.
    energy : the fall of force that drives the snap; None where force does not fall.
    """

    stroke: Stroke
    velocity_mm_s: float | None
    achieved_mm_s: float
    found: MeasuredVibration | NotFound
    energy: SnapEnergy | None = None

    @property
    def reason(self) -> str | None:
        """Get why no ring was found; None where one was."""
        said = self.found if isinstance(self.found, NotFound) else self.found.ring
        return said.reason if isinstance(said, NotFound) else None

    def report(self) -> dict[str, Any]:
        """Give its figures by name; null where nothing was found."""
        told: dict[str, Any] = {
            "stroke": str(self.stroke),
            "velocity_mm_s": self.velocity_mm_s,
            "reason": self.reason,
            "presses": 0,
            "onset_mm": None,
            "onset_spread_mm": None,
            "snap_velocity_mm_s": None,
            "duration_s": None,
            "duration_error_s": None,
            "modes": [],
        }
        found = self.found
        if isinstance(found, NotFound):
            return told
        told |= {
            "presses": found.shown,
            "onset_mm": found.onset_mm.value,
            "onset_spread_mm": found.onset_mm.sd,
        }
        told["snap_velocity_mm_s"] = found.snap_velocity_mm_s.value
        if isinstance(found.ring, Ring):
            told |= {"duration_s": found.ring.duration_s, "duration_error_s": found.ring.duration_sd_s}
            told["modes"] = [
                {
                    "frequency_Hz": m.frequency_Hz,
                    "frequency_error_Hz": m.frequency_sd_Hz,
                    "frequency_spread_Hz": m.frequency_spread_Hz,
                    "decay_1_s": m.decay_1_s,
                    "decay_error_1_s": m.decay_sd_1_s,
                    "decay_spread_1_s": m.decay_spread_1_s,
                }
                for m in found.ring.modes
            ]
        return told


def missing_words(missing: Sequence[tuple[HeardStroke, str]]) -> list[str]:
    """Say where there is no vibration and why, strokes and paces of one reason together."""
    by_reason: dict[str, list[HeardStroke]] = {}
    for one, reason in missing:
        by_reason.setdefault(reason, []).append(one)
    return [f"no vibration on the {_places(ones)}: {reason}" for reason, ones in by_reason.items()]


def _places(ones: Sequence[HeardStroke]) -> str:
    parts = {}
    for stroke in Stroke:
        paces = [
            "unknown" if one.velocity_mm_s is None else f"{one.velocity_mm_s:g}"
            for one in ones
            if one.stroke is stroke
        ]
        if paces:
            parts[str(stroke)] = f"at {', '.join(paces)} mm/s"
    if len(set(parts.values())) == 1:
        return f"{' and '.join(parts)} {next(iter(parts.values()))}"
    return " and ".join(f"{stroke} {places}" for stroke, places in parts.items())


def shared_words(mode: SharedMode) -> str:
    """Say what paces were taken to share."""
    return (
        f"the housing rings alike at every pace: {mode.frequency_Hz:.0f} Hz with a decay of "
        f"{mode.decay_1_s:.0f} 1/s, the middle of {mode.paces} rings (standard errors "
        f"{mode.frequency_sd_Hz:.1f} Hz and {mode.decay_sd_1_s:.0f} 1/s)"
    )
