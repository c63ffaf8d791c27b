"""When a person is told to do what in one take."""

from __future__ import annotations

from fdvv.recording import Stage

COUNT_IN_s = 1.5
"""Before every press and probe."""
DWELL_s = 0.05
"""At the bottom, between down and up."""
REST_s = 1.0
"""How long nobody touches the bench in a take of rest."""
PROBE_mm_s = 0.5
"""Of the slow probe: the speed of force testers."""
CONTACT, BOTTOM = "cue contact", "cue bottom"
"""The moments that are told with a beep."""


def stroke_s(velocity_mm_s: float, travel_mm: float) -> float:
    """Give the time of one stroke."""
    return travel_mm / velocity_mm_s


def cue_length_s(stage: Stage, velocity_mm_s: float | None, travel_mm: float) -> float:
    """Give the time from the begin of a take's cue to its end."""
    if velocity_mm_s is None:
        return COUNT_IN_s + REST_s
    return COUNT_IN_s + 2 * stroke_s(velocity_mm_s, travel_mm) + DWELL_s


def cue_events(velocity_mm_s: float | None, travel_mm: float) -> tuple[tuple[str, float], ...]:
    """Give the moments that are told with a beep, as fdvv.device.Cue has them."""
    if velocity_mm_s is None:
        return ()
    return (CONTACT, COUNT_IN_s), (BOTTOM, COUNT_IN_s + stroke_s(velocity_mm_s, travel_mm))
