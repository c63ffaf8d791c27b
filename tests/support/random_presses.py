"""Random settings and presses for comparing one implementation of the tick with another.

Everything is drawn from the generator that is passed in, so that a seed names a case.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fdvv.firmware.core import RecordArray
from fdvv.protocol.tables import Settings
from tests.support.inputs import inputs_at

Generator = np.random.Generator


def integer(rng: Generator, low: int, high: int) -> int:
    """Draw an integer from low to high, both included."""
    return int(rng.integers(low, high, endpoint=True))


def sometimes(rng: Generator, chance: float, value: int, otherwise: int) -> int:
    """Return value with a chance, else the other one."""
    return value if rng.random() < chance else otherwise


def random_settings(rng: Generator, ticks_us: tuple[int, int] = (50, 4000)) -> Settings:
    """Draw a rig of 1 to 64 readings of 12 bits over some 2 to 12 mm, either way round, never hot."""
    reads, span_um16 = integer(rng, 1, 64), integer(rng, 40000, 195000)
    gain_q14 = span_um16 * 2**14 // (4095 * reads)
    gain_q14 = min(gain_q14, 65535, (2**32 - 1) // (4095 * reads))
    start = integer(rng, 800, 20000)
    top = integer(rng, -2000, 20000) + gain_q14 * 4095 * reads // 2**14
    turned = rng.random() < 0.3
    plain = Settings(
        position_gain_q14=-gain_q14 if turned else gain_q14,
        position_offset_um16=top if turned else -integer(rng, 2000, 20000),
        duty_gain_q16=integer(rng, 64, 2**20),
        force_gain_q14=sometimes(rng, 0.7, integer(rng, -65536, 65536), 0),
        force_offset_counts=integer(rng, 0, 4095),
        tick_us=sometimes(rng, 0.5, 250, integer(rng, *ticks_us)),
        window_start_um16=start,
        window_end_um16=start + integer(rng, 800, 40000),
        reversal_um16=integer(rng, 80, 6000),
        rearm_um16=integer(rng, 80, 4000),
        velocity_scale_q12=integer(rng, 1024, 16384),
        announced_mm_s16=integer(rng, 8, 16000),
        slew_cN64_tick=integer(rng, 16, 32000),
        duty_limit_q15=integer(rng, 1024, 32767),
        nominal_supply_mV=integer(rng, 9000, 14000),
        reading_low=0,
        reading_high=4095,
        jump_um16=65535,
        stuck_ticks=65535,
        late_ticks=1000,
        full_duty_rise_K=1,
        host_timeout_ms=5000,
        vibration_latency_us=integer(rng, 0, 30000),
        stop_us_mm=integer(rng, -1000, 1000),
        stop_zero_us=integer(rng, 400, 2600),
        reads=reads,
        sliding_ticks=sometimes(rng, 0.6, 1, integer(rng, 2, 32)),
        fewest_samples=integer(rng, 3, 16),
        continuous_samples=integer(rng, 3, 32),
    )
    # from a generator of its own, so that what else a seed names does not hang on it
    own = rng.spawn(1)[0]
    return plain if own.random() < 0.4 else random_tuning(own, plain)


def random_tuning(rng: Generator, settings: Settings) -> Settings:
    """Draw a filter of 20 to 2000 Hz, half the time with leads, drag and friction of any size."""
    bandwidth_Hz = float(np.exp(rng.uniform(np.log(20.0), np.log(2000.0))))
    return replace(
        settings,
        predictor_q16=min(
            65535, round((1 - np.exp(-2e-6 * np.pi * bandwidth_Hz * settings.tick_us)) * 2**16)
        ),
        lead_us=sometimes(rng, 0.5, integer(rng, 0, 5000), integer(rng, 0, 20000)),
        brake_lead_us=integer(rng, 0, 20000),
        drag_q13=sometimes(rng, 0.3, 0, integer(rng, 0, 49152)),
        friction_cN64=sometimes(rng, 0.3, 0, integer(rng, 0, 6400)),
        friction_mm_s16=sometimes(rng, 0.5, 160, integer(rng, 64, 16000)),
    )


def random_path_mm(rng: Generator, ticks: int, tick_us: int) -> npt.NDArray[np.float64]:
    """Draw displacements: strokes of 0.5 to 700 mm/s between random depths of 0 to 3.9 mm, and rests."""
    path = np.empty(0)
    place_mm = 0.0
    while path.size < ticks:
        goal_mm = float(rng.choice([0.0, rng.uniform(0, 3.9), place_mm]))
        speed_mm_s = float(np.exp(rng.uniform(np.log(0.5), np.log(700.0))))
        steps = max(int(abs(goal_mm - place_mm) / (speed_mm_s * tick_us * 1e-6)), integer(rng, 1, 40))
        path = np.append(path, np.linspace(place_mm, goal_mm, min(steps, ticks)))
        place_mm = goal_mm
    return path[:ticks]


def random_inputs(rng: Generator, ticks: int, settings: Settings | None = None) -> RecordArray:
    """Draw the inputs of a noisy finger: now and then late, the supply and the keycap sensor moving."""
    settings = settings or Settings()
    path_mm = random_path_mm(rng, ticks, settings.tick_us) + rng.normal(0, rng.choice([0, 3e-4, 5e-3]), ticks)
    inputs = inputs_at(settings, path_mm)
    inputs["sum"] = np.minimum(inputs["sum"], 4095 * settings.reads)
    inputs["lowest"] = inputs["highest"] = inputs["sum"] // settings.reads
    late = rng.random(ticks) < rng.choice([0, 0.003, 0.05])
    longest = rng.choice([3, min(90, settings.late_ticks)]) + 1
    inputs["elapsed_ticks"] = np.where(late, rng.integers(2, longest, ticks, endpoint=True), 1)
    elapsed = np.cumsum(inputs["elapsed_ticks"].astype(np.uint64)) * settings.tick_us
    inputs["time_us"] = (elapsed + integer(rng, 0, 2**32 - 1)).astype(np.uint32)
    low, high = settings.supply_low_mV, settings.supply_high_mV
    inputs["supply_mV"] = np.clip(settings.nominal_supply_mV + rng.integers(-900, 900, ticks), low, high)
    inputs["force_counts"] = rng.integers(0, 4095, ticks, endpoint=True)
    return inputs
