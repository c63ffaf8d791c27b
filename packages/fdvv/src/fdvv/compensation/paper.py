"""The paper's iterative compensation of one curve: eq. 2 and 3, best of rounds, average, smoothing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from fdvv.compensation.identification.balance import Delays
from fdvv.compensation.method import error_cN
from fdvv.compensation.presses import HOME_mm
from fdvv.compensation.tables import (
    BestPress,
    CurveState,
    GainSchedule,
    LearnedCurve,
    bump_kept_ratio,
    read_only,
    smooth,
)
from fdvv.errors import ModelError
from fdvv.force_text import force_number, force_text, force_unit
from fdvv.units import FloatArray

RIG_DELAYS = Delays(position_s=0.0005, command_s=0.002)
"""Delays of the paper's rig, from its parts: the position's demodulator and burst minus the force's filter;
compute, half a tick, the coil's inductance and the force's filter."""


@dataclass(frozen=True)
class PaperLaw:
    """Settings of the law u(p) += gain(error_k) * (target(p) - rendered(p)), learned per curve.

    Attributes
    ----------
    alpha : weight of the mean in error_k.
    gain : the proportion of each correction.
    bin_mm : width of the displacement bins.
    rounds, presses_per_round : independent runs, each from its own start; the best command of each
        enters the average.
    smoothing_mm : sigma of the Gaussian over the averaged table. The paper prints 1.2 mm, which erases
        the bump it wants to render; 1.2 bins (0.06 mm) keeps it.
    start : where a round starts: "target" the intended force, "average" the mean of the earlier rounds (the
        first from the target), "random" one level, half to
        all of the largest target (the paper's figure shows a random level).
    seed : of the random starts.
    delays : addition, off at ``Delays()``: known delays of the rig.
    filter_mm : addition, off at 0: sigma of a zero-phase Gaussian over the learned part (command minus
        target) after each press; keeps the law from learning what no two presses share.
    hold_ends : addition: outside the bins that a press visited between its guards, the correction of the
        nearest visited bin holds; else those bins learn nothing.
    hold_cN : addition, off at 0: least command in the first 0.1 mm, and anywhere in a start from the
        target. It carries the mover's weight and friction and keeps the resting cap out of the
        commands below zero that a moving one may need; else it sinks and no press can begin.

    The defaults are the law with the additions that suit the paper's rig; ``literal`` is the law as printed.
    Commands stay within the device's limit.
    """

    alpha: float = 0.7
    gain: GainSchedule = field(default_factory=GainSchedule)
    bin_mm: float = 0.05
    rounds: int = 4
    presses_per_round: int = 12
    smoothing_mm: float = 0.06
    start: Literal["target", "average", "random"] = "average"
    seed: int = 0
    delays: Delays = RIG_DELAYS
    filter_mm: float = 0.05
    hold_ends: bool = True
    hold_cN: float = 50.0

    def __post_init__(self) -> None:
        if not 0 <= self.alpha <= 1:
            raise ModelError(f"alpha must lie between 0 and 1, got {self.alpha}")
        if not self.bin_mm > 0:
            raise ModelError(f"bin_mm must be positive, got {self.bin_mm}")
        if self.rounds < 1 or self.presses_per_round < 1:
            raise ModelError(f"needs a round and a press, got {self.rounds}, {self.presses_per_round}")
        if not self.hold_cN >= 0:
            raise ModelError(f"hold_cN must be at least 0, got {self.hold_cN}")
        if not (self.smoothing_mm >= 0 and self.filter_mm >= 0):
            raise ModelError(f"sigmas must be at least 0, got {self.smoothing_mm}, {self.filter_mm}")
        if self.start not in ("target", "average", "random"):
            raise ModelError(f"start must be target, average or random, got {self.start!r}")

    @classmethod
    def literal(cls, **settings: object) -> PaperLaw:
        """Return the law as printed, without additions; smoothing stays at 1.2 bins unless given."""
        plain = {"start": "random", "delays": Delays(), "filter_mm": 0.0, "hold_ends": False, "hold_cN": 0.0}
        return cls(**{**plain, **settings})  # type: ignore[arg-type]

    @property
    def additions(self) -> tuple[str, ...]:
        """What these settings add to the printed law."""
        names = []
        if self.delays != Delays():
            names.append(
                f"shift for known delays ({self.delays.position_s * 1e3:g} ms position, "
                f"{self.delays.command_s * 1e3:g} ms command)"
            )
        if self.filter_mm:
            names.append(f"zero-phase filter of the learned part, sigma {self.filter_mm:g} mm")
        if self.hold_ends:
            names.append("corrections held beyond the visited bins")
        if self.hold_cN:
            names.append(f"at least {force_text(self.hold_cN)} in the first {HOME_mm:g} mm")
        if self.start != "random":
            names.append(f"rounds start from the {self.start}")
        return tuple(names)

    def init(self, target_cN: FloatArray, grid_mm: FloatArray, limit_cN: float) -> CurveState:
        """Return the first state of a curve: target_cN, grid_mm (n,); limit_cN bounds the command."""
        if target_cN.shape != grid_mm.shape or grid_mm.size < 2:
            raise ModelError(f"target and grid must pair up, got {target_cN.shape}, {grid_mm.shape}")
        if not limit_cN > 0:
            raise ModelError(f"limit_cN must be positive, got {limit_cN}")
        state = CurveState(read_only(grid_mm), read_only(target_cN), read_only(target_cN), limit_cN)
        return replace(state, command_cN=self._start(state))

    def step(self, measured_cN: FloatArray, state: CurveState) -> tuple[FloatArray, CurveState]:
        """Learn from one press: measured_cN (n,) rendered with the current command, NaN where unknown.

        Returns the next command and state; after the last press of a round, the next round's start.
        Raises ModelError if nothing was measured.
        """
        error = error_cN(state.target_cN, measured_cN, self.alpha)
        best = state.best
        if best is None or error < best.error_cN:
            off = np.abs(state.target_cN - measured_cN)
            best = BestPress(error, float(np.nanmean(off)), float(np.nanmax(off)), state.command_cN)
        errors = (*state.errors_cN, error)
        if len(errors) % self.presses_per_round:
            command = self._correct(measured_cN, error, state)
            return command, replace(state, command_cN=command, errors_cN=errors, best=best)
        state = replace(state, errors_cN=errors, best=None, rounds=(*state.rounds, best))
        command = self._start(state)
        return command, replace(state, command_cN=command)

    def is_finished(self, state: CurveState) -> bool:
        """Return whether all rounds are done."""
        return len(state.rounds) >= self.rounds

    def done(self, state: CurveState) -> LearnedCurve:
        """Return the smoothed average of the rounds' best commands; valid at any time."""
        bests = (*state.rounds, *([state.best] if state.best else []))
        if not bests:
            nan, sentence = float("nan"), "no press was learned from; the target itself"
            return LearnedCurve(state.command_cN, (), nan, nan, sentence)
        step_mm = float(state.grid_mm[1] - state.grid_mm[0])
        table = smooth(np.mean([b.command_cN for b in bests], axis=0), self.smoothing_mm, step_mm)
        return LearnedCurve(
            self._limit(table, state),
            state.errors_cN,
            float(np.mean([b.mean_error_cN for b in bests])),
            float(np.mean([b.max_error_cN for b in bests])),
            self._sentence(state, bests, step_mm),
        )

    def _correct(self, measured_cN: FloatArray, error: float, state: CurveState) -> FloatArray:
        visited = np.flatnonzero(np.isfinite(measured_cN))
        correction = self.gain.gain(error) * (state.target_cN - measured_cN)[visited]
        ends = {} if self.hold_ends else {"left": 0.0, "right": 0.0}
        change = np.interp(np.arange(measured_cN.size), visited, correction, **ends)
        learned = state.command_cN + change - state.target_cN
        step_mm = float(state.grid_mm[1] - state.grid_mm[0])
        command = state.target_cN + smooth(learned, self.filter_mm, step_mm)
        return self._limit(command, state)

    def _limit(self, command_cN: FloatArray, state: CurveState) -> FloatArray:
        home = state.grid_mm <= HOME_mm if self.hold_cN else False
        held = np.where(home, np.maximum(command_cN, self.hold_cN), command_cN)
        return read_only(np.clip(held, -state.limit_cN, state.limit_cN))

    def _start(self, state: CurveState) -> FloatArray:
        if self.start == "random":
            draw = np.random.default_rng((self.seed, len(state.rounds)))
            level = draw.uniform(0.5, 1.0) * float(np.abs(state.target_cN).max())
            return self._limit(np.full(state.grid_mm.size, level), state)
        if self.start == "average" and state.rounds:
            # these are within the limits, and so is their mean
            return read_only(np.mean([b.command_cN for b in state.rounds], axis=0))
        return self._limit(np.maximum(state.target_cN, self.hold_cN or -np.inf), state)

    def _sentence(self, state: CurveState, bests: tuple[BestPress, ...], step_mm: float) -> str:
        kept = bump_kept_ratio(state.grid_mm, state.target_cN, self.smoothing_mm)
        bump = "the target has no bump" if kept is None else f"keeps {kept:.0%} of the target's bump"
        ends = ", ".join(force_number(b.error_cN, ".1f") for b in bests)
        return (
            f"error_k {force_text(state.errors_cN[0], '.1f')} at press 1, best of each round {ends} "
            f"{force_unit()}; "
            f"smoothing sigma {self.smoothing_mm:g} mm ({bump})"
        )


HOLDS_cN = (50.0, 65.0, 80.0)
"""To be tried in turn: a smaller one renders better, a larger one holds up heavier caps."""
FASTER_LOOP_s = 0.0005
"""Loops with a shorter period have the delays of the 4 kHz rig."""
FAST_DELAYS = Delays(position_s=0.0003, command_s=0.00125)


def tuned_paper_law(
    presses: Literal[20, 240] = 240,
    tick_s: float = 0.001,
    additions: bool = True,
    hold_cN: float = HOLDS_cN[0],
) -> PaperLaw:
    """Return the settings of the paper's law that did best on random rigs, for a budget of presses.

    presses : over four velocities together: 20 (one round of 5 each) or the paper's 240.
    tick_s : period of the loop.
    additions : with the additions of ``PaperLaw``; else ``PaperLaw.literal``.
    hold_cN : with additions, the least command in the first 0.1 mm. The best of HOLDS_cN depends
        on the mover's weight: the one whose curves end with the smallest error as the rig measures it.

    Tuned on the twin (simulated): rigs and fingers drawn with seeds 100 to 119, each with one of the six
    built-in buttons, at 50 to 200 mm/s, against fresh presses in true displacement, at 1 and 4 kHz.
    Results: docs/explanation/paper-law.md. Many settings are equal within its noise.
    """
    budget: dict[str, Any] = (
        {"rounds": 1, "presses_per_round": 5} if presses == 20 else {"rounds": 4, "presses_per_round": 15}
    )
    if not additions:
        return PaperLaw.literal(gain=GainSchedule(most=0.6 if presses == 20 else 0.4), **budget)
    if presses == 20:
        budget |= {"gain": GainSchedule(most=0.8), "smoothing_mm": 0.0}
    delays = RIG_DELAYS if tick_s > FASTER_LOOP_s else FAST_DELAYS
    return PaperLaw(delays=delays, hold_cN=hold_cN, **budget)
