"""Vibrations are felt where they belong: led by the latency, once per stroke, without chatter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.protocol.tables import NONE, Settings, Stroke, Vibration
from tests.support.core.programs import FINE, REST, armed, event, image
from tests.support.inputs import inputs_at

AT_UM16 = 16000
TICK_MS = 0.25


def played(path_mm: npt.ArrayLike, *events: Vibration, settings: Settings = FINE) -> list[tuple[int, int]]:
    """Return the ticks in which a slot was played, and the slot."""
    program = image(states=[(replace(REST, velocity_source=2), ())], vibrations=events)
    slots = armed(program, settings).run(inputs_at(settings, path_mm))["slot"]
    return [(int(k), int(slots[k])) for k in np.flatnonzero(slots != NONE)]


def onset_errors_ms(speed_mm_s: float, acceleration_mm_s2: float, latency_us: int) -> npt.NDArray[np.float64]:
    """Return the delays of the first motion after the cap crossed 2.2 mm, at all phases of a tick."""
    settings, v, a = replace(FINE, vibration_latency_us=latency_us), speed_mm_s, acceleration_mm_s2
    errors = []
    for phase in np.linspace(0, 0.98, 25):
        # the cap crosses the point at t = 0 with this speed, having begun at rest or at -1 mm
        t = np.arange(-3.2 / v, 0.02, TICK_MS * 1e-3) + phase * TICK_MS * 1e-3
        moving = np.maximum(t, -v / a) if a else t
        path = np.minimum(2.2 + v * moving + 0.5 * a * moving**2, 2.7)
        [(tick, _)] = played(path, event(35200), settings=settings)
        errors.append(1e3 * t[tick] + latency_us * 1e-3)
    return np.array(errors)


@pytest.mark.parametrize("latency_us", [0, 1000, 7000])
@pytest.mark.parametrize("speed_mm_s", [50.0, 100.0, 150.0, 200.0, 300.0])
def test_an_even_press_feels_it_within_half_a_tick(speed_mm_s: float, latency_us: int) -> None:
    errors = onset_errors_ms(speed_mm_s, 0.0, latency_us)
    # besides half a tick: 3e-4 of the velocity over the latency
    assert abs(errors).max() <= TICK_MS / 2 + 0.02 + 3e-4 * latency_us * 1e-3
    assert abs(errors.mean()) <= 0.02


@pytest.mark.parametrize("latency_us", [1000, 7000])
@pytest.mark.parametrize("acceleration_mm_s2", [2000.0, 5000.0])
@pytest.mark.parametrize("speed_mm_s", [100.0, 150.0])
def test_a_press_that_speeds_up_feels_it_late_by_what_its_acceleration_tells(
    speed_mm_s: float, acceleration_mm_s2: float, latency_us: int
) -> None:
    lead_ms = latency_us * 1e-3 + TICK_MS / 2
    old_ms = (FINE.continuous_samples - 1) / 2 * TICK_MS
    errors = onset_errors_ms(speed_mm_s, acceleration_mm_s2, latency_us)
    # solve for the tick at which x + v lead first reaches the point, the velocity being old_ms old
    a, v = acceleration_mm_s2 * 1e-6, speed_mm_s * 1e-3
    t = np.linspace(-12, 2, 140001)
    ahead = v * t + 0.5 * a * t**2 + (v + a * (t - old_ms)) * lead_ms
    wanted = t[np.argmax(ahead >= 0)] + lead_ms
    assert errors.mean() == pytest.approx(wanted, abs=0.03)
    assert np.ptp(errors) <= TICK_MS + 0.02


def test_it_is_played_once_per_stroke() -> None:
    there = np.arange(0, 2, 0.02)
    path = np.concatenate([there, there[::-1], there, there[::-1]])
    found = played(path, event(AT_UM16, slot=1), event(AT_UM16, Stroke.RELEASE, slot=2))
    assert [slot for _, slot in found] == [1, 2, 1, 2]
    either = played(path, event(AT_UM16, Stroke.EITHER, slot=3))
    assert [slot for _, slot in either] == [3, 3, 3, 3]


@pytest.mark.parametrize("seed", range(5))
def test_a_hover_around_the_point_does_not_chatter(seed: int) -> None:
    rng = np.random.default_rng(seed)
    hover = 1.0 + 0.04 * np.sin(np.arange(3000) / 40) + rng.normal(0, 0.002, 3000)
    path = np.concatenate([np.arange(0, 1, 0.01), hover])
    assert len(played(path, event(AT_UM16))) == 1


def test_a_stroke_that_begins_beyond_the_point_does_not_play_it() -> None:
    path = np.concatenate([np.arange(0, 2, 0.02), np.arange(2, 1.5, -0.02), np.arange(1.5, 2, 0.02)])
    assert len(played(path, event(AT_UM16))) == 1


def test_only_velocities_in_its_range_play_it() -> None:
    events = [event(AT_UM16, slowest=0, fastest=1600, slot=1), event(AT_UM16, slowest=1600, slot=2)]
    for speed_mm_s, slot in ((60.0, 1), (140.0, 2)):
        path = np.arange(0, 2, speed_mm_s * 250e-6)
        assert [found for _, found in played(path, *events)] == [slot]


def test_only_its_states_play_it() -> None:
    path = np.arange(0, 2, 0.02)
    assert played(path, replace(event(AT_UM16), states=0)) == []
    assert len(played(path, replace(event(AT_UM16), states=1))) == 1


def test_of_two_in_one_tick_the_first_is_played() -> None:
    path = np.arange(0, 2, 0.02)
    assert [s for _, s in played(path, event(AT_UM16, slot=2), event(AT_UM16 + 1, slot=1))] == [2]
