"""The tick in plain Python: slow, obvious, whole numbers only; the oracle of firmware/core.

Written from protocol/fdvv.toml and docs/explanation/controller.md. What the supervisor decides is passed in:
the mode of each tick, of which only the armed one renders, at the full force limit.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from fdvv.protocol.tables import NONE, Condition, Mode, Settings, State, Stroke, TickFlag, VelocitySource
from tests.support.core.arithmetic import ONE, Ratio, blend, clamp, inverse, part, product, ratio_of, scale
from tests.support.core.motion import PRESS, RELEASE, Position, Velocity
from tests.support.core.predictor import Predictor
from tests.support.core.program import Program


@dataclass
class Machine:
    """The program: its state, what it remembers, what it plays."""

    settings: Settings
    program: Program
    running: bool = False
    state: int = 0
    time_us: int = 0
    repeated: int = 0
    seen: list[int] = field(default_factory=list)
    offers: set[tuple[int, int]] = field(default_factory=set)
    reached: int = 0
    from_cN64: int = 0

    def now(self) -> State:
        return self.program.state(self.state)

    def enter(self, state: int, x: int, command: int) -> None:
        self.state, self.time_us, self.seen, self.from_cN64 = state, 0, [x], command
        self.due_ms = self.now().repeat_ms

    def tick(self, position: Position, velocity: Velocity, announced: int, tick: Tick) -> int:
        """Return the slot to play."""
        x, slots = position.um16, []
        lead_us = self.settings.vibration_latency_us + self.settings.tick_us // 2
        lead = product(ratio_of(lead_us), inverse(ratio_of(1000)))
        ahead = x + scale(velocity.continuous or 0, lead)
        if not self.running:
            self.enter(self.program.head.start_state, x, tick.command)
            slots.append(self.now().enter_slot)
            self.running, self.reached = True, ahead
        else:
            self.time_us += tick.elapsed * self.settings.tick_us
            self.seen.append(x)
            if position.turned:
                self.reached = ahead
        self.offers |= {(Condition.HOST_EVENT, event) for event in tick.events}
        if position.turned:
            turn = {PRESS: Condition.TURNED_TO_PRESS, RELEASE: Condition.TURNED_TO_RELEASE}[position.turned]
            self.offers.add((turn, 0))
        slots += self.change(x, self.chosen(velocity, announced), tick.command)
        slots += self.vibrate(position.stroke, ahead, self.chosen(velocity, announced))
        slots += self.repeat()
        return next((slot for slot in slots if slot != NONE), NONE)

    def chosen(self, velocity: Velocity, announced: int) -> int:
        """Return the velocity that chooses a row in this state."""
        source = self.now().velocity_source
        if source == VelocitySource.CONTINUOUS:
            return abs(velocity.continuous or 0)
        if source == VelocitySource.DECIDED and velocity.decided is not None:
            return velocity.decided
        return announced

    def change(self, x: int, velocity: int, command: int) -> list[int]:
        for t in self.program.transitions(self.now()):
            if self.holds(t.condition, t.value, x, velocity) and self.holds(
                t.guard, t.guard_value, x, velocity
            ):
                self.offers -= {offer(t.condition, t.value), offer(t.guard, t.guard_value)}
                self.enter(t.target, x, command)
                return [t.slot, self.now().enter_slot]
        self.offers = set()
        return []

    def holds(self, condition: int, value: int, x: int, velocity: int) -> bool:
        return {
            Condition.ALWAYS: True,
            Condition.DEEPER_THAN: x > value,
            Condition.SHALLOWER_THAN: x < value,
            Condition.FASTER_THAN: velocity > value,
            Condition.SLOWER_THAN: velocity < value,
            Condition.AFTER_MS: min(self.time_us // 1000, 2**31 - 1) >= value,
            Condition.RISEN_BY: max(self.seen) - x >= value,
            Condition.FALLEN_BY: x - min(self.seen) >= value,
        }.get(Condition(condition), offer(condition, value) in self.offers)

    def vibrate(self, stroke: str, ahead: int, velocity: int) -> list[int]:
        before, self.reached = (
            self.reached,
            max(self.reached, ahead) if stroke == PRESS else min(self.reached, ahead),
        )
        wrong = Stroke.RELEASE if stroke == PRESS else Stroke.PRESS
        return [
            v.slot
            for v in self.program.vibrations()
            if (before < v.at_um16 <= ahead if stroke == PRESS else ahead <= v.at_um16 < before)
            and v.stroke != wrong
            and v.states >> self.state & 1
            and v.slowest_mm_s16 <= velocity < v.fastest_mm_s16
        ]

    def repeat(self) -> list[int]:
        s, ms = self.now(), self.time_us // 1000
        if s.repeat_slot == NONE or not s.repeat_ms or ms < self.due_ms:
            return []
        self.due_ms += s.repeat_ms
        if self.due_ms <= ms:
            self.due_ms = ms + s.repeat_ms
        return [s.repeat_slot]

    def progress(self, whole_ms: int) -> int:
        if self.time_us >= whole_ms * 1000:
            return ONE
        return part(self.time_us, whole_ms * 1000)

    def force_cN64(self, position: Position, ahead: int, velocity: int) -> int:
        s = self.now()
        surface = s.press_surface if position.stroke == PRESS else s.release_surface
        bias = s.bias_cN64
        if s.bias_ms:
            bias = blend(s.bias_cN64, s.bias_end_cN64, self.progress(s.bias_ms))
        wanted = self.program.force_cN64(surface, ahead, velocity) + bias
        wanted = clamp(wanted, -32767, 32767)
        return blend(self.from_cN64, wanted, self.progress(s.fade_ms)) if s.fade_ms else wanted


def offer(condition: int, value: int) -> tuple[int, int]:
    """Name what a transition waits for; only host events are distinguished by their value."""
    return condition, value if condition == Condition.HOST_EVENT else 0


@dataclass
class Tick:
    """What a tick brings besides readings."""

    elapsed: int
    events: set[int]
    command: int


@dataclass
class Reference:
    """The whole core but its supervisor."""

    settings: Settings
    program: Program
    announced: int = 0
    command: int = 0
    resistance: int = 0
    events: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.position, self.velocity = Position(self.settings), Velocity(self.settings)
        self.predictor = Predictor(self.settings)
        self.machine = Machine(self.settings, self.program)
        self.announced = self.settings.announced_mm_s16

    def tick(self, inputs: dict[str, int], mode: int) -> dict[str, int]:
        """Return the values of fdvv.firmware.core.OUTPUTS."""
        s, elapsed = self.settings, max(inputs["elapsed_ticks"], 1)
        self.position.tick(inputs["sum"])
        self.velocity.tick(self.position, elapsed)
        self.predictor.tick(self.position.um16, elapsed)
        out = {"duty_q15": 0, "enable": 0, "slot": NONE, "key": 0}
        flags = 0
        if mode == Mode.ARMED:
            out, flags = self.render(inputs, elapsed)
        else:
            self.machine.running, self.machine.offers = False, set()
            self.command = self.resistance = 0
        self.events = set()
        flags |= TickFlag.RELEASE * (self.position.stroke == RELEASE) | TickFlag.LATE * (elapsed > 1)
        pulse = abs(s.stop_us_mm * self.program.head.travel_um16) + 8000
        pulse = pulse // 16000 if s.stop_us_mm >= 0 else -(pulse // 16000)
        felt = (inputs["force_counts"] - s.force_offset_counts) * s.force_gain_q14 >> 14
        return {
            **out,
            "stop_us": clamp(s.stop_zero_us + pulse, 400, 2600),
            "mode": mode,
            "displacement_um16": self.position.um16,
            "velocity_mm_s16": self.velocity.continuous or 0,
            "commanded_cN64": self.command,
            "force_cN64": clamp(felt, -32767, 32767),
            "state": self.machine.state,
            "flags": int(flags),
        }

    def render(self, inputs: dict[str, int], elapsed: int) -> tuple[dict[str, int], int]:
        m = self.machine
        before = clamp(self.command + self.resistance, -32767, 32767)
        slot = m.tick(self.position, self.velocity, self.announced, Tick(elapsed, self.events, before))
        wanted = m.force_cN64(self.position, self.ahead(), m.chosen(self.velocity, self.announced))
        self.resistance = clamp(self.predictor.resistance_cN64(), -32767, 32767) if self.predictor.on else 0
        flags = self.limit(wanted - self.resistance)
        duty = self.duty(inputs["supply_mV"])
        cut = clamp(duty, -self.settings.duty_limit_q15, self.settings.duty_limit_q15)
        state = m.now()
        known = {
            VelocitySource.ANNOUNCED: False,
            VelocitySource.DECIDED: self.velocity.decided is not None,
            VelocitySource.CONTINUOUS: self.velocity.continuous is not None,
        }[VelocitySource(state.velocity_source)]
        flags |= TickFlag.LIMITED * (cut != duty) | TickFlag.KEY_DOWN * (state.key != 0)
        flags |= TickFlag.VIBRATED * (slot != NONE) | TickFlag.VELOCITY_KNOWN * known
        return {"duty_q15": cut, "enable": 1, "slot": slot, "key": state.key}, flags

    def ahead(self) -> int:
        return self.predictor.ahead_um16() if self.predictor.on else self.position.um16

    def limit(self, wanted: int) -> int:
        """Limit, then slew; the limit does not fall here."""
        s = self.settings
        limited = clamp(wanted, -s.force_limit_cN64, s.force_limit_cN64)
        slewed = clamp(limited, self.command - s.slew_cN64_tick, self.command + s.slew_cN64_tick)
        self.command = slewed
        return TickFlag.LIMITED * (limited != wanted) | TickFlag.SLEWED * (slewed != limited)

    def duty(self, supply_mV: int) -> int:
        s = self.settings
        gain = product(ratio_of(s.duty_gain_q16), ratio_of(s.nominal_supply_mV))
        supply = inverse(ratio_of(clamp(supply_mV, s.supply_low_mV, s.supply_high_mV)))
        found = product(gain, supply)
        return scale(self.command, Ratio(found.mantissa, found.shift + 16))
