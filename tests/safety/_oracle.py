"""The supervisor again, slow and plain: what it must do, in exact Python numbers.

Written from protocol/fdvv.toml and docs/explanation/safety.md, not from the C code.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache

from fdvv.firmware.core import CoreRequest
from fdvv.protocol.tables import BoardLimits, Evidence, Fault, Mode, Refusal, Settings
from tests.safety._thermistor import Thermistor

WATCHDOG, BROWN_OUT, OUTPUT, VIBRATION = 1, 2, 4, 8
BOUNDLESS = 2**31 - 1


@dataclass(frozen=True)
class Inputs:
    """What a board gives in a tick (firmware/core/inputs.h), and what the core found from it."""

    time_us: int = 0
    sum: int = 50_000
    lowest: int = 2000
    highest: int = 2000
    elapsed_ticks: int = 1
    supply_mV: int = 12_000
    force_counts: int = 0
    thermistor_counts: int = 0
    board: int = 0
    displacement_um16: int = 0
    force_cN64: int = 0
    commanded_cN64: int = 0
    state: int = 0


@dataclass(frozen=True)
class Scene:
    """All that a condition may look at."""

    settings: Settings
    inputs: Inputs
    moved_um16: int
    jump_um16: int
    equal_sums: int
    heat_K: int
    silent_us: int
    host_heard: bool
    settings_right: bool
    checksums: tuple[int, int]
    mode: int
    thermistor: Thermistor


@dataclass(frozen=True)
class Rule:
    """One fault: its condition and evidence, when it is looked for and cleared, whether it stops."""

    fault: Fault
    holds: Callable[[Scene], bool]
    evidence: Callable[[Scene], tuple[int, int]] = lambda _scene: (0, 0)
    armed_only: bool = False
    clear: str = "gone"
    stops: bool = True


NOTHING_SEEN = Inputs()
NOTHING_LATCHED = Evidence(
    time_us=0, tick=0, value=0, bound=0, displacement_um16=0, commanded_cN64=0, state=0, mode=0
)


def board_bit(bit: int) -> Callable[[Scene], bool]:
    """Return the condition that the board reports this."""
    return lambda scene: bool(scene.inputs.board & bit)


FIRST_RULES = (
    Rule(
        Fault.POSITION_LOW,
        lambda s: s.inputs.lowest < s.settings.reading_low,
        lambda s: (s.inputs.lowest, s.settings.reading_low),
    ),
    Rule(
        Fault.POSITION_HIGH,
        lambda s: s.inputs.highest > s.settings.reading_high,
        lambda s: (s.inputs.highest, s.settings.reading_high),
    ),
    Rule(
        Fault.POSITION_STUCK,
        lambda s: s.equal_sums >= s.settings.stuck_ticks,
        lambda s: (s.equal_sums, s.settings.stuck_ticks),
        armed_only=True,
    ),
    Rule(
        Fault.POSITION_JUMP,
        lambda s: s.moved_um16 > s.jump_um16,
        lambda s: (s.moved_um16, s.jump_um16),
        armed_only=True,
    ),
    Rule(
        Fault.OVER_FORCE,
        lambda s: s.settings.force_gain_q14 != 0 and abs(s.inputs.force_cN64) > s.settings.over_force_cN64,
        lambda s: (abs(s.inputs.force_cN64), s.settings.over_force_cN64),
        armed_only=True,
    ),
    Rule(
        Fault.OVER_HEAT,
        lambda s: s.heat_K >= s.settings.heat_limit_K,
        lambda s: (s.heat_K, s.settings.heat_limit_K),
    ),
    Rule(
        Fault.SUPPLY_LOW,
        lambda s: s.inputs.supply_mV < s.settings.supply_low_mV,
        lambda s: (s.inputs.supply_mV, s.settings.supply_low_mV),
    ),
    Rule(
        Fault.SUPPLY_HIGH,
        lambda s: s.inputs.supply_mV > s.settings.supply_high_mV,
        lambda s: (s.inputs.supply_mV, s.settings.supply_high_mV),
    ),
    Rule(
        Fault.HOST_LOST,
        lambda s: not s.host_heard,
        lambda s: (s.silent_us, 1000 * s.settings.host_timeout_ms),
        armed_only=True,
    ),
    Rule(Fault.IMAGE_CORRUPT, lambda s: False, clear="any"),
    Rule(Fault.WATCHDOG, board_bit(WATCHDOG), clear="any"),
    Rule(
        Fault.BROWN_OUT,
        board_bit(BROWN_OUT),
        lambda s: (s.inputs.supply_mV, s.settings.supply_low_mV),
        clear="any",
    ),
    Rule(
        Fault.LATE,
        lambda s: s.inputs.elapsed_ticks > s.settings.late_ticks,
        lambda s: (s.inputs.elapsed_ticks, s.settings.late_ticks),
        armed_only=True,
    ),
    Rule(Fault.OUTPUT, board_bit(OUTPUT)),
    Rule(Fault.SETTINGS_CORRUPT, lambda s: not s.settings_right, lambda s: s.checksums),
    Rule(Fault.VIBRATION_BOARD, board_bit(VIBRATION), stops=False),
    Rule(Fault.INTERNAL, lambda s: s.mode > Mode.FAULT, lambda s: (s.mode, Mode.FAULT), clear="never"),
)
BEAD_RULES = tuple(
    Rule(
        fault,
        lambda s, fault=fault: s.thermistor.fault is fault,  # type: ignore[misc]
        lambda s: s.thermistor.evidence,
    )
    for fault in (Fault.THERMISTOR_OPEN, Fault.THERMISTOR_SHORT, Fault.THERMISTOR_JUMP, Fault.THERMISTOR_COLD)
)
RULES: tuple[Rule, ...] = FIRST_RULES + BEAD_RULES
RULE_OF = {rule.fault: rule for rule in RULES}

ALLOWED = {
    (Mode.BOOT, CoreRequest.BOOTED): Mode.IDLE,
    (Mode.IDLE, CoreRequest.TEST): Mode.SELFTEST,
    (Mode.SELFTEST, CoreRequest.TESTED): Mode.IDLE,
    (Mode.IDLE, CoreRequest.ARM): Mode.ARMED,
    (Mode.ARMED, CoreRequest.DISARM): Mode.IDLE,
    (Mode.DERATED, CoreRequest.DISARM): Mode.IDLE,
    (Mode.FAULT, CoreRequest.CLEAR): Mode.IDLE,
}


def signed(word: int) -> int:
    """Read a 32-bit word as a signed number."""
    return (word + 2**31) % 2**32 - 2**31


@lru_cache(maxsize=8)
def checksum(settings: Settings) -> int:
    """Rotate right by one and add, word after word."""
    packed, total = settings.pack(), 0
    for at in range(0, len(packed), 4):
        rotated = total // 2 + (total % 2) * 2**31
        total = (rotated + int.from_bytes(packed[at : at + 4], "little")) % 2**32
    return total


@dataclass
class Supervisor:
    """The state, and the questions and ticks that change it. usable: whether settings may be armed with."""

    usable: Callable[[Settings], bool]
    limits: BoardLimits
    mode: int = Mode.BOOT
    fault: Fault = Fault.NONE
    faults: int = 0
    evidence: Evidence = field(default_factory=lambda: NOTHING_LATCHED)
    tick: int = 0
    now: Inputs = field(default_factory=lambda: NOTHING_SEEN)
    present: frozenset[Fault] = frozenset()
    meant: int = 0
    heat_K_q48: int = 0
    host_seen_us: int = 0
    host_heard: bool = False
    last_sum: int = 0
    equal_sums: int = 0
    last_um16: int | None = None
    end_K_q16: int = 0
    heating_q32: int = 0
    cooling_q32: int = 0
    rise_K: int = 0
    late_K_q16: int = 0
    slope_q8: int = 0
    thermistor: Thermistor = field(default_factory=Thermistor)

    @property
    def rendering(self) -> bool:
        """Whether force may be given."""
        return self.mode in (Mode.ARMED, Mode.DERATED)

    def settings(self, settings: Settings) -> None:
        """Mean these settings."""
        self.meant = checksum(settings)
        self.last_um16 = None
        self.thermistor.set(self.limits, settings, self.heating_q32)
        quick, slow = sorted(1000 * source.heat_time_ms for source in (settings, self.limits))
        self.heating_q32 = settings.tick_us * 2**32 // quick + 1
        self.cooling_q32 = settings.tick_us * 2**32 // (slow + settings.tick_us)
        self.rise_K = max(settings.full_duty_rise_K, self.limits.full_duty_rise_K)
        self.late_K_q16 = min(self._highest_K() * 2**16 * (16_000 * 2**32 // quick) // 2**32 + 1, 2**17)
        self.slope_q8 = 256 * settings.force_limit_cN64 // (settings.heat_limit_K - settings.derate_start_K)

    def ask(self, settings: Settings, ask: int, number: int) -> Refusal:
        """Change the mode or refuse."""
        if ask >= len(CoreRequest):
            return Refusal.BAD_VALUE
        if self.mode > Mode.FAULT:
            self.found(Fault.INTERNAL, self.mode, Mode.FAULT)
        if ask == CoreRequest.DISARM and not self.rendering:
            return Refusal.NONE
        if ask == CoreRequest.CLEAR:
            return self._clear(number)
        target = ALLOWED.get((Mode(self.mode), CoreRequest(ask)))
        if target is None:
            return {Mode.FAULT: Refusal.FAULT_LATCHED, Mode.SELFTEST: Refusal.BUSY}.get(
                Mode(self.mode), Refusal.WRONG_MODE
            )
        if ask == CoreRequest.ARM:
            self.equal_sums = 0
            if not self.usable(settings):
                return Refusal.BAD_VALUE
        self.mode = target
        return Refusal.NONE

    def _clear(self, number: int) -> Refusal:
        if self.fault is Fault.NONE or number != self.fault:
            return Refusal.BAD_VALUE
        rule = RULE_OF[self.fault]
        if rule.clear == "never" or (rule.clear == "gone" and self.fault in self.present):
            return Refusal.FAULT_LATCHED
        self.fault = Fault.NONE
        self.mode = ALLOWED.get((Mode(self.mode), CoreRequest.CLEAR), self.mode)
        return Refusal.NONE

    def host(self, time_us: int) -> None:
        """Hear the host."""
        self.host_seen_us, self.host_heard = time_us, True

    def check(self, settings: Settings, inputs: Inputs) -> None:
        """Look at one tick."""
        scene = self._scene(settings, inputs)
        held = frozenset(
            rule.fault for rule in RULES if rule.holds(scene) and (self.rendering or not rule.armed_only)
        )
        fresh = held - self.present
        self.present = held
        self.faults = min(65535, self.faults + len(fresh))
        open_again = {f for f in held if f in fresh or RULE_OF[f].clear != "any"}
        reasons = sorted(f for f in open_again if self._becomes_reason(f))
        stops = [f for f in reasons if RULE_OF[f].stops]
        if reasons:
            first = (stops or reasons)[0]
            value, bound = RULE_OF[first].evidence(scene)
            self._latch(first, value, bound)

    def _scene(self, settings: Settings, inputs: Inputs) -> Scene:
        ticks = max(1, inputs.elapsed_ticks)
        moved = 0 if self.last_um16 is None else abs(inputs.displacement_um16 - self.last_um16)
        self.equal_sums = (self.equal_sums + 1) % 65536 if inputs.sum == self.last_sum else 0
        self.last_sum, self.last_um16 = inputs.sum, inputs.displacement_um16
        silent = signed(inputs.time_us - self.host_seen_us)
        self.host_heard &= silent <= 1000 * settings.host_timeout_ms
        self.tick, self.now = (self.tick + ticks) % 2**32, inputs
        sums = checksum(settings), self.meant
        return Scene(
            settings=settings,
            inputs=inputs,
            moved_um16=min(moved, BOUNDLESS),
            jump_um16=min(settings.jump_um16 * ticks, BOUNDLESS),
            equal_sums=self.equal_sums,
            heat_K=self.heat_K_q48 >> 48,
            silent_us=silent,
            host_heard=self.host_heard,
            settings_right=sums[0] == sums[1],
            checksums=(signed(sums[0]), signed(sums[1])),
            mode=self.mode,
            thermistor=self.thermistor,
        )

    def _becomes_reason(self, fault: Fault) -> bool:
        if self.mode == Mode.FAULT:
            return False
        return RULE_OF[fault].stops or self.fault is Fault.NONE

    def _latch(self, fault: Fault, value: int, bound: int) -> None:
        self.evidence = Evidence(
            time_us=self.now.time_us,
            tick=self.tick,
            value=value,
            bound=bound,
            displacement_um16=self.now.displacement_um16,
            commanded_cN64=self.now.commanded_cN64,
            state=self.now.state,
            mode=min(self.mode, Mode.FAULT),
        )
        self.fault = fault
        if RULE_OF[fault].stops:
            self.mode = Mode.FAULT

    def found(self, number: int, value: int, bound: int) -> None:
        """Take a fault found elsewhere."""
        known = 0 < number < len(Fault)
        fault = Fault(number) if known else Fault.INTERNAL
        self.faults = min(65535, self.faults + 1)
        if self._becomes_reason(fault):
            self._latch(fault, value if known else number, bound)

    def limit_cN64(self, settings: Settings) -> int:
        """Return the largest allowed force."""
        if not self.rendering:
            return 0
        heat, start, end = (
            (self.heat_K_q48 >> 32) + self.late_K_q16,
            settings.derate_start_K * 2**16,
            settings.heat_limit_K * 2**16,
        )
        if heat >= start:
            self.mode = Mode.DERATED
        elif 16 * heat < 15 * start:
            self.mode = Mode.ARMED
        if heat <= start:
            return settings.force_limit_cN64
        return max(0, (end - heat) // 256 * self.slope_q8 // 65536)

    def heat(self, duty_q15: int, supply_mV: int, elapsed_ticks: int) -> None:
        """Let missed ticks warm at the last duty, then one tick warm or cool at this one."""
        missed = max(0, elapsed_ticks - 1)
        if missed and self.end_K_q16 > self.heat_K_q48 >> 32:
            self._warm(missed)
        self.end_K_q16 = self._end_K_q16(abs(duty_q15), supply_mV)
        way_K_q16 = self.end_K_q16 - (self.heat_K_q48 >> 32)
        if way_K_q16 > 0:
            self._warm(1)
        else:
            self.heat_K_q48 += way_K_q16 * self.cooling_q32

    def read_thermistor(self, counts: int, elapsed_ticks: int) -> None:
        """Bound the heat by its reading, where it is fitted and due."""
        if self.thermistor.fitted and self.thermistor.tick(self.end_K_q16, max(1, elapsed_ticks)):
            heat = (self.heat_K_q48 >> 32) + 1
            self.heat_K_q48 = self.thermistor.sample(counts, heat, self.heating_q32) << 32

    def kept(self) -> tuple[int, int]:
        """Return what a board keeps over a reset: the heat and a kelvin, and its complement."""
        heat = ((self.heat_K_q48 >> 32) + 2**16) % 2**32
        return heat, 2**32 - 1 - heat

    def resume(self, heat_K_q16: int, check: int) -> None:
        """Go on after a reset; with nothing kept, as warm as a coil can be."""
        if heat_K_q16 + check == 2**32 - 1:
            self.heat_K_q48 = heat_K_q16 * 2**32
        else:
            self.heat_K_q48 = (self.limits.heat_limit_K * 2**16 - 1) * 2**32

    def _warm(self, ticks: int) -> None:
        part_q32 = ticks * self.heating_q32
        if part_q32 >= 2**32:
            self.heat_K_q48 = self.end_K_q16 * 2**32
        else:
            self.heat_K_q48 += (self.end_K_q16 - (self.heat_K_q48 >> 32)) * part_q32

    def _highest_K(self) -> int:
        """Return the rise at full duty for ever, at the highest supply."""
        low_mV, high_mV, highest_K = self.limits.nominal_supply_mV, self.limits.supply_high_mV, self.rise_K
        if high_mV > low_mV:
            for _ in range(2):
                highest_K = min(65_533, highest_K * high_mV // low_mV + 1)
        return highest_K

    def _end_K_q16(self, duty_q15: int, supply_mV: int) -> int:
        """Return the rise for ever: a lower supply counts as nominal, above it a chord of the square does."""
        low_mV, high_mV = self.limits.nominal_supply_mV, self.limits.supply_high_mV
        rise_K = self.rise_K
        if supply_mV > low_mV:
            highest_K = self._highest_K()
            slope_q16 = (highest_K - rise_K) * 2**16 // (high_mV - low_mV) + 1 if high_mV > low_mV else 0
            rise_K += (supply_mV - low_mV) * slope_q16 % 2**32 // 2**16 + 1
        return rise_K * -(-(duty_q15**2) // 2**14) % 2**32
