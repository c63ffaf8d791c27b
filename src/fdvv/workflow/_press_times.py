"""From what the simulation did to the clock of the hand that led it."""

from __future__ import annotations

from bisect import bisect_right
from threading import Lock

KEPT = 200
"""Of leads and activations; a round has a handful."""


class PressTimes:
    """Tells when keys went down on the hand's own clock, whatever lay between hand and simulation.

    A lead takes effect some milliseconds after the hand did it: network, waiting, steps of the run. What the
    button does from there on lasts as long in the simulation as it would in the hand. So an activation is as
    long after the hand as, in simulated time, after the lead that caused it: the way in between is taken out
    exactly, and no clock of the server is in it. Any thread may call.
    """

    def __init__(self) -> None:
        self._leads: list[tuple[float, float]] = []
        self._activations_s: list[float] = []
        self._lock = Lock()

    def led(self, simulated_s: float, hand_s: float) -> None:
        """Note that a press of the hand at hand_s takes effect at a simulated time, later than the last."""
        with self._lock:
            self._leads = [*self._leads, (simulated_s, hand_s)][-KEPT:]

    def activated(self, simulated_s: float) -> None:
        """Note that the key went down; one that no lead came before is nobody's press."""
        with self._lock:
            at = bisect_right(self._leads, simulated_s, key=lambda lead: lead[0]) - 1
            if at >= 0:
                led_s, hand_s = self._leads[at]
                self._activations_s = [*self._activations_s, hand_s + simulated_s - led_s][-KEPT:]

    def between(self, start_s: float, end_s: float) -> tuple[float, ...]:
        """Give the activations from start to end on the hand's clock, rising."""
        with self._lock:
            return tuple(sorted(at for at in self._activations_s if start_s <= at <= end_s))
