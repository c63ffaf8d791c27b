"""What a program means, slowly and plainly: one tick after the other, straight from the words.

Written from the documents of programs, not from the firmware. It is given where the cap is sensed and how
fast it goes, and tells state, key, what is played and which force is wanted, before any limit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.program.condition import Condition, When
from fdvv.program.program import Program, State, Velocity
from fdvv.protocol.tables import Settings

UM16_PER_MM = 16_000


@dataclass(frozen=True)
class Tick:
    """What a tick gave."""

    state: str
    key: int
    signal: str | None
    force_cN: float


@dataclass
class Interpreter:
    """One run of a program."""

    program: Program
    settings: Settings = field(default_factory=Settings)
    released: bool = False
    turn_um16: int | None = None
    state: State | None = None
    ticks_in_state: int = 0
    deepest_um16: int = 0
    highest_um16: int = 0
    last_cN: float = 0.0
    from_cN: float = 0.0
    due_ms: float = 0.0
    turns: set[When] = field(default_factory=set)
    events: set[int] = field(default_factory=set)

    def tick(self, x_um16: int, speed_mm_s: float = 0.0, events: Sequence[int] = ()) -> Tick:
        """Advance by one tick at a sensed displacement and a speed without sign."""
        signal = None
        turned = self._direction(x_um16)
        if self.state is None:
            signal = self._enter(self.program.start, x_um16)
        else:
            self.ticks_in_state += 1
            self.deepest_um16 = max(self.deepest_um16, x_um16)
            self.highest_um16 = min(self.highest_um16, x_um16)
        if turned:
            self.turns.add(turned)
        self.events |= set(events)
        assert self.state is not None
        for transition in self.state.transitions:
            wanted = [transition.when] + ([transition.only_if] if transition.only_if else [])
            if all(self._holds(c, x_um16, speed_mm_s) for c in wanted):
                for condition in wanted:
                    self.turns.discard(condition.when)
                    if condition.when is When.HOST_EVENT:
                        self.events.discard(int(condition.value))
                own = self._enter(transition.to, x_um16)
                signal = transition.signal or own
                break
        else:
            self.turns, self.events = set(), set()
        if self.state.repeat_signal and self._ms() >= self.due_ms:
            self.due_ms += self.state.repeat_ms
            signal = signal or self.state.repeat_signal
        return Tick(self.state.name, self.state.key, signal, self._force_cN(x_um16, speed_mm_s))

    def commanded(self, force_cN: float) -> float:
        """Let the force be limited and slewed, as the rig does; what it was is remembered for fades."""
        limit, slew = self.settings.force_limit_cN64 / 64, self.settings.slew_cN64_tick / 64
        force_cN = min(max(force_cN, -limit), limit)
        self.last_cN = min(max(force_cN, self.last_cN - slew), self.last_cN + slew)
        return self.last_cN

    def _direction(self, x_um16: int) -> When | None:
        if self.turn_um16 is None:
            self.turn_um16 = x_um16
        far = x_um16 - self.turn_um16
        if not self.released:
            self.turn_um16 = max(self.turn_um16, x_um16)
            if far < -self.settings.reversal_um16:
                self.released, self.turn_um16 = True, x_um16
                return When.TURNED_TO_RELEASE
        else:
            self.turn_um16 = min(self.turn_um16, x_um16)
            if far > self.settings.reversal_um16 or x_um16 < self.settings.rearm_um16:
                self.released, self.turn_um16 = False, x_um16
                return When.TURNED_TO_PRESS
        return None

    def _enter(self, name: str, x_um16: int) -> str | None:
        self.state = self.program.state(name)
        self.ticks_in_state = 0
        self.deepest_um16 = self.highest_um16 = x_um16
        self.from_cN = self.last_cN
        self.due_ms = float(self.state.repeat_ms)
        return self.state.enter_signal

    def _ms(self) -> float:
        return self.ticks_in_state * self.settings.tick_us / 1000

    def _holds(self, condition: Condition, x_um16: int, speed_mm_s: float) -> bool:
        um16 = round(condition.value * UM16_PER_MM)
        return {
            When.ALWAYS: True,
            When.DEEPER_THAN: x_um16 > um16,
            When.SHALLOWER_THAN: x_um16 < um16,
            When.TURNED_TO_PRESS: When.TURNED_TO_PRESS in self.turns,
            When.TURNED_TO_RELEASE: When.TURNED_TO_RELEASE in self.turns,
            When.FASTER_THAN: speed_mm_s > condition.value,
            When.SLOWER_THAN: speed_mm_s < condition.value,
            When.AFTER: self._ms() >= condition.value,
            When.HOST_EVENT: condition.value in self.events,
            When.RISEN_BY: self.deepest_um16 - x_um16 >= um16,
            When.FALLEN_BY: x_um16 - self.highest_um16 >= um16,
        }[condition.when]

    def _force_cN(self, x_um16: int, speed_mm_s: float) -> float:
        assert self.state is not None
        surface = self.program.surface(self.state.release if self.released else self.state.press)
        force_cN = surface.force_at_cN(x_um16 / UM16_PER_MM, speed_mm_s)
        bias_cN = self.state.bias_cN
        if self.state.bias_ms:
            part = min(1.0, self._ms() / self.state.bias_ms)
            bias_cN += part * (self.state.bias_end_cN - bias_cN)
        force_cN += bias_cN
        if self.state.fade_ms:
            part = min(1.0, self._ms() / self.state.fade_ms)
            force_cN = self.from_cN + part * (force_cN - self.from_cN)
        return force_cN


def interpret(
    program: Program,
    sensed_um16: np.ndarray[tuple[int], np.dtype[np.int64]],
    speeds_mm_s: np.ndarray[tuple[int], np.dtype[np.float64]],
    events: Mapping[int, int],
    settings: Settings,
) -> list[Tick]:
    """Run a program over sensed displacements; events is tick to number. Forces are after the limits."""
    machine = Interpreter(program, settings)
    found = []
    for i, (x, speed) in enumerate(zip(sensed_um16.tolist(), speeds_mm_s.tolist(), strict=True)):
        continuous = machine.state is None or machine.state.velocity is Velocity.CONTINUOUS
        tick = machine.tick(x, speed if continuous else 100.0, [events[i]] if i in events else [])
        found.append(Tick(tick.state, tick.key, tick.signal, machine.commanded(tick.force_cN)))
    return found
