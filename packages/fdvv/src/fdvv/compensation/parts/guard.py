"""Watches the presses of a session: which part is at fault, and from which press on the rig is another.

`PressBalance` holds what presses say of the forces at the cap; a further press is held against it. While the
cap travels between its stops, with x into the button,

    sensed force = zero - weight + gain command + mass a + drag v + friction sign(v)
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.compensation.parts.facts import PressFacts
from fdvv.compensation.parts.rules import COIL, FORCE, RULES, SURE_RULES, part_at_fault
from fdvv.errors import PartFault
from fdvv.force_text import force_text
from fdvv.model.press import Press
from fdvv.units import FloatArray

LEVEL, GAIN = 0, 1
MEAN = np.array([-20.0, 1.0, 2.0, 0.05, 3.0])
SPREAD = np.array([30.0, 2.0, 3.0, 0.1, 5.0])
"""Of cN, ratio, cN per m/s2, cN per mm/s and cN before any press: rigs of 5 to 50 g."""
NOISE_cN = 2.0
"""What the balance leaves of a sound press, rms."""
DELAYS_s = (0.0, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3)
"""Of the force behind its command; the one that leaves least counts."""
UPPER_mm, LOWER_mm, SLOWEST_mm_s = 0.25, 0.3, 8.0
"""Only what is so far from the stops, and so fast, counts."""
FEWEST_rows = 10
MOST_turns = 4
"""A cap that turns more often chatters; the delays of its forces are not known well enough for that."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The rows of a press that count: columns (n, 5) of the balance, and the force (n,)."""

    columns: FloatArray
    force_cN: FloatArray


@dataclass(frozen=True, eq=False)
class PressBalance:
    """What presses so far say of the balance.

    Attributes
    ----------
    weight : (5, 5) and pull : (5,), normal equations with the prior. presses : that count in them.
    """

    weight: FloatArray = field(default_factory=lambda: np.diag(1 / SPREAD**2))
    pull: FloatArray = field(default_factory=lambda: MEAN / SPREAD**2)
    presses: int = 0

    @property
    def numbers(self) -> FloatArray:
        return np.asarray(np.linalg.solve(self.weight, self.pull), dtype=np.float64)

    @property
    def gain(self) -> tuple[float, float]:
        """Force per command, and its standard error."""
        return float(self.numbers[GAIN]), float(np.linalg.inv(self.weight)[GAIN, GAIN] ** 0.5)

    def with_press(self, facts: PressFacts) -> PressBalance:
        """Return the balance with a press more; the same if it shows nothing."""
        fitted = [self._add(rows) for delay in DELAYS_s if (rows := strokes_of(facts, delay))]
        if not fitted:
            return self
        return min(fitted, key=lambda fit: fit[0])[1]

    def _add(self, rows: Strokes) -> tuple[float, PressBalance]:
        """Return what a press leaves, and the balance with it."""
        scale = 1 / (NOISE_cN**2 * _CORRELATED)
        weight = self.weight + scale * rows.columns.T @ rows.columns
        pull = self.pull + scale * rows.columns.T @ rows.force_cN
        balance = PressBalance(weight, pull, self.presses + 1)
        left = rows.force_cN - rows.columns @ balance.numbers
        return float(np.mean(left**2)), balance

    def excess_cN(self, facts: PressFacts) -> tuple[float, float] | None:
        """Return the mean force beyond the balance, and the coil's part in that; None if nothing shows."""
        fitted = [
            (float(np.std(left)), float(np.mean(left)), float(np.mean(rows.columns[:, GAIN])))
            for delay in DELAYS_s
            if (rows := strokes_of(facts, delay))
            for left in [rows.force_cN - rows.columns @ self.numbers]
        ]
        if not fitted:
            return None
        _, missed, commanded = min(fitted)
        return missed, self.gain[0] * commanded


_CORRELATED = 12.0
"""Rows of a millisecond that say the same, as they were averaged."""


def strokes_of(facts: PressFacts, delay_s: float) -> Strokes | None:
    """Return what counts of a press; None if too little does, or without a force sensor."""
    if facts.force_cN is None:
        return None
    step_s = facts.step_s
    place = facts.per_ms(facts.place_mm)
    speed = facts.smooth(np.gradient(facts.smooth(place), step_s)) if place.size > 2 else place
    turn = facts.smooth(np.gradient(speed, step_s)) / 1000 if place.size > 2 else place
    held = facts.per_ms(facts.commanded_cN)
    late = round(delay_s / step_s)
    pushed = facts.smooth(facts.smooth(np.concatenate([np.full(late, held[0]), held[: held.size - late]])))
    force, where = facts.smooth(facts.smooth(facts.per_ms(facts.force_cN))), facts.smooth(place)
    deep = min(facts.travel_mm, facts.deepest_mm) - LOWER_mm
    rows = (where > UPPER_mm) & (where < deep) & (np.abs(speed) > SLOWEST_mm_s)
    turns = np.count_nonzero(np.diff(np.sign(speed[rows])))
    if np.count_nonzero(rows) < FEWEST_rows or turns > MOST_turns:
        return None
    ones, way = np.ones(place.size), np.sign(speed)
    columns = np.stack([ones, pushed, turn, speed, way], axis=1)
    return Strokes(columns[rows], force[rows])


WEAK_gain, BACKWARDS_gain = 0.7, -0.2
"""Force per command below which a coil is not what its settings say; calibrations and droop take 0.25."""
KNOWN_gain_error = 0.25
"""The gain is judged once it is known so well."""
YOUNG_presses = 2
"""A gain that is wrong from the start shows in the first presses; later ones are held against those."""
CHANGED_ratio, CHANGED_cN = 0.13, 5.0
"""Of the coil's force, and at least: twice in a row a change, once nothing. Sound presses scatter by half."""
REVERSED_ratio = 0.8
MOVED_ratio = 0.5
"""Of what is missing, that the lowest reading must share to be the zero's."""
WARM_ratio = 0.33
"""A coil that has lost no more may be warm; none gets so warm that it loses half."""


@dataclass(frozen=True)
class Diagnosis:
    """A part at fault, and how many presses have shown it, the last one among them."""

    fault: PartFault
    presses: int = 1


def weak_coil(balance: PressBalance) -> PartFault | None:
    """Return whether the coil's force is not what is commanded, as far as presses show it."""
    gain, error = balance.gain
    if error > KNOWN_gain_error or gain + error > WEAK_gain:
        return None
    if gain < BACKWARDS_gain:
        seen = "the coil pushes the other way: the finger feels less force, the more is commanded"
        return PartFault(COIL, seen, "exchange its two wires")
    seen = f"the coil pushes {gain:.2f} of what is commanded"
    return PartFault(COIL, seen, "measure its resistance and the supply, then set duty_gain_q16")


@dataclass(frozen=True, eq=False)
class _Suspect:
    """A press that differs, until the next one says whether that was chance; look : counts presses."""

    facts: PressFacts
    off_cN: float
    used: bool
    look: int


class PartGuard:
    """Held against each press of a session on one rig, in order.

    A force that changed counts only once two presses in a row show it: single ones of a sound rig do now and
    then. travel_mm : where the stop is asked to be. has_force : the settings have a force sensor.
    """

    def __init__(self, travel_mm: float, has_force: bool) -> None:
        self.travel_mm, self.has_force = travel_mm, has_force
        self.balance = PressBalance()
        self._looks = 0
        self._suspects: list[_Suspect] = []

    def facts(self, press: Press) -> PressFacts | None:
        return PressFacts.of_press(press, self.travel_mm, self.has_force)

    def learn(self, press: Press) -> None:
        """Count a press that is known to be sound."""
        if facts := self.facts(press):
            self.learn_facts(facts)

    def learn_facts(self, facts: PressFacts) -> None:
        self.balance = self.balance.with_press(facts)

    def look(self, press: Press, used: bool, sure: bool = False) -> Diagnosis | None:
        """Return the part that this press, or the one before and this, show to be at fault.

        used : the press is one as it was asked for; only such ones teach what is sound. sure : something is
        wrong, the board has said so: this press alone counts.
        """
        self._looks += 1
        facts = self.facts(press)
        if facts is None:
            return None
        if fault := part_at_fault(facts, SURE_RULES if sure else RULES):
            return Diagnosis(fault)
        if diagnosis := self._check_change(facts, used, sure):
            return diagnosis
        if used and not self._suspects:
            self.learn_facts(facts)
            young = self.balance.presses <= YOUNG_presses
            if young and (weak := weak_coil(self.balance)):
                return Diagnosis(weak, self.balance.presses)
        return None

    def _check_change(self, facts: PressFacts, used: bool, sure: bool) -> Diagnosis | None:
        """Hold a press against those before it; keep it apart if it differs, until the next one agrees."""
        missed = self.balance.excess_cN(facts) if self.balance.presses >= YOUNG_presses else None
        if missed is None:
            return None
        off_cN, coil_cN = missed
        ratio = off_cN / max(coil_cN, 1.0)
        if abs(ratio) < CHANGED_ratio or abs(off_cN) < CHANGED_cN:
            self._clear()
            return None
        before = [suspect for suspect in self._suspects if suspect.off_cN * off_cN > 0]
        self._suspects = [*before, _Suspect(facts, off_cN, used, self._looks)]
        if not before and not sure and ratio > -REVERSED_ratio:
            return None
        fault = _change(facts, off_cN, ratio)
        return Diagnosis(fault, self._looks - self._suspects[0].look + 1) if fault else None

    def _clear(self) -> None:
        """A press fits again: what was kept apart was chance."""
        for suspect in self._suspects:
            if suspect.used:
                self.learn_facts(suspect.facts)
        self._suspects = []


def _change(facts: PressFacts, off_cN: float, ratio: float) -> PartFault | None:
    """Name what changed: the zero if the sensor's lowest reading moved along, else the coil if it lost."""
    lowest, _ = facts.still_cN
    if lowest / off_cN > MOVED_ratio:
        by, least = force_text(off_cN, "+.0f"), force_text(lowest, "+.0f")
        seen = f"the force sensor is off by {by}: it reads {least} at the least"
        return PartFault(
            FORCE, seen, "its zero wanders: let it warm up, look at its plug and amplifier, zero it"
        )
    if off_cN > 0:
        return None
    if ratio < -REVERSED_ratio:
        seen = "the coil pushes the other way now"
        return PartFault(COIL, seen, "look at its wires and at the driver")
    lost = f"the coil lost {-ratio:.0%} of its force since the session began"
    if ratio > -WARM_ratio:
        return PartFault(COIL, lost, "let it cool down; press at longer intervals, look at supply and plug")
    return PartFault(COIL, lost, "look at its plug, at the driver, the supply and for a shorted winding")
