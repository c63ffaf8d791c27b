"""How fast to press, shown: a count-in, then a bar that goes down and up as the cap should."""

from __future__ import annotations

import time
from collections.abc import Callable

BEATS = ("3", "2", "1")
BEAT_s = 0.5
DWELL_s = 0.05
"""At the stop, between down and up."""

FRAME_s = 1 / 60
WIDTH = 40


def minimum_jerk(part: float) -> float:
    """Give the way covered, 0 to 1, when that part of the time has passed: the smoothest move there is."""
    return part**3 * (10 - 15 * part + 6 * part**2)


def depth_at(t_s: float, stroke_s: float) -> float:
    """Give the depth, 0 to 1, of a press that takes stroke_s down, rests, and takes as long up."""
    down = min(max(t_s / stroke_s, 0.0), 1.0)
    up = min(max((t_s - stroke_s - DWELL_s) / stroke_s, 0.0), 1.0)
    return minimum_jerk(down) - minimum_jerk(up)


def bar(depth: float) -> str:
    """Draw a depth of 0 to 1."""
    filled = round(depth * WIDTH)
    return "█" * filled + "·" * (WIDTH - filled)


def show_cue(
    stroke_s: float,
    draw: Callable[[str], None],
    now_s: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> None:
    """Count in, then let the bar go down and up in the time of the strokes; draw is given each picture."""
    for beat in BEATS:
        draw(f"{beat}  {bar(0.0)}")
        sleep(BEAT_s)
    begun_s = now_s()
    while (t_s := now_s() - begun_s) < 2 * stroke_s + DWELL_s:
        draw(f"   {bar(depth_at(t_s, stroke_s))}")
        sleep(FRAME_s)
    draw(f"   {bar(0.0)}")
