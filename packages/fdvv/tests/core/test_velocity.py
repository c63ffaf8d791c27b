"""Velocities against exact least squares."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.firmware.core import Core, RecordArray
from fdvv.protocol.tables import Settings, TickFlag
from tests.support.core.programs import REST, armed, image
from tests.support.inputs import inputs_at

SPEEDS_MM_S16 = [0, 2000, 4000, 8000, 12000, 16000]
# a force in cN64 that is the velocity in mm_s16, defined from 0 to 1000 mm/s
TELLS = image(
    states=[(replace(REST, velocity_source=1), ())],
    tables=[(0, 16000, SPEEDS_MM_S16, [[speed, speed] for speed in SPEEDS_MM_S16])],
)
PLAIN = replace(
    Settings(),
    velocity_scale_q12=4096,
    announced_mm_s16=1600,
    slew_cN64_tick=32000,
    late_ticks=1000,
    jump_um16=65535,
)


def press_mm(speed_mm_s: float, phase: float, settings: Settings) -> npt.NDArray[np.float64]:
    """Return displacements at the ticks of an even press from -0.5 to 2 mm; it begins at a part of a tick."""
    tick_s = settings.tick_us * 1e-6
    return np.arange(-0.5 + phase * speed_mm_s * tick_s, 2.0, speed_mm_s * tick_s)


def decided_mm_s16(inputs: RecordArray, settings: Settings) -> int:
    outputs = armed(TELLS, settings).run(inputs)
    assert outputs["flags"][-1] & TickFlag.VELOCITY_KNOWN
    return int(outputs["commanded_cN64"][-1])


def least_squares_mm_s(inputs: RecordArray, settings: Settings) -> float:
    """Fit a line to what was sensed in the window, or to the newest few."""
    x_mm = Core(settings).run(inputs)["displacement_um16"] / 16000
    t_s = np.cumsum(inputs["elapsed_ticks"].astype(float)) * settings.tick_us * 1e-6
    end = int(np.argmax(x_mm > settings.window_end_um16 / 16000))
    used = np.flatnonzero((x_mm >= settings.window_start_um16 / 16000) & (np.arange(x_mm.size) < end))
    if used.size < settings.fewest_samples:
        used = np.arange(end - settings.fewest_samples + 1, end + 1)
    return float(np.polyfit(t_s[used] - t_s[used[0]], x_mm[used], 1)[0])


@pytest.mark.parametrize(
    ("speed_mm_s", "tick_us"),
    [
        *itertools.product([0.5, 2, 10, 30, 50, 100, 150, 200, 300, 450, 600], [125, 250, 1000]),
        *((speed, 50) for speed in (2, 10, 50, 200, 600)),
        *((speed, 4000) for speed in (0.5, 10, 50, 100)),
    ],
)
def test_the_decided_velocity_is_that_of_the_press(speed_mm_s: float, tick_us: int) -> None:
    settings = replace(PLAIN, tick_us=tick_us)
    for phase in np.linspace(0, 0.99, 3 if speed_mm_s < 10 else 12):
        inputs = inputs_at(settings, press_mm(speed_mm_s, float(phase), settings))
        found = decided_mm_s16(inputs, settings)
        exact = 16 * least_squares_mm_s(inputs, settings)
        assert found == pytest.approx(exact, rel=0.0005, abs=0.6)
        assert found == pytest.approx(16 * speed_mm_s, rel=0.005, abs=1)


@pytest.mark.parametrize("seed", range(20))
def test_missed_ticks_and_noise_leave_it_the_exact_least_squares(seed: int) -> None:
    rng = np.random.default_rng(seed)
    elapsed = rng.choice([1, 1, 1, 2, 5], 4000)
    speed_mm_s = float(np.exp(rng.uniform(np.log(3), np.log(600))))
    x = -0.3 + np.cumsum(elapsed) * speed_mm_s * 250e-6
    inputs = inputs_at(PLAIN, (x + rng.normal(0, 0.002, x.size))[x < 1.6])
    inputs["elapsed_ticks"] = elapsed[: inputs.size]
    found = decided_mm_s16(inputs, PLAIN)
    assert found == pytest.approx(16 * least_squares_mm_s(inputs, PLAIN), rel=0.0005, abs=0.6)


def test_the_decided_velocity_is_scaled_to_the_mean_of_the_stroke() -> None:
    settings = replace(PLAIN, velocity_scale_q12=4915)
    inputs = inputs_at(settings, press_mm(100.0, 0.3, settings))
    assert decided_mm_s16(inputs, settings) == pytest.approx(1920, abs=2)


def test_until_it_is_decided_the_announced_velocity_counts() -> None:
    core = armed(TELLS, PLAIN)
    inputs = inputs_at(PLAIN, press_mm(100.0, 0.3, PLAIN))
    early = inputs[inputs_at(PLAIN, press_mm(100.0, 0.3, PLAIN))["sum"] < inputs_at(PLAIN, [1.0])["sum"][0]]
    outputs = core.run(early)
    assert set(outputs["commanded_cN64"]) == {1600}
    assert not (outputs["flags"] & TickFlag.VELOCITY_KNOWN).any()
    core.announce(3200)
    assert core.tick(early[-1])["commanded_cN64"] == 3200


def test_the_next_press_decides_anew() -> None:
    core = armed(TELLS, PLAIN)
    for speed in (100.0, 40.0):
        there = press_mm(speed, 0.3, PLAIN)
        found = core.run(inputs_at(PLAIN, np.concatenate([there, there[::-1]])))["commanded_cN64"]
        assert found[there.size] == pytest.approx(16 * speed, rel=0.005)
        assert found[-1] == 1600


def test_a_press_that_turned_in_the_window_counts_from_its_new_beginning() -> None:
    hover = np.concatenate([np.arange(0.0, 0.9, 0.01), np.arange(0.9, 0.6, -0.001)])
    again = np.arange(0.6, 1.5, 0.03)
    inputs = inputs_at(PLAIN, np.concatenate([hover, again]))
    assert decided_mm_s16(inputs, PLAIN) == pytest.approx(16 * 0.03 / 250e-6, rel=0.005)


def test_a_rest_of_minutes_in_the_window_neither_overflows_nor_lasts() -> None:
    core = armed(TELLS, PLAIN)
    core.run(inputs_at(PLAIN, np.arange(0.0, 0.7, 0.01)))
    core.run(inputs_at(PLAIN, np.full(200_000, 0.7)))
    found = core.run(inputs_at(PLAIN, np.arange(0.7, 1.5, 0.01)))["commanded_cN64"][-1]
    assert 0 <= found <= 640


@pytest.mark.parametrize("samples", [3, 4, 5, 8, 17, 32])
@pytest.mark.parametrize("tick_us", [50, 100, 250, 1000, 4000])
def test_the_continuous_velocity_is_the_least_squares_of_the_newest(samples: int, tick_us: int) -> None:
    settings = replace(PLAIN, continuous_samples=samples, tick_us=tick_us)
    rng = np.random.default_rng(samples)
    x = np.clip(np.cumsum(rng.normal(0, 0.4 * tick_us * 1e-3, 300)), -1.0, 5.0)
    outputs = Core(settings).run(inputs_at(settings, x))
    sensed = outputs["displacement_um16"].astype(float)
    for k in range(300):
        n = min(k + 1, samples)
        slope = np.polyfit(np.arange(n) * tick_us * 1e-3, sensed[k - n + 1 : k + 1], 1)[0] if n > 2 else 0.0
        assert abs(int(outputs["velocity_mm_s16"][k]) - slope) <= 0.5 + 2e-4 * abs(slope)


def test_after_missed_ticks_the_continuous_velocity_is_held_and_begins_anew() -> None:
    x = np.arange(60) * 0.025
    x[30:] += 0.05
    inputs = inputs_at(PLAIN, x)
    inputs["elapsed_ticks"][30] = 3
    found = Core(PLAIN).run(inputs)["velocity_mm_s16"]
    # three samples, each known to half a count of 2/16 um
    assert found[10:] == pytest.approx(1600, abs=5)


def test_at_a_reversal_the_continuous_velocity_goes_through_zero_within_its_samples() -> None:
    x = np.concatenate([np.arange(0, 2, 0.025), 2 - np.arange(0, 1, 0.025)])
    found = Core(PLAIN).run(inputs_at(PLAIN, x))["velocity_mm_s16"].astype(int)
    assert found[79] == pytest.approx(1600, abs=3)
    assert found[80 + 8] == pytest.approx(-1600, abs=3)
    assert (np.diff(found[79:89]) <= 3).all()
