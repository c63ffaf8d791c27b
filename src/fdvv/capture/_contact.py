"""Where the electrical contact closed and opened, and how fast a stroke was."""

from __future__ import annotations

import numpy as np

from fdvv.capture._record import Notes, Track
from fdvv.model import Stroke


def switching_mm(track: Track | None, stroke: Stroke, notes: Notes) -> float | None:
    """Find the first sample after the one edge of the contact; None, with a reason, if there is not one.

    A press closes the contact, a release opens it. A contact that chatters has no single point.
    """
    if track is None or track.closed is None:
        return None
    closed = track.closed > 0.5
    edges = np.flatnonzero(np.diff(closed.astype(np.int8)))
    if edges.size == 1 and closed[-1] == (stroke is Stroke.PRESS):
        return float(track.x_mm[edges[0] + 1])
    point = "actuation" if stroke is Stroke.PRESS else "reset"
    if edges.size > 1:
        places = f"{track.x_mm[edges].min():.3f} to {track.x_mm[edges].max():.3f} mm"
        notes.say(f"{track.where}: the contact chatters, {edges.size} edges from {places}; no {point} point")
    else:
        notes.say(
            f"{track.where}: the contact never {'closed' if not closed.any() else 'opened'}; no {point} point"
        )
    return None


def mean_velocity_mm_s(track: Track) -> float | None:
    """Compute the mean speed between 10 % and 90 % of the stroke, to three digits; None without a clock."""
    if track.time_s is None:
        return None
    x = track.x_mm
    low, high = x.min() + 0.1 * np.ptp(x), x.min() + 0.9 * np.ptp(x)
    inside = np.flatnonzero((x >= low) & (x <= high))
    if inside.size < 2:
        return None
    took = float(track.time_s[inside[-1]] - track.time_s[inside[0]])
    moved = float(abs(x[inside[-1]] - x[inside[0]]))
    if took <= 0.0 or moved <= 0.0 or not np.isfinite(moved / took):
        return None
    return float(f"{moved / took:.3g}")
