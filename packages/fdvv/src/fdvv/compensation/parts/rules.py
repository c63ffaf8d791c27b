"""Rules that name the part at fault, each from what cannot be so with a sound one, asked in order.

A finger can push and not pull, a cap cannot rise above its top stop, a stop bears a force without a motion,
readings of a live sensor have noise. What a press shows of a part rests on the parts before it: who reads
the place backwards also commands the wrong force.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fdvv.compensation.parts.facts import PressFacts
from fdvv.errors import PartFault
from fdvv.force_text import force_text
from fdvv.units import FloatArray

POSITION, FORCE, COIL = "position sensor", "force sensor", "coil"
MOVER, LIMITER = "mover", "travel limiter"
EXACT_mm = 1e-4
"""Readings that differ by less are one: 1/16 um is the resolution of a board."""
MOVED_mm = 0.5
"""A press moves a free cap by more."""
STUCK_mm = 1.5
"""60 cN for 20 ms move 40 g by twice as much; with the force loop closed a record holds an estimate."""
BACKWARDS_ratio = 0.5
"""Of the travel, above the top stop: no bounce comes so high."""
TOUCH_cN = 40.0
"""A finger that presses is felt so much."""
PULL_cN = 15.0
"""A finger cannot pull, and a sound sensor's zero is not so far off."""
STILL_s = 0.05
HELD_s = 0.02
"""So long at least: a reading that stands still, a force that a stop bears, a cap that nothing touches."""
LOW_mm, DEEP_mm, PASSING_s = 0.6, 0.4, 0.01
"""A stop that stands so far before its place, or behind it, is not where it was asked to be: play and yield
take 0.3 mm, an impact goes deeper for less than so long."""
SOFTEST_cN_mm = 1000.0
"""Stiffness of the softest stop: a finger and a coil that push down together go so much deeper."""
BORNE_cN = 60.0
"""Beyond command: no free cap gives a finger so much."""
LIFTING_cN = 50.0
"""Lifts the movers that the rigs of the class have, 40 g and their friction."""
TURN_mm = 0.05
ALIVE_cN, EXACT_cN = 3.0, 0.0
"""A force sensor on which a stroke was made reads values that differ by more, after a short one by more than
nothing."""


def position_reversed(facts: PressFacts) -> PartFault | None:
    above = -float(facts.place_mm.min())
    if above <= max(MOVED_mm, BACKWARDS_ratio * facts.travel_mm) or above < facts.deepest_mm:
        return None
    seen = f"the position sensor read {-above:.2f} mm, above the top stop, as the cap went down"
    return PartFault(POSITION, seen, "exchange the two wires of its coil, or turn it round")


def position_frozen(facts: PressFacts) -> PartFault | None:
    if facts.span_mm > EXACT_mm or not _feels_finger(facts):
        return None
    felt = "" if facts.force_cN is None else f"while the finger pushed {force_text(_peak_cN(facts), '.0f')}"
    return frozen_fault(float(facts.place_mm[0]), felt)


def frozen_fault(place_mm: float, felt: str) -> PartFault:
    seen = f"the position sensor read exactly {place_mm:.3f} mm throughout {felt}".rstrip()
    return PartFault(POSITION, seen, "look at its cable, its supply and its conditioner")


def mover_stuck(facts: PressFacts) -> PartFault | None:
    if facts.force_cN is None or facts.span_mm > STUCK_mm or _lies_on_stop(facts):
        return None
    borne = facts.force_cN - facts.commanded_cN > BORNE_cN
    free = facts.place_mm < facts.travel_mm - LOW_mm
    if np.count_nonzero(borne & free) * facts.tick_s < HELD_s:
        return None
    pushed = force_text(_peak_cN(facts), ".0f")
    seen = f"the mover gave way by only {facts.span_mm:.2f} mm while the finger pushed {pushed}"
    return PartFault(MOVER, seen, "with the power off move it by hand; free bushing, cables and magnet")


def force_dead(facts: PressFacts) -> PartFault | None:
    """The sensor stands still, throughout or from some moment on, while the cap makes a stroke."""
    if facts.force_cN is None or facts.span_mm < MOVED_mm:
        return None
    still, alive_cN = _standing(facts), float(np.ptp(facts.force_cN))
    least_cN = ALIVE_cN if facts.span_mm > 2 * MOVED_mm else EXACT_cN
    if alive_cN > least_cN and still is None:
        return None
    reading = force_text(float(facts.force_cN[still[0]] if still else facts.force_cN.mean()), ".1f")
    pushed = force_text(float(np.abs(facts.commanded_cN).max()), ".0f")
    seen = f"the force sensor reads {reading} and nothing else while the motor pushes up to {pushed}"
    return PartFault(FORCE, seen, "look at its cable and amplifier")


def force_went_still(facts: PressFacts) -> PartFault | None:
    """The same where something is known to be wrong: one reading to the end, wherever the cap went."""
    if facts.force_cN is None:
        return None
    changes = np.flatnonzero(np.diff(facts.force_cN))
    since = int(changes[-1]) + 1 if changes.size else 0
    if (facts.force_cN.size - since) * facts.tick_s < STILL_s or np.ptp(facts.place_mm[since:]) < MOVED_mm:
        return None
    reading = force_text(float(facts.force_cN[-1]), ".1f")
    seen = f"the force sensor stood still at {reading} from {since * facts.tick_s:.2f} s of the press on"
    return PartFault(FORCE, seen, "look at its cable and amplifier")


def force_silent(facts: PressFacts) -> PartFault | None:
    """Judge a record in which a press was due and nothing was felt."""
    return None if facts.force_cN is None else silent_fault(facts.force_cN)


def silent_fault(force_cN: FloatArray) -> PartFault | None:
    """Return the force sensor's fault if its readings have no noise: a broken wire reads one value."""
    if np.ptp(force_cN) > EXACT_cN:
        return None
    seen = f"the force sensor reads exactly {force_text(float(force_cN[0]), '.1f')}, pressed or not"
    return PartFault(FORCE, seen, "look at its cable and amplifier")


def force_reversed(facts: PressFacts) -> PartFault | None:
    low, high = facts.still_cN
    if not (low < -TOUCH_cN and -low > 2 * high):
        return None
    seen = f"the force sensor reads {force_text(low, '.0f')} while the finger pushes, as if it pulled"
    return PartFault(FORCE, seen, "exchange its signal wires, or mount it the other way round")


def force_pulls(facts: PressFacts) -> PartFault | None:
    low, _ = facts.still_cN
    if not low < -PULL_cN:
        return None
    seen = f"the force sensor reads {force_text(low, '.0f')} where nothing can pull at it"
    return PartFault(FORCE, seen, "its zero has moved: free it from preload, let it warm up, zero it again")


def cap_down(facts: PressFacts) -> PartFault | None:
    """Nobody touches the cap, the motor pushes more than its weight, and it lies there."""
    if facts.deepest_mm < 2 * MOVED_mm:
        return None
    quiet = round(HELD_s / facts.tick_s)
    place, pushed = facts.place_mm[:quiet], facts.commanded_cN[:quiet]
    felt = np.zeros(1) if facts.force_cN is None else facts.force_cN[:quiet]
    if place.min() < MOVED_mm or np.ptp(place) > 0.1 or pushed.min() < LIFTING_cN:
        return None
    if abs(felt.mean()) > PULL_cN / 2:
        return None
    asked = force_text(float(pushed.mean()), ".0f")
    seen = f"with a command of {asked} the coil does not lift the cap from {place.mean():.2f} mm"
    remedy = "look whether its wires are exchanged or off, at driver, supply and gain, or for a heavier mover"
    return PartFault(COIL, seen, remedy)


def limiter_deep(facts: PressFacts) -> PartFault | None:
    force_cN = 0.0 if facts.force_cN is None else facts.force_cN
    yields_mm = np.maximum(0.0, force_cN - facts.commanded_cN) / SOFTEST_cN_mm
    beyond = facts.place_mm - yields_mm > facts.travel_mm + DEEP_mm
    if np.count_nonzero(beyond) * facts.tick_s < PASSING_s:
        return None
    return limiter_fault(facts.deepest_mm, facts.travel_mm)


def limiter_short(facts: PressFacts) -> PartFault | None:
    """Something bears the finger's force where the stop should not be yet."""
    deep = facts.deepest_mm
    if facts.force_cN is None or deep > facts.travel_mm - LOW_mm or facts.span_mm < 2 * MOVED_mm:
        return None
    bottom = facts.place_mm > deep - 0.05
    borne = facts.force_cN[bottom] - facts.commanded_cN[bottom]
    if np.count_nonzero(borne > BORNE_cN) * facts.tick_s < HELD_s:
        return None
    return limiter_fault(deep, facts.travel_mm)


def limiter_fault(stop_mm: float, travel_mm: float) -> PartFault:
    seen = f"the travel limiter lets the cap down to {stop_mm:.1f} mm instead of {travel_mm:.1f}"
    remedy = "look at its servo's plug and 5 V, whether its arm is free, and at stop_zero_us and stop_us_mm"
    return PartFault(LIMITER, seen, remedy)


Rule = Callable[[PressFacts], PartFault | None]
RULES: tuple[Rule, ...] = (
    position_reversed,
    position_frozen,
    mover_stuck,
    force_dead,
    force_reversed,
    force_pulls,
    limiter_deep,
    limiter_short,
    cap_down,
)
"""What rests on a part is asked after it."""


PLACE_RULES: tuple[Rule, ...] = (position_reversed, force_pulls)
"""What needs nobody who presses."""


SURE_RULES: tuple[Rule, ...] = (*RULES, force_went_still)


def part_at_fault(facts: PressFacts, rules: tuple[Rule, ...] = RULES) -> PartFault | None:
    """Return the part that one record shows to be at fault; None if it shows none.

    rules : PLACE_RULES of a record in which nobody was asked to press, SURE_RULES where something is known to
    be wrong.
    """
    return next((fault for rule in rules if (fault := rule(facts))), None)


def was_touched(facts: PressFacts) -> bool:
    """Return whether someone pressed, as far as the record shows."""
    return facts.span_mm > MOVED_mm or (facts.force_cN is not None and _feels_finger(facts))


def _peak_cN(facts: PressFacts) -> float:
    low, high = facts.still_cN
    return max(high, -low)


def _feels_finger(facts: PressFacts) -> bool:
    """Return whether a finger was felt; without a sensor nothing contradicts it."""
    low, high = facts.still_cN
    return facts.force_cN is None or high - low > TOUCH_cN


def _lies_on_stop(facts: PressFacts) -> bool:
    return abs(float(np.median(facts.place_mm)) - facts.travel_mm) < LOW_mm


def _standing(facts: PressFacts) -> tuple[int, int] | None:
    """Return the longest run of one reading of the force, if the cap meanwhile lay at its deepest and moved.

    A finger that has left the cap gives equal readings too, but not where it turned, and a cap that bounces
    there alone does not stay.
    """
    assert facts.force_cN is not None
    ends = np.flatnonzero(np.diff(facts.force_cN)) + 1
    bounds = np.concatenate([[0], ends, [facts.force_cN.size]])
    at = int(np.argmax(np.diff(bounds)))
    first, last = int(bounds[at]), int(bounds[at + 1])
    way = facts.place_mm[first:last]
    lay_s = np.count_nonzero(way > facts.deepest_mm - TURN_mm) * facts.tick_s
    if lay_s < HELD_s or np.ptp(way) < MOVED_mm:
        return None
    return first, last
