"""Bounds of the cap's motion with the finger off: speeds, distances and times."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fdvv.program.condition import When
from fdvv.program.program import Program, Velocity
from fdvv.program.reachability import Cells, make_cells
from fdvv.program.surface import Limits

cN_mm_PER_J = 1e5  # 1 J = 1 N m = 100 cN times 1000 mm


class Motion:
    """Bounds of the cap's motion in each state of a program, by its number.

    The cap is a mass with a drag of at least `damping_N_s_m`; the state's force pushes it up, and at most
    `opposing_cN` holds it back, either way. Speeds are those of the long run, when what the finger gave is
    damped away: then drag balances the strongest push.
    """

    def __init__(self, program: Program, limits: Limits, margin_cN: float) -> None:
        self.program, self.limits = program, limits
        self.cells: Cells = make_cells(program, limits, margin_cN)
        self.first = self.cells.of(limits.top_mm)
        self.widths_mm = np.diff(self.cells.edges_mm)
        net_cN = self.cells.least_cN - limits.opposing_cN
        self.lift_cN = net_cN[:, self.first :].min(axis=1)
        # the weakest push that a cap rising from the bottom has met when it leaves a cell
        self._weakest_cN = np.minimum.accumulate(net_cN[:, ::-1], axis=1)[:, ::-1][:, self.first :]
        start = np.zeros((len(program.states), 1))
        self._work_cN_mm = np.hstack([start, np.cumsum(net_cN * self.widths_mm, axis=1)])
        self.pull_cN = -self.cells.greatest_cN.max(axis=1) - limits.opposing_cN

    def lifts(self, state: int) -> bool:
        """Return whether a state moves the cap up from everywhere below the top."""
        return bool(self.lift_cN[state] > 0)

    def pulls(self, state: int) -> bool:
        """Return whether a state moves the cap down from everywhere."""
        return bool(self.pull_cN[state] > 0)

    @cached_property
    def up_m_s(self) -> float:
        return 0.01 * max(0.0, float(self.cells.greatest_cN.max())) / self.limits.damping_N_s_m

    @cached_property
    def down_m_s(self) -> float:
        """Bound the speed downward: rebound from the top, or drag balancing pull and weight."""
        rebound_m_s = self.limits.rebound_ratio * self.up_m_s
        if all(self.lifts(i) for i in range(len(self.program.states))):
            return rebound_m_s
        pull_cN = max(0.0, -float(self.cells.least_cN.min())) + self.limits.opposing_cN
        return max(rebound_m_s, 0.01 * pull_cN / self.limits.damping_N_s_m)

    def _energy_cN_mm(self, speed_m_s: float) -> float:
        return 0.5 * self.limits.mass_kg * speed_m_s**2 * cN_mm_PER_J

    def _stopping_edge(self, state: int, first: int, last: int, speed_m_s: float) -> int:
        """Return the first edge beyond cells first to last that a cap leaving them downward cannot pass."""
        work = self._work_cN_mm[state]
        needed = float(work[first : last + 2].max()) + self._energy_cN_mm(speed_m_s)
        beyond = np.flatnonzero(work[last + 2 :] >= needed)
        return int(last + 2 + beyond[0]) if beyond.size else self.cells.count

    def coast_cells(self, state: int, cell: int) -> range:
        """Return the cells through which the cap may still go down after it entered a lifting state."""
        return range(cell, max(cell + 1, self._stopping_edge(state, cell, cell, self.down_m_s)))

    def top_cells(self, state: int) -> range:
        """Return the cells in which a cap that came to the top in a lifting state bounces and rests."""
        last = max(self.first - 1, 0)
        return range(self._stopping_edge(state, 0, last, self.limits.rebound_ratio * self.up_m_s))

    def bottom_zone_mm(self, state: int) -> float:
        """Bound how high a cap that was pulled to the bottom bounces."""
        energy_cN_mm = self._energy_cN_mm(self.limits.rebound_ratio * self.down_m_s)
        return float(energy_cN_mm / self.pull_cN[state])

    # -- times ---------------------------------------------------------------------------------------------

    def rise_s(self, state: int) -> float:
        """Bound the time from entering a lifting state to the top: stop, then rise against drag.

        From rest, m v' + b v = F with F no less than the weakest push so far, f(x), gives a time of at most
        m / b and the integral of b / f over the way.
        """
        limits = self.limits
        stop_s = limits.mass_kg * self.down_m_s / (0.01 * float(self.lift_cN[state]))
        per_m = limits.most_damping_N_s_m / (0.01 * self._weakest_cN[state])
        rise_s = float(np.sum(1e-3 * self.widths_mm[self.first :] * per_m))
        return stop_s + rise_s + limits.mass_kg / limits.damping_N_s_m

    def settle_s(self, state: int) -> float:
        """Bound the time of all bounces at the top: each is rebound_ratio as long as the one before."""
        ratio, lift_N = self.limits.rebound_ratio, 0.01 * float(self.lift_cN[state])
        return 2 * self.limits.mass_kg * ratio * self.up_m_s / lift_N / (1 - ratio)

    def longest_stay_s(self, state: int) -> float | None:
        """Return when a state is left wherever the cap is, by an `after_ms` of its own; None if never."""
        exits_s = [
            t.when.value / 1000
            for t in self.program.states[state].transitions
            if t.when.when is When.AFTER and (t.only_if is None or t.only_if.when is When.ALWAYS)
        ]
        return min(exits_s, default=None)

    def stay_at_top_s(self, state: int) -> float | None:
        """Return when a lifting state is left by a cap at rest at the top; None if never."""
        source = self.program.states[state].velocity

        def wait_s(when: When, value: float) -> float | None:
            held = {
                When.ALWAYS: True,
                When.SHALLOWER_THAN: value > self.limits.top_mm,
                When.SLOWER_THAN: source is Velocity.CONTINUOUS and value > 0,
                When.RISEN_BY: value == 0,
                When.FALLEN_BY: value == 0,
            }.get(when, False)
            return value / 1000 if when is When.AFTER else 0.0 if held else None

        times_s = []
        for transition in self.program.states[state].transitions:
            waits = [wait_s(c.when, c.value) for c in transition.conditions]
            known = [wait for wait in waits if wait is not None]
            if len(known) == len(waits):
                times_s.append(max(known))
        return min(times_s, default=None)
