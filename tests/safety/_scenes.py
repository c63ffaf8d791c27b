"""What the supervisor is put through: every question in every mode, every bound from both sides, chance."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from dataclasses import replace

from fdvv.firmware.core import CoreRequest
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import BoardLimits, Fault, Mode, Settings
from tests.safety._oracle import BROWN_OUT, OUTPUT, VIBRATION, WATCHDOG, Inputs
from tests.safety._script import Script

SENSED = Settings(force_gain_q14=1000, stuck_ticks=20)
"""Settings with a keycap force sensor."""

SLOWEST = Settings(heat_time_ms=600_000, tick_us=100)

Disturb = Callable[[Inputs, int], Inputs]

BOUNDS: dict[Fault, tuple[int, Disturb]] = {
    Fault.POSITION_LOW: (SENSED.reading_low, lambda it, v: replace(it, lowest=v)),
    Fault.POSITION_HIGH: (SENSED.reading_high, lambda it, v: replace(it, highest=v)),
    Fault.POSITION_JUMP: (SENSED.jump_um16, lambda it, v: replace(it, displacement_um16=v)),
    Fault.OVER_FORCE: (SENSED.over_force_cN64, lambda it, v: replace(it, force_cN64=v)),
    Fault.SUPPLY_LOW: (SENSED.supply_low_mV, lambda it, v: replace(it, supply_mV=v)),
    Fault.SUPPLY_HIGH: (SENSED.supply_high_mV, lambda it, v: replace(it, supply_mV=v)),
    Fault.HOST_LOST: (1000 * SENSED.host_timeout_ms, lambda it, v: replace(it, time_us=v % 2**32)),
    Fault.LATE: (SENSED.late_ticks, lambda it, v: replace(it, elapsed_ticks=v)),
}
"""Bound of each fault that has one in a tick, and how to reach a value there."""

REPORTED = {
    Fault.WATCHDOG: WATCHDOG,
    Fault.BROWN_OUT: BROWN_OUT,
    Fault.OUTPUT: OUTPUT,
    Fault.VIBRATION_BOARD: VIBRATION,
}


def disturbances() -> Iterator[tuple[Fault, Inputs]]:
    """Yield every fault that a single tick can raise, with a tick that must raise it, armed with SENSED."""
    for fault, (bound, disturb) in BOUNDS.items():
        low = fault in (Fault.POSITION_LOW, Fault.SUPPLY_LOW)
        yield fault, disturb(Inputs(sum=1), bound + (-1 if low else 1))
    for fault, bit in REPORTED.items():
        yield fault, Inputs(sum=1, board=bit)


def into(script: Script, mode: Mode, settings: Settings = SENSED) -> None:
    """Boot and go to this mode."""
    script.start(settings)
    script.host(0)
    if mode is not Mode.BOOT:
        script.ask(settings, CoreRequest.BOOTED)
    if mode is Mode.SELFTEST:
        script.ask(settings, CoreRequest.TEST)
    if mode in (Mode.ARMED, Mode.DERATED):
        script.tick(settings, Inputs())
        script.ask(settings, CoreRequest.ARM)
    if mode is Mode.DERATED:
        warm(script, settings, settings.derate_start_K)
    if mode is Mode.FAULT:
        script.found(Fault.IMAGE_CORRUPT, 7, 8)


def warm(script: Script, settings: Settings, rise_K: int) -> None:
    """Heat until the rise is reached, and see to the limit."""
    while script.oracle.heat_K_q48 >> 48 < rise_K:
        script.heat(32767, 400)
    script.limit(settings)


def questions(script: Script) -> None:
    """Ask every question in every mode, with every number of a fault, then tick."""
    for mode in Mode:
        for ask in range(len(CoreRequest) + 2):
            for number in (0, 1, int(Fault.IMAGE_CORRUPT), len(Fault), 255):
                into(script, mode)
                script.ask(SENSED, ask, number)
                script.tick(SENSED, Inputs(sum=2))
                script.ask(SENSED, CoreRequest.ARM)
                script.limit(SENSED)


def bounds(script: Script) -> None:
    """Come to every bound from below and above, in every mode, then clear, disturbed still and no more."""
    for mode in Mode:
        for fault, (bound, disturb) in BOUNDS.items():
            for value in (bound - 1, bound, bound + 1):
                into(script, mode)
                script.tick(SENSED, replace(disturb(Inputs(sum=1), value), commanded_cN64=-77, state=3))
                script.ask(SENSED, CoreRequest.CLEAR, fault)
                again(script, SENSED, fault, disturb(Inputs(sum=2), value))
        for fault, bit in REPORTED.items():
            into(script, mode)
            script.tick(SENSED, Inputs(sum=1, board=bit, displacement_um16=-5))
            again(script, SENSED, fault, Inputs(sum=2, board=bit))


def again(script: Script, settings: Settings, fault: Fault, inputs: Inputs) -> None:
    """Clear while it is there, with the wrong number, and when it has gone; arm after each."""
    calm = Inputs(sum=3, displacement_um16=inputs.displacement_um16, time_us=inputs.time_us)
    for number, tick in ((fault, inputs), (fault + 1, calm), (fault, calm), (fault, inputs)):
        script.tick(settings, replace(tick, sum=script.oracle.last_sum + 1))
        script.ask(settings, CoreRequest.CLEAR, number)
        script.limit(settings)
        script.ask(settings, CoreRequest.ARM)
        script.tick(settings, replace(tick, sum=script.oracle.last_sum + 1))


def several(script: Script) -> None:
    """Let two faults come in one tick, one after the other, and the second stay when the first is cleared."""
    singles = list(disturbances())
    calm = Inputs(sum=9)
    for fault, inputs in singles:
        for other, more in singles:
            differing = {k: v for k, v in vars(more).items() if v != getattr(Inputs(sum=1), k)}
            both = replace(inputs, **differing | {"board": inputs.board | more.board})
            into(script, Mode.ARMED)
            script.tick(SENSED, both)
            into(script, Mode.ARMED)
            script.tick(SENSED, inputs)
            script.tick(SENSED, replace(both, sum=2))
            script.tick(SENSED, replace(more, sum=3))
            script.ask(SENSED, CoreRequest.CLEAR, fault)
            script.tick(SENSED, replace(more, sum=4))
            script.ask(SENSED, CoreRequest.CLEAR, other)
            script.tick(SENSED, calm)
            script.ask(SENSED, CoreRequest.CLEAR, other)


def elsewhere(script: Script) -> None:
    """Report every number of a fault in every mode; corrupt the mode; count to the end."""
    for mode in Mode:
        for number in (*range(len(Fault) + 2), 255):
            into(script, mode)
            script.tick(SENSED, Inputs(sum=4, commanded_cN64=5, state=6))
            script.found(number, -3, 2**31 - 1)
            script.limit(SENSED)
            script.ask(SENSED, CoreRequest.CLEAR, number)
            script.ask(SENSED, CoreRequest.CLEAR, Fault.INTERNAL)
            script.found(number, 4, 5)
            script.tick(SENSED, Inputs(sum=5))
    for mode_number in (6, 7, 77, 255):
        for ask in (None, *CoreRequest):
            into(script, Mode.ARMED)
            script.poke_mode(mode_number)
            if ask is not None:
                script.ask(SENSED, ask, Fault.INTERNAL)
            script.limit(SENSED)
            script.tick(SENSED, Inputs(sum=6))
            script.ask(SENSED, CoreRequest.CLEAR, Fault.INTERNAL)
    into(script, Mode.IDLE)
    script.poke_faults(65533)
    for _ in range(4):
        script.found(Fault.IMAGE_CORRUPT, 1, 2)


def stuck(script: Script) -> None:
    """Hold the reading for one tick less than allowed, exactly as long, and across arming."""
    for ticks in (SENSED.stuck_ticks - 1, SENSED.stuck_ticks + 1):
        into(script, Mode.ARMED)
        for i in range(ticks):
            script.tick(SENSED, Inputs(time_us=250 * i))
        into(script, Mode.ARMED)
        for i in range(1 + ticks):
            script.tick(SENSED, Inputs(sum=7, time_us=250 * i))
            script.ask(SENSED, CoreRequest.CLEAR, Fault.POSITION_STUCK)
    into(script, Mode.IDLE)
    for _ in range(30):
        script.check(SENSED, Inputs(sum=8))
    script.ask(SENSED, CoreRequest.ARM)
    for _ in range(SENSED.stuck_ticks + 1):
        script.tick(SENSED, Inputs(sum=8))


def jumps(script: Script) -> None:
    """Jump across missed ticks, across the whole range, and where a position is not yet known."""
    patient = replace(SENSED, late_ticks=1000, jump_um16=65535)
    for elapsed in (0, 1, 2, 3, 1000, 40_000, 65535):
        for settings in (SENSED, patient):
            for beyond in (-1, 0, 1):
                for sign in (-1, 1):
                    way = min(settings.jump_um16 * max(1, elapsed), 2**31 - 2) + beyond
                    start = min(2**31 - 1, max(-(2**31), -sign * (way // 2)))
                    script.armed(settings, Inputs(displacement_um16=start))
                    script.tick(
                        settings, Inputs(sum=1, elapsed_ticks=elapsed, displacement_um16=start + sign * way)
                    )
    for first, second in ((-(2**31), 2**31 - 1), (2**31 - 1, -(2**31)), (0, -(2**31))):
        script.armed(patient, Inputs(displacement_um16=first))
        script.tick(patient, Inputs(sum=1, displacement_um16=second))
    script.start(SENSED)
    script.host(0)
    script.ask(SENSED, CoreRequest.BOOTED)
    script.ask(SENSED, CoreRequest.ARM)
    script.tick(SENSED, Inputs(sum=1, displacement_um16=100_000))
    script.mean(SENSED)
    script.tick(SENSED, Inputs(sum=2, displacement_um16=-100_000))


def forces(script: Script) -> None:
    """Press and pull the keycap around the bound, with and without a sensor."""
    for settings in (SENSED, Settings(over_force_cN64=64), replace(SENSED, force_gain_q14=-1)):
        bound = settings.over_force_cN64
        for force in (bound, bound + 1, -bound, -bound - 1, -32768, 32767):
            script.armed(settings)
            script.tick(settings, Inputs(sum=1, force_cN64=force))


def host(script: Script) -> None:
    """Let the host fall silent around the wrap of the clock and for longer than half its range."""
    timeout_us = 1000 * SENSED.host_timeout_ms
    for heard in (0, 2**31 - 100, 2**32 - 100):
        for silence in (-250, 0, timeout_us, timeout_us + 1):
            script.armed(SENSED, Inputs(time_us=heard))
            script.tick(SENSED, Inputs(sum=1, time_us=(heard + silence) % 2**32))
    for silences in ((timeout_us + 1, 2**31 + 5), (2**31 - 1, 2**32 - 1)):
        into(script, Mode.IDLE)
        for i, silence in enumerate(silences):
            script.tick(SENSED, Inputs(sum=i, time_us=silence))
        script.ask(SENSED, CoreRequest.ARM)
        script.tick(SENSED, Inputs(sum=5, time_us=silences[-1]))
    script.start(SENSED)
    script.ask(SENSED, CoreRequest.BOOTED)
    script.ask(SENSED, CoreRequest.ARM)
    script.tick(SENSED, Inputs(sum=1))


def settings_scenes(script: Script) -> None:
    """Corrupt the settings, mean others, arm with settings that may not be used, never mean any."""
    for other in (replace(SENSED, tick_us=251), replace(SENSED, continuous_samples=9)):
        for mode in (Mode.IDLE, Mode.ARMED):
            into(script, mode)
            script.tick(SENSED, Inputs(sum=1))
            script.tick(other, Inputs(sum=2))
            script.ask(other, CoreRequest.CLEAR, Fault.SETTINGS_CORRUPT)
            script.mean(other)
            script.tick(other, Inputs(sum=3))
            script.ask(other, CoreRequest.CLEAR, Fault.SETTINGS_CORRUPT)
            script.tick(other, Inputs(sum=4))
    odd = replace(SENSED, window_end_um16=SENSED.window_start_um16)
    into(script, Mode.IDLE, odd)
    script.ask(odd, CoreRequest.ARM)
    script.ask(SENSED, CoreRequest.ARM)


def heat(script: Script) -> None:
    """Warm up, derate, come back below the hysteresis, reach the limit, cool, and take the smallest steps."""
    for settings in (
        SENSED,
        Settings(derate_start_K=89, force_limit_cN64=31999, heat_time_ms=100, tick_us=1000),
        replace(SLOWEST, derate_start_K=1, heat_limit_K=2, full_duty_rise_K=20_000),
        Settings(heat_time_ms=1024, tick_us=1000),
        Settings(heat_limit_K=600, full_duty_rise_K=16_383, tick_us=1000),
        Settings(derate_start_K=500, heat_limit_K=600, full_duty_rise_K=1000, heat_time_ms=100),
    ):
        for duty in (32767, -32768, 20_000):
            script.armed(settings)
            for i in range(300):
                warming = script.oracle.heat_K_q48 >> 48 < settings.heat_limit_K and i < 200
                script.heat(duty if warming else 0, 1 + 61 * (i % 7))
                script.limit(settings)
            script.tick(settings, Inputs(sum=1))
            for elapsed in (1, 2, 40_000, 65_535, 0):
                script.heat(-32768, elapsed)
                script.limit(settings)
            script.tick(settings, Inputs(sum=2))
            script.ask(settings, CoreRequest.CLEAR, Fault.OVER_HEAT)
            for elapsed in (65_535, *(1,) * 300):
                script.heat(0, elapsed)
            script.tick(settings, Inputs(sum=3))
            script.ask(settings, CoreRequest.CLEAR, Fault.OVER_HEAT)
        script.armed(settings)
        for duty in range(-260, 260, 9):
            script.heat(duty)
    crossings(script)
    boards(script)


def crossings(script: Script) -> None:
    """Come to the start of derating and to its end exactly: many missed ticks end at whole kelvins.

    So quick a coil counts as two kelvins warmer, as the next ticks may be late.
    """
    for rise_K in (13, 14, 15, 27, 28, 30):
        settings = Settings(
            full_duty_rise_K=rise_K, derate_start_K=16, heat_limit_K=30, heat_time_ms=100, tick_us=1000
        )
        script.armed(settings)
        for _ in range(4):
            script.heat(-32768, 65_535)
            script.limit(settings)
        script.tick(settings, Inputs(sum=1))
    sooner = Settings(full_duty_rise_K=13, derate_start_K=10, heat_limit_K=30, heat_time_ms=100, tick_us=1000)
    for duty in (-32768, 32767):
        # derated at 15 K less two, or just below: the way back begins there
        script.armed(sooner)
        for _ in range(4):
            script.heat(duty, 65_535)
            script.limit(sooner)
        later = replace(sooner, derate_start_K=16)
        script.mean(later)
        for _ in range(3):
            script.limit(later)
            script.heat(0)


def boards(script: Script) -> None:
    """Warm and cool under settings that are quicker, slower and warmer than the board, at any supply."""
    board = replace(limits_like(Settings(heat_time_ms=200)), supply_high_mV=57_000)
    for time_ms, rise_K in ((100, 596), (200, 597), (400, 2000), (600_000, 20_000)):
        settings = Settings(heat_time_ms=time_ms, full_duty_rise_K=rise_K, tick_us=1000)
        script.start(settings, board)
        for supply_mV in (0, 11_999, 12_000, 12_001, 18_000, 24_000, 24_001, 57_000):
            for duty in (-32768, 32767, 1, 0):
                for elapsed in (1, 3, 0, 2):
                    script.heat(duty, elapsed, supply_mV)
        for supply_mV in range(12_100, 57_000, 900):
            script.heat(32_765, 1, supply_mV)
        script.heat(0, 1, 65_535)
        # the end of the last duty counts for the ticks that were missed
        script.heat(20_000, 1, 12_000)
        script.heat(0, 50)
        script.heat(0, 50)
    script.start(Settings(full_duty_rise_K=16_383), replace(board, full_duty_rise_K=16_383))
    for supply_mV in (20_000, 23_999, 24_000):
        script.heat(32767, 1, supply_mV)
    for high_mV in (11_999, 12_000, 12_001):
        script.start(SENSED, replace(limits_like(SENSED), supply_high_mV=high_mV))
        for supply_mV in (11_999, 12_000, 12_001):
            script.heat(20_000, 1, supply_mV)
    warm = Settings(full_duty_rise_K=100, heat_time_ms=100)
    script.start(warm, replace(board, full_duty_rise_K=16_383, heat_time_ms=600_000))
    for duty in (32767, 0):
        script.heat(duty, 9)
    restarts(script)
    loose = replace(limits_like(SENSED), force_limit_cN64=SENSED.force_limit_cN64 - 1)
    script.start(SENSED, loose)
    script.ask(SENSED, CoreRequest.BOOTED)
    script.ask(SENSED, CoreRequest.ARM)


def restarts(script: Script) -> None:
    """Restart cold and warm, the memory whole and damaged."""
    for spoilt in ((0, 0), (1, 0), (0, 2**30), (-1, 0), (0, -1)):
        for ticks in (0, 60_000):
            script.start(SENSED)
            for _ in range(3):
                script.heat(32767, 1 + ticks)
            script.resume(SENSED, spoilt)
            script.ask(SENSED, CoreRequest.BOOTED)
            script.host(0)
            script.ask(SENSED, CoreRequest.ARM)
            script.limit(SENSED)
            script.heat(0)
            script.tick(SENSED, Inputs(sum=1))


BEADED = Settings(tick_us=1000, heat_time_ms=2000, full_duty_rise_K=400)
"""Settings of a coil that warms within the scenes of its thermistor."""
HOT = replace(BEADED, derate_start_K=500, heat_limit_K=600)
"""The same, with room for other faults than over_heat."""


def bead_board(settings: Settings, **others: int) -> BoardLimits:
    """Return a board with a thermistor that is built for these settings."""
    return replace(limits_like(settings), thermistor_lag_ms=1000, thermistor_share_q8=200, **others)


def thermistors(script: Script) -> None:
    """Warm, cool, restart, rewrite with a bead that follows; break its wire at every bound; leave it cold."""
    for lag_ms, share_q8, rise_K in ((500, 64, 400), (1000, 200, 300), (60_000, 256, 1)):
        board = bead_board(BEADED, full_duty_rise_K=rise_K)
        board = replace(board, thermistor_lag_ms=lag_ms, thermistor_share_q8=share_q8)
        script.start(BEADED, board)
        follow(script, BEADED, [(20_000, 300), (0, 300), (32767, 250), (-9000, 120)])
        script.mean(replace(BEADED, tick_us=250))
        follow(script, BEADED, [(20_000, 150), (0, 150)])
        script.resume(BEADED, (1, 0))
        follow(script, BEADED, [(0, 1200)])
    broken_beads(script)
    colds(script)
    late_beads(script)


def follow(script: Script, settings: Settings, loads: list[tuple[int, int]], counts: int = 2100) -> None:
    """Hold each duty for so many ticks, the bead reading a little warmer while there is one."""
    at = counts
    for duty, ticks in loads:
        for i in range(ticks):
            at = max(300, at - 2) if duty and i % 3 == 0 else min(counts, at + (i % 2))
            script.heat(duty)
            script.thermistor(at)
    script.tick(settings, Inputs(sum=script.oracle.last_sum + 1, thermistor_counts=at))
    script.limit(settings)


def broken_beads(script: Script) -> None:
    """Come to every bound of counts and change, cold and warm, then clear while it is so and after."""
    faults = (Fault.THERMISTOR_OPEN, Fault.THERMISTOR_SHORT, Fault.THERMISTOR_JUMP, Fault.THERMISTOR_COLD)
    edges = (63, 64, 65, 127, 128, 129, 3899, 3900, 3901, 4095, 65535, 0)
    between = (700, 1500, 1960, 1965, 1970, 1975, 2245)
    for counts in (*edges, *between, *range(1900, 1990, 6), *range(2200, 2320, 14)):
        script.start(BEADED, replace(bead_board(BEADED), thermistor_lag_ms=(60_000, 1000)[counts % 2]))
        script.ask(BEADED, CoreRequest.BOOTED)
        script.host(0)
        if counts % 2:
            for _ in range(2):
                script.heat(28_000, 350)
        samples(script, 2100, 2)
        script.ask(BEADED, CoreRequest.ARM)
        script.limit(BEADED)
        back = ((2100, 1), (2100, 1)) if counts % 5 == 0 else ((counts, counts % 5), (1200, 2), (2100, 3))
        for now, count in ((counts, 1), *back):
            samples(script, now, count)
            for number in faults:
                script.ask(BEADED, CoreRequest.CLEAR, number)
            script.ask(BEADED, CoreRequest.ARM)
    exact_beads(script)


def exact_beads(script: Script) -> None:
    """Change by exactly what a coil can; be exactly as cold as a bead may; leave an odd load."""
    for first, second in ((2504, 228), (228, 2504)):
        script.start(BEADED, replace(bead_board(HOT), thermistor_lag_ms=1725))
        samples(script, first, 1)
        samples(script, second, 1)
        assert script.oracle.thermistor.fault is Fault.NONE
    for duty, last, counts, is_cold in ((15_167, 25, 2175, False), (31_352, 7, 2331, True)):
        script.start(HOT, bead_board(HOT))
        for sample in range(last):
            for _ in range(100):
                script.heat(duty)
                script.thermistor(counts if sample == last - 1 else 2100)
        script.tick(HOT, Inputs(sum=1))
        thermistor = script.oracle.thermistor
        assert thermistor.follower - thermistor.reading == 10 * 2**16 + is_cold
        assert (thermistor.fault is Fault.THERMISTOR_COLD) is is_cold
    odd = replace(HOT, full_duty_rise_K=401)
    script.start(odd, replace(bead_board(odd), heat_time_ms=600_000))
    for duty, elapsed, ticks in ((16_369, 101, 40), (16_369, 2, 200), (0, 0, 201)):
        for _ in range(ticks):
            script.heat(duty, elapsed)
            script.thermistor(2100, elapsed)
    follow(script, odd, [(0, 600)])


def samples(script: Script, counts: int, count: int, elapsed: int = 1) -> None:
    """Wait for so many samples."""
    for _ in range(count * 100 // elapsed):
        script.tick(
            BEADED, Inputs(sum=script.oracle.last_sum + 1, elapsed_ticks=elapsed, thermistor_counts=counts)
        )


def colds(script: Script) -> None:
    """Warm a coil whose bead stays as warm as it was, in rooms of different warmth, or whose wire is open."""
    for counts in (2100, 1500, 900, 500, 4000):
        for settings in (HOT, replace(HOT, full_duty_rise_K=401), replace(HOT, full_duty_rise_K=4000)):
            script.start(settings, bead_board(HOT))
            for _ in range(25):
                for _ in range(100):
                    script.heat(28_000)
                    script.thermistor(counts)
                script.tick(settings, Inputs(sum=script.oracle.last_sum + 1, thermistor_counts=counts))
                script.ask(settings, CoreRequest.CLEAR, Fault.THERMISTOR_COLD)


def late_beads(script: Script) -> None:
    """Miss ticks under load, so many that the load does not fit, and jump where nobody looked for long."""
    for elapsed in (0, 1, 2, 49, 50, 99, 100, 101, 199, 200, 201, 40_000, 65_535):
        for duty in (0, 20_000, -32768):
            settings = replace(BEADED, full_duty_rise_K=20_000, late_ticks=1000)
            script.start(settings, bead_board(BEADED))
            for counts in (2100, 2100, 1500, 2100, 900):
                for _ in range(3):
                    script.heat(duty, elapsed)
                    script.thermistor(counts, elapsed)
            script.mean(settings)
            script.heat(0)
            script.thermistor(900, 100)
            script.tick(settings, Inputs(sum=script.oracle.last_sum + 1, thermistor_counts=900))
    for time_ms, elapsed in ((100, 200), (100, 420), (100, 1000), (2000, 500), (2000, 1000)):
        settings = replace(HOT, heat_time_ms=time_ms, full_duty_rise_K=20_000)
        slow = replace(bead_board(settings), full_duty_rise_K=16_383, heat_time_ms=600_000)
        script.start(settings, slow)
        for _ in range(2):
            script.heat(-32768, elapsed)
            script.thermistor(2100, elapsed)
        follow(script, settings, [(0, 1500)])
    script.start(BEADED, limits_like(BEADED))
    script.thermistor(0, 100)  # none is fitted
    script.tick(BEADED, Inputs(sum=1))


def chance(script: Script, seed: int, ticks: int) -> None:
    """Tick at random, mostly well, near the bounds at times, with questions in between."""
    rng = random.Random(seed)
    settings, talking, holding = SENSED, True, False
    time_us = rng.randrange(2**32)
    for i in range(ticks):
        if i % 250 == 0:
            settings, talking, holding = random_settings(rng), rng.random() < 0.7, rng.random() < 0.3
            script.start(settings, random_limits(rng, settings))
            script.ask(settings, CoreRequest.BOOTED)
        elapsed = 1 if rng.random() < 0.99 else rng.randint(0, settings.late_ticks + 1)
        time_us = (time_us + elapsed * settings.tick_us) % 2**32
        if talking or rng.random() < 0.01:
            script.host(time_us)
        if rng.random() < 0.1:
            _question(rng, script, settings)
        inputs = _random_inputs(rng, settings, script.oracle.last_um16 or 0)
        sum_now = 7 if holding else rng.randint(0, 99)
        script.tick(
            _perhaps_corrupt(rng, settings),
            replace(inputs, time_us=time_us, elapsed_ticks=elapsed, sum=sum_now),
            rng.choice([0, rng.randint(-32768, 32767), 32767]),
        )
        if rng.random() < 0.0005:
            script.poke_mode(rng.randint(0, 255))


def _perhaps_corrupt(rng: random.Random, settings: Settings) -> Settings:
    if rng.random() < 0.999:
        return settings
    return replace(settings, announced_mm_s16=settings.announced_mm_s16 ^ 1)


def random_settings(rng: random.Random) -> Settings:
    """Draw settings that the firmware accepts and that come to their bounds soon."""
    start = rng.randint(1, 60)
    low = rng.randint(2000, 12_000)
    return Settings(
        tick_us=rng.choice([50, 100, 250, 1000, 4000]),
        heat_time_ms=rng.choice([100, 150, 1000, 60_000]),
        force_gain_q14=rng.choice([0, 1000, -5]),
        force_limit_cN64=rng.randint(64, 32_000),
        supply_low_mV=low,
        supply_high_mV=low + rng.randint(1000, 20_000),
        reading_low=rng.randint(0, 100),
        reading_high=rng.randint(3000, 4095),
        jump_um16=rng.randint(160, 65_535),
        stuck_ticks=rng.randint(20, 60),
        late_ticks=rng.randint(1, 10),
        over_force_cN64=rng.randint(64, 32_000),
        full_duty_rise_K=rng.choice([50, 200, 20_000]),
        derate_start_K=start,
        heat_limit_K=start + rng.randint(1, 60),
        host_timeout_ms=rng.randint(20, 60),
    )


def random_limits(rng: random.Random, settings: Settings) -> BoardLimits:
    """Draw a board that takes these settings, mostly, with another coil than they say."""
    like = limits_like(settings)
    most = replace(
        like,
        heat_time_ms=rng.choice([100, 150, 1000, 60_000]),
        full_duty_rise_K=rng.choice([1, like.full_duty_rise_K]),
        nominal_supply_mV=settings.nominal_supply_mV + rng.choice([0, 0, -3000]),
    )
    if rng.random() < 0.5:
        lag_ms, share_q8 = rng.choice([500, 3000, 60_000]), rng.choice([64, 200, 256])
        most = replace(most, thermistor_lag_ms=lag_ms, thermistor_share_q8=share_q8)
    return most if rng.random() < 0.9 else replace(most, host_timeout_ms=20)


def _near(rng: random.Random, usual: int, bound: int, largest: int) -> int:
    if rng.random() < 0.997:
        return usual
    return min(largest, max(0, bound + rng.randint(-1, 1)))


def _random_inputs(rng: random.Random, settings: Settings, last_um16: int) -> Inputs:
    supply_bound = rng.choice([settings.supply_low_mV, settings.supply_high_mV])
    moved = _near(rng, rng.randint(0, 100), settings.jump_um16, 2**31 - 1) * rng.choice([-1, 1])
    return Inputs(
        lowest=_near(rng, 2000, settings.reading_low, 65_535),
        highest=_near(rng, 2000, settings.reading_high, 65_535),
        supply_mV=_near(rng, settings.supply_low_mV + 500, supply_bound, 65_535),
        board=rng.choice([WATCHDOG, BROWN_OUT, OUTPUT, VIBRATION, 15]) if rng.random() < 0.003 else 0,
        displacement_um16=last_um16 + moved,
        thermistor_counts=_near(rng, rng.randint(1950, 2050), rng.choice([64, 3900, 1500]), 65_535),
        force_cN64=_near(rng, 50, settings.over_force_cN64, 32_767) * rng.choice([-1, 1]),
        commanded_cN64=rng.randint(-32_768, 32_767),
        state=rng.randint(0, 255),
    )


def _question(rng: random.Random, script: Script, settings: Settings) -> None:
    if script.oracle.mode == Mode.IDLE and rng.random() < 0.7:
        script.ask(settings, CoreRequest.ARM)
    elif rng.random() < 0.6:
        script.ask(settings, CoreRequest.CLEAR, script.oracle.fault)
    elif rng.random() < 0.8:
        script.ask(settings, rng.choice([*CoreRequest]), rng.randint(0, len(Fault)))
    else:
        script.found(rng.choice([Fault.IMAGE_CORRUPT, Fault.VIBRATION_BOARD]), rng.randint(-9, 9), 0)


DIRECTED = (
    questions,
    bounds,
    several,
    elsewhere,
    stuck,
    jumps,
    forces,
    host,
    settings_scenes,
    heat,
    thermistors,
)
"""The scenes that are thought out."""
