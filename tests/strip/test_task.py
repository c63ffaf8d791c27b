"""The pointing task on an LED strip: the firmware's core shows and times it, simulated people press."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fdvv.errors import DeviceError
from fdvv.model.file import load_builtin
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.people.user import SimulatedUser
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.task import TaskPress
from fdvv_strip.board import LedPointingTask, StripResult
from fdvv_strip.library import LibraryStrip
from fdvv_strip.task import play_on_strip, played_presser, press_of, strip_round

TASKS = [TemporalPointing(level, quantised=False) for level in ("easy", "hard")]
SHORT = replace(TASKS[1], rounds=3)
USER = SimulatedUser()
BROWN = load_builtin("mx-brown")
LATE_80_ms = [TaskPress(0.0, (0.08,))] * 3


@pytest.mark.parametrize("task", TASKS)
def test_what_a_person_does_to_the_key_is_what_the_strip_tells(
    strip: LedPointingTask, line: LibraryStrip, task: TemporalPointing
) -> None:
    presses = simulate_task(task, BROWN, USER, 3)
    reported = play_on_strip(strip, task, 3, presser=played_presser(line, presses))
    for there, here in zip(reported, presses, strict=True):
        assert there.target_s is not None
        assert here.target_s is not None
        relative = [at_s - there.target_s for at_s in there.activations_s]
        assert relative == pytest.approx([at_s - here.target_s for at_s in here.activations_s], abs=2e-6)
    score, wanted = (task.scores(found)["asynchrony_ms"] for found in (reported, presses))
    assert score.value == pytest.approx(wanted.value, abs=2e-3)


def test_a_round_shows_the_tasks_speed_length_and_zone() -> None:
    order = strip_round(TASKS[1])
    assert (order.speed_px_s, order.pixels, order.zone_px, order.zone_half_px) == (150, 144, 100, 5)


def test_the_same_seed_draws_the_same_delays_and_every_round_its_own(line: LibraryStrip) -> None:
    strip, delays = LedPointingTask(line), []
    for _ in range(2):
        heard: list[float] = []
        begun = line.now_s()
        for press in play_on_strip(strip, SHORT, 5):
            assert press.target_s is not None
            heard.append(press.target_s - begun)
            begun = press.target_s + 0.6
        delays.append([round(at_s, 1) for at_s in heard])
    assert delays[0] == delays[1]
    assert len(set(delays[0])) > 1


def test_a_round_without_a_press_is_a_miss(strip: LedPointingTask) -> None:
    assert all(press.activations_s == () for press in play_on_strip(strip, SHORT, 0))


def test_each_round_is_reported_as_it_ends_and_another_device_is_served_meanwhile(
    strip: LedPointingTask, line: LibraryStrip
) -> None:
    order: list[str] = []
    play_on_strip(
        strip,
        SHORT,
        0,
        presser=played_presser(line, LATE_80_ms),
        meanwhile=lambda: order.append("fed"),
        heard=lambda number, press: order.append(f"{number}: {len(press.activations_s)}"),
    )
    assert [entry for entry in order if entry != "fed"] == ["0: 1", "1: 1", "2: 1"]
    assert order.count("fed") > 3 * 1.0 / 0.07


@pytest.mark.parametrize(
    ("changed", "reason"), [({"is_whole": False}, "went dark"), ({"late_s": 0.0034}, "3.4 ms late")]
)
def test_a_round_that_was_not_shown_as_it_should_does_not_count(
    strip: LedPointingTask, changed: dict[str, float], reason: str
) -> None:
    result = StripResult(1.0, 2.0, (2.1,), 1, 145, 0.0, True)
    assert press_of(strip, result) == TaskPress(2.0, (2.1,))
    with pytest.raises(DeviceError, match=reason):
        press_of(strip, replace(result, **changed))  # type: ignore[arg-type]
