"""The paper's iterative compensation of one curve: eq. 2 and 3, best of rounds, average, smoothing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from fdvv.compensate._bins import bump_kept_ratio, smooth
from fdvv.compensate._curve_state import Best, Learned, State, better, frozen
from fdvv.compensate._error import error_cN
from fdvv.compensate._gain import GainSchedule
from fdvv.compensate._observe import Delays
from fdvv.compensate._strokes import HOME_mm
from fdvv.errors import ModelError
from fdvv.units import FloatArray

RIG_DELAYS = Delays(position_s=0.0005, command_s=0.002)
"""Delays of the paper's rig, from its parts: the position's demodulator and burst less the force's filter;
compute, half a tick, the coil's inductance and the force's filter."""


@dataclass(frozen=True)
class PaperLaw:
    """Settings of the law u(p) += gain(error_k) * (target(p) - felt(p)), learned per curve.

    Attributes
    ----------
    alpha : weight of the mean in error_k.
    gain : the proportion of each correction.
    bin_mm : width of the bins of displacement.
    rounds, presses_per_round : independent runs, each from its own start; the best command of each run
        enters the average.
    smoothing_mm : sigma of the Gaussian over the averaged table. The paper prints 1.2 mm, which erases
        the bump it wants to render; 1.2 bins (0.06 mm) keeps it.
    start : where a round starts: "target" the force wanted, "average" the mean of the rounds before (the
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
        """Make the law as printed, without additions; the smoothing stays at 1.2 bins unless told."""
        plain = {"start": "random", "delays": Delays(), "filter_mm": 0.0, "hold_ends": False, "hold_cN": 0.0}
        return cls(**{**plain, **settings})  # type: ignore[arg-type]

    @property
    def additions(self) -> tuple[str, ...]:
        """Name what these settings add to the printed law."""
        found = []
        if self.delays != Delays():
            found.append(
                f"shift for known delays ({self.delays.position_s * 1e3:g} ms position, "
                f"{self.delays.command_s * 1e3:g} ms command)"
            )
        if self.filter_mm:
            found.append(f"zero-phase filter of the learned part, sigma {self.filter_mm:g} mm")
        if self.hold_ends:
            found.append("corrections held beyond the visited bins")
        if self.hold_cN:
            found.append(f"at least {self.hold_cN:g} cN in the first {HOME_mm:g} mm")
        if self.start != "random":
            found.append(f"rounds start from the {self.start}")
        return tuple(found)

    def init(self, target_cN: FloatArray, grid_mm: FloatArray, limit_cN: float) -> State:
        """Begin a curve: target_cN and grid_mm (n,), limit_cN the largest command of either sign."""
        if target_cN.shape != grid_mm.shape or grid_mm.size < 2:
            raise ModelError(f"target and grid must pair up, got {target_cN.shape}, {grid_mm.shape}")
        if not limit_cN > 0:
            raise ModelError(f"limit_cN must be positive, got {limit_cN}")
        state = State(frozen(grid_mm), frozen(target_cN), frozen(target_cN), limit_cN)
        return replace(state, command_cN=self._start(state))

    def step(self, measured_cN: FloatArray, state: State) -> tuple[FloatArray, State]:
        """Learn from one press: measured_cN (n,) felt with the current command, NaN where unknown.

        Gives the next command and state; after the last press of a round that is the next round's start.
        Raises ModelError where nothing was measured.
        """
        error = error_cN(state.target_cN, measured_cN, self.alpha)
        best = better(state, measured_cN, error)
        errors = (*state.errors_cN, error)
        if len(errors) % self.presses_per_round:
            command = self._correct(measured_cN, error, state)
            state = replace(state, command_cN=command, errors_cN=errors, best=best)
        else:
            rounds = (*state.rounds, best)
            state = replace(state, errors_cN=errors, best=None, rounds=rounds)
            state = replace(state, command_cN=self._start(state))
        return state.command_cN, state

    def finished(self, state: State) -> bool:
        """Tell whether all rounds are done."""
        return len(state.rounds) >= self.rounds

    def done(self, state: State) -> Learned:
        """Average the best commands of the rounds, smooth, and say how it went; works at any time."""
        bests = (*state.rounds, *([state.best] if state.best else []))
        if not bests:
            nan = float("nan")
            return Learned(state.command_cN, (), nan, nan, "no press was learned from; the target itself")
        step_mm = float(state.grid_mm[1] - state.grid_mm[0])
        table = smooth(np.mean([b.command_cN for b in bests], axis=0), self.smoothing_mm, step_mm)
        return Learned(
            self._limited(table, state),
            state.errors_cN,
            float(np.mean([b.mean_error_cN for b in bests])),
            float(np.mean([b.max_error_cN for b in bests])),
            self._sentence(state, bests, step_mm),
        )

    def _correct(self, measured_cN: FloatArray, error: float, state: State) -> FloatArray:
        """Apply eq. 2 to the bins visited, and the additions."""
        visited = np.flatnonzero(np.isfinite(measured_cN))
        correction = self.gain.gain(error) * (state.target_cN - measured_cN)[visited]
        ends = {} if self.hold_ends else {"left": 0.0, "right": 0.0}
        change = np.interp(np.arange(measured_cN.size), visited, correction, **ends)
        learned = state.command_cN + change - state.target_cN
        step_mm = float(state.grid_mm[1] - state.grid_mm[0])
        command = state.target_cN + smooth(learned, self.filter_mm, step_mm)
        return self._limited(command, state)

    def _limited(self, command_cN: FloatArray, state: State) -> FloatArray:
        """Hold the cap up at its home and stay within the device's limit."""
        home = state.grid_mm <= HOME_mm if self.hold_cN else False
        held = np.where(home, np.maximum(command_cN, self.hold_cN), command_cN)
        return frozen(np.clip(held, -state.limit_cN, state.limit_cN))

    def _start(self, state: State) -> FloatArray:
        """Give the command a round starts from."""
        if self.start == "random":
            draw = np.random.default_rng((self.seed, len(state.rounds)))
            level = draw.uniform(0.5, 1.0) * float(np.abs(state.target_cN).max())
            return self._limited(np.full(state.grid_mm.size, level), state)
        if self.start == "average" and state.rounds:
            return frozen(np.mean([b.command_cN for b in state.rounds], axis=0))
        return self._limited(np.maximum(state.target_cN, self.hold_cN or -np.inf), state)

    def _sentence(self, state: State, bests: tuple[Best, ...], step_mm: float) -> str:
        kept = bump_kept_ratio(state.grid_mm, state.target_cN, self.smoothing_mm)
        bump = "the target has no bump" if kept is None else f"keeps {kept:.0%} of the target's bump"
        ends = ", ".join(f"{b.error_cN:.1f}" for b in bests)
        return (
            f"error_k {state.errors_cN[0]:.1f} cN at press 1, best of each round {ends} cN; "
            f"smoothing sigma {self.smoothing_mm:g} mm ({bump})"
        )
